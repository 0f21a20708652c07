//! Contour extraction on the CPU.
//!
//! Every extractor gives the edges of the definition, [`drypoint_mesh::contour_edges`], whatever the
//! processor. Output goes to memory that the caller keeps, and its order is fixed.
//!
//! | | looks at | for |
//! |---|---|---|
//! | [`Extractor::edges`], [`Extractor::vertex_pairs`] | patches, then the edges of those that may hold a contour edge, with the newest instructions | every frame |
//! | [`Extractor::all_edges`] | every edge, with the same instructions | measuring what patches gain |
//! | [`extract_patches`] | the same patches and edges, with exact predicates throughout, nothing laid out | a single view |
//! | [`BruteForce`] | every face, then every edge, with exact predicates | a mesh without patches |
//! | [`extract_all_wings`] | every edge, with exact predicates | a patch file without its mesh |
//!
//! ```
//! use drypoint_cpu::{BruteForce, Contours, Extractor};
//! use drypoint_fusion::{FusionParams, fuse};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use glam::DVec3;
//! use std::ops::ControlFlow;
//!
//! let mesh = shapes::icosphere(2_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let go_on = |_| ControlFlow::Continue(());
//! let patches = fuse(&mesh, &adjacency, EdgeFilter::All, &FusionParams::PAPER, &go_on).unwrap();
//!
//! let viewpoint = Viewpoint::at(DVec3::new(0.0, 2.0, 9.0));
//! let extractor = Extractor::new(&patches);
//! let mut contours = Contours::default();
//! let statistics = extractor.edges(viewpoint, &mut contours);
//!
//! let (mut by_patches, mut by_force) = (contours.to_vec(), Vec::new());
//! BruteForce::new(&mesh, &adjacency, EdgeFilter::All).extract(viewpoint, &mut by_force);
//!
//! by_patches.sort_unstable();
//! assert_eq!(by_patches, by_force);
//! assert!(statistics.edges_tested < patches.wings().len() / 2, "most patches are culled");
//! ```

mod batch;
mod bounds;
mod brute_force;
mod contours;
mod edges;
mod exact;
mod extractor;
mod faces;
mod kernels;
mod parts;
mod patches;
mod simd;
mod statistics;
mod strips;
mod threads;

pub use batch::Batch;
pub use brute_force::{BruteForce, FaceSigns, FaceStrips, StoredPlanes, extract_naively};
pub use contours::Contours;
pub use extractor::Extractor;
pub use patches::{extract_all_wings, extract_patches};
pub use simd::Instructions;
pub use statistics::Statistics;
