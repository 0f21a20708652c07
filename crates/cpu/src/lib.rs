//! Contour extraction on the CPU.
//!
//! Both extractors give the edges of the definition, [`drypoint_mesh::contour_edges`], with exact
//! predicates throughout: [`BruteForce`] tests every edge, [`extract_patches`] only those of the
//! patches that may hold a contour edge. Output goes to memory that the caller keeps, and its order
//! is fixed.
//!
//! ```
//! use drypoint_cpu::{BruteForce, extract_patches};
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
//! let (mut by_patches, mut by_force) = (Vec::new(), Vec::new());
//! let statistics = extract_patches(&patches, viewpoint, &mut by_patches);
//! BruteForce::new(&mesh, &adjacency, EdgeFilter::All).extract(viewpoint, &mut by_force);
//!
//! by_patches.sort_unstable();
//! assert_eq!(by_patches, by_force);
//! assert!(statistics.edges_tested < patches.wings().len() / 2, "most patches are culled");
//! ```

mod brute_force;
mod patches;
mod statistics;

pub use brute_force::BruteForce;
pub use patches::{extract_all_wings, extract_patches};
pub use statistics::Statistics;
