//! Triangle meshes, their edges with both neighbours, and the definition of a contour edge.
//!
//! A **contour edge** lies between a face that looks towards the viewpoint and one that looks
//! away. This crate says exactly which edges those are, on any mesh: open, non-manifold,
//! inconsistently wound, with duplicate vertices and faces without area. Everything faster in
//! Drypoint is compared with [`contour_edges`], and whatever disagrees is wrong.
//!
//! ```
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, contour_edges, shapes};
//! use glam::DVec3;
//!
//! let mesh = shapes::icosphere(2_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let mut contours = Vec::new();
//! let viewpoint = Viewpoint::at(DVec3::new(0.0, 0.0, 5.0));
//! contour_edges(&mesh, &adjacency, viewpoint, EdgeFilter::All, &mut contours);
//! assert!(contours.len() > 40, "the contour of a ball is a ring");
//! ```
//!
//! Models that move, or that place one mesh many times, are in [`rig`].
//! Readers for OBJ, PLY, STL and glTF are in [`io`], each behind a feature of its own; procedural
//! meshes, asked for by property, are in [`shapes`].

mod adjacency;
mod classes;
mod contours;
mod facing;
mod mesh;
mod viewpoint;
mod weld;
mod wing;

pub mod io;
pub mod rig;
pub mod shapes;

pub use adjacency::{MeshAdjacency, TopologyReport};
pub use classes::{EdgeClass, EdgeFilter, dihedral_angle};
pub use contours::{contour_edges, contour_vertex_pairs, is_contour};
pub use facing::{face_side, face_sides, has_area, unit_normal, volume_side};
pub use mesh::{Aabb, MAX_TRIANGLES, Mesh, MeshError};
pub use viewpoint::Viewpoint;
pub use weld::weld_by_position;
pub use wing::{EdgeId, HalfEdge, Wing};
