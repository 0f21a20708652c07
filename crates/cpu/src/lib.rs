//! Contour extraction on the CPU.
//!
//! Every extractor but [`extract_naively`] gives the edges of the definition,
//! [`drypoint_mesh::contour_edges`], on any processor and any number of threads. Output goes to memory
//! that the caller keeps, in an order that is the same on all of them.
//!
//! | | looks at | for |
//! |---|---|---|
//! | [`Extractor::edges`], [`Extractor::vertex_pairs`] | patches, then the edges of those that may hold a contour edge, with the newest instructions | every frame: microseconds for a mesh of 100,000 edges |
//! | [`Extractor::edges_of_batch`], [`Extractor::vertex_pairs_of_batch`] | the same from many viewpoints, piece by piece, on all threads | many views of a mesh that does not fit the second cache, or many threads |
//! | [`Extractor::edges_on_threads`], [`Extractor::vertex_pairs_on_threads`] | the same from one viewpoint, on all threads | a frame of a mesh of several million edges |
//! | [`Extractor::all_edges`] | every edge, with the same instructions | measuring what patches gain |
//! | [`FaceStrips`], [`StoredPlanes`], [`FaceSigns`] | every edge, with the same instructions | a mesh without patches that is seen often; measuring |
//! | [`extract_patches`] | the same patches and edges, with exact predicates throughout, nothing laid out | a single view |
//! | [`BruteForce`] | every face, then every edge, with exact predicates | a mesh without patches |
//! | [`extract_all_wings`] | every edge, with exact predicates | a patch file without its mesh |
//! | [`extract_naively`] | every edge, in f32: inexact | measuring |
//!
//! Figures are in `docs/measurements.md`. Patches for an [`Extractor`] are best made with
//! [`CostModel::CPU_SIMD`](drypoint_fusion::CostModel::CPU_SIMD). The example `orbit` extracts frame by
//! frame.
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
