//! Groups the edges of a mesh into patches that are culled together.
//!
//! From a viewpoint, a few edges in a hundred are contour edges. A **patch** is a set of edges with
//! a bound on the planes of their faces; if the bound says that all of them face the same way, none
//! of its edges is a contour edge, and none is looked at. [`fuse`] finds patches that make a view
//! cheap (Tsiapkolis and Bénard, *Patch Decomposition for Efficient Mesh Contours Extraction*,
//! CGF 43(4), 2024): each edge starts alone, and as long as it lowers the expected cost of a view,
//! the two patches that gain most are fused.
//!
//! The result is a [`PatchSet`]: the asset that a renderer loads, with edges in the order of their
//! patches, so that a patch is a range.
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use drypoint_fusion::{FusionParams, PatchSet, fuse};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, is_contour, shapes};
//! use glam::DVec3;
//!
//! let mesh = shapes::icosphere(2_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let params = FusionParams::DEFAULT;
//! let go_on = |_| ControlFlow::Continue(());
//! let set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)?;
//!
//! let viewpoint = Viewpoint::at(DVec3::new(0.0, 0.0, 5.0));
//! let survivors = set.patches().iter().filter(|patch| patch.bound.may_hold_contour(viewpoint));
//! let tested: Vec<u32> = survivors.flat_map(|patch| patch.edges()).chain(set.always_tested()).collect();
//! let is_seen = |&&place: &&u32| is_contour(set.positions(), &set.wings()[place as usize], viewpoint);
//! let contours = tested.iter().filter(is_seen).count();
//! assert!(contours > 40 && tested.len() < set.wings().len() / 2);
//!
//! assert_eq!(PatchSet::from_bytes(&set.to_bytes())?, set);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrange;
mod bound;
mod cluster;
mod columns;
mod cost;
mod disk;
mod error;
mod extent;
mod file;
mod fuse;
mod geometry;
mod greedy;
mod grow;
mod header;
mod lanes;
mod limits;
mod params;
mod partition;
mod patch_set;
mod planes;
mod progress;
mod screen;
mod shapes;
mod validate;

pub use cost::{CostModel, VIEW_DISTANCES, ViewProfile};
pub use error::{FuseError, InvalidParams};
pub use file::{PatchFile, PatchFileError};
pub use fuse::{fuse, fuse_edges};
pub use params::{BoundKind, FusionParams, Levels, Method, SphereKind};
pub use patch_set::{Patch, PatchSet, Provenance, Summary, SuperPatch, mesh_hash};
pub use progress::{Cancelled, Progress};
pub use shapes::fuse_shapes;
pub use validate::InvalidPatches;
