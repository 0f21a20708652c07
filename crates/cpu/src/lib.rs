//! Contour extraction on the CPU.
//!
//! Every extractor but [`extract_naively`] gives the edges of the definition,
//! [`drypoint_mesh::contour_edges`], on any processor and any number of threads. Output goes to memory
//! that the caller keeps, in an order that is the same on all of them.
//!
//! | | looks at | for |
//! |---|---|---|
//! | [`Extractor::edges`], [`Extractor::vertex_pairs`] | patches, then the edges of those that may hold a contour edge, with the newest instructions | every frame: microseconds for a mesh of 100,000 edges |
//! | [`Extractor::edges_of_batch`], [`Extractor::vertex_pairs_of_batch`] | the same from many viewpoints, tile by tile, on all threads | many views of a mesh that does not fit the second-level cache: from some 100,000 edges on |
//! | [`Extractor::edges_on_threads`], [`Extractor::vertex_pairs_on_threads`] | the same from one viewpoint, on all threads | a frame of a mesh of several million edges |
//! | [`RigExtractor::edges`] | patches of parts that keep their shape, and loose edges on posed vertices | a model that moves, or that places meshes many times |
//! | [`Extractor::all_edges`] | every edge, with the same instructions | measuring what patches gain |
//! | [`FaceStrips`], [`StoredPlanes`], [`FaceSigns`] | every edge, with the same instructions | a mesh that is seen from too few viewpoints to build patches for, but from many; measuring |
//! | [`extract_patches`] | the same patches and edges, with exact predicates throughout, nothing laid out | a single view |
//! | [`BruteForce`] | every face, then every edge, with exact predicates | a mesh that is seen once: nothing is laid out |
//! | [`extract_all_wings`] | every edge, with exact predicates | a patch file without its mesh |
//! | [`extract_naively`] | every edge, in f32: inexact | measuring |
//!
//! - Viewpoints are in the space of the mesh: for an instance that is moved, turned or sheared, carry the
//!   viewpoint into it ([`Viewpoint::carried_into`](drypoint_mesh::Viewpoint::carried_into)). Where vertices
//!   move against each other, patches are void: that is what a [`RigExtractor`] is for.
//! - An [`EdgeId`](drypoint_mesh::EdgeId) leads to its vertices by `adjacency.wing(id).ends()`. Vertex
//!   pairs are these, lower number first; of several vertices at one position, the first. An edge of more
//!   than two faces is found once for each of its wings.
//! - What is found is of the edges that the patches were made of, as the
//!   [`EdgeFilter`](drypoint_mesh::EdgeFilter) says.
//! - An [`Extractor`] can be shared by threads; each needs [`Contours`] of its own. All threads are those of
//!   `rayon`, as many as `RAYON_NUM_THREADS` or the pool says that the call is made in.
//! - Patches are best made with [`CostModel::CPU_SIMD`](drypoint_fusion::CostModel::CPU_SIMD), on one level
//!   but for meshes that are large or looked at from close by ([`Levels`](drypoint_fusion::Levels)).
//! - Faces that are seen edge-on cost an exact predicate each, some ten times as much as others. There are
//!   few, but in orthographic views along the flat parts of a machine.
//!
//! - A viewpoint as far away as [`Viewpoint`](drypoint_mesh::Viewpoint) allows is fine. A stray vertex is
//!   not: kernels measure in units of the box of all faces, and where that is a thousand times as large as
//!   what is looked at, they leave more and more to the exact predicate.
//!
//! Figures are in `docs/measurements.md`. The example `orbit` extracts frame by frame.
//!
//! ```
//! use drypoint_cpu::{BruteForce, Contours, Extractor};
//! use drypoint_fusion::{CostModel, FusionParams, fuse};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use glam::DVec3;
//! use std::ops::ControlFlow;
//!
//! let mesh = shapes::icosphere(2_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//!
//! // Once for each mesh, or loaded from a patch file.
//! let params = FusionParams { cost: CostModel::CPU_SIMD, ..FusionParams::FAST };
//! let go_on = |_| ControlFlow::Continue(());
//! let patches = fuse(&mesh, &adjacency, EdgeFilter::All, &params, &go_on).unwrap();
//! let extractor = Extractor::new(&patches);
//!
//! // Once for each frame, into the memory of the last.
//! let viewpoint = Viewpoint::at(DVec3::new(0.0, 2.0, 9.0));
//! let mut contours = Contours::default();
//! let statistics = extractor.edges(viewpoint, &mut contours);
//! assert!(statistics.edges_tested < patches.wings().len() / 2, "most patches are culled");
//!
//! let (mut by_patches, mut by_force) = (contours.to_vec(), Vec::new());
//! BruteForce::new(&mesh, &adjacency, EdgeFilter::All).extract(viewpoint, &mut by_force);
//! by_patches.sort_unstable();
//! assert_eq!(by_patches, by_force);
//!
//! let mut pairs = Contours::default();
//! extractor.vertex_pairs(viewpoint, &mut pairs);
//! for (edge, pair) in contours.iter().zip(&pairs) {
//!     assert_eq!(adjacency.wing(*edge).ends(), *pair);
//! }
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
mod rigged;
mod simd;
mod statistics;
mod strips;
mod threads;
mod whole;

pub use batch::Batch;
pub use brute_force::{BruteForce, FaceSigns, FaceStrips, StoredPlanes, extract_naively};
pub use contours::Contours;
pub use extractor::Extractor;
pub use patches::{extract_all_wings, extract_patches};
pub use rigged::{RigContours, RigExtractor};
pub use simd::Instructions;
pub use statistics::Statistics;
