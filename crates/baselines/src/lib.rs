//! What patches are measured against: hierarchies and meshlets that others have published, built as well
//! as we can.
//!
//! - [`Snch`]: spatialized normal cone hierarchies (Johnson and Cohen, I3D 2001);
//! - [`AnchoredCones`]: forests of anchored cones (Sander et al., Silhouette Clipping, SIGGRAPH 2000, §5);
//! - [`Meshlets`]: those of meshoptimizer, as Tsiapkolis and Bénard use them (CGF 43(4), 2024).
//!
//! All give the edges of the definition, [`drypoint_mesh::contour_edges`], and count what they test. What
//! they take by comparison is in `docs/measurements.md`.
//!
//! ```
//! use drypoint_baselines::{AnchoredCones, Meshlets, Snch};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use glam::DVec3;
//!
//! let mesh = shapes::icosphere(2_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let filter = EdgeFilter::Convex;
//! let snch = Snch::new(&mesh, &adjacency, filter, &Default::default());
//! let cones = AnchoredCones::new(&mesh, &adjacency, filter, &Default::default());
//! let meshlets = Meshlets::new(&mesh, &adjacency, filter, &Default::default());
//!
//! let viewpoint = Viewpoint::at(DVec3::new(0.0, 2.0, 9.0));
//! let mut contours = Vec::new();
//! let counts = [
//!     snch.extract(viewpoint, &mut contours),
//!     cones.extract(viewpoint, &mut contours),
//!     meshlets.extract(viewpoint, &mut contours),
//! ];
//! for counts in counts {
//!     assert!(counts.edges_tested < adjacency.edges(filter).count());
//! }
//! let [tail, head] = adjacency.wing(contours[0]).ends();
//! assert_ne!(tail, head);
//! ```

mod anchored_cones;
#[cfg(test)]
mod check;
mod edges;
mod meshlets;
mod shape;
mod snch;
mod statistics;

pub use anchored_cones::{AnchoredConeParams, AnchoredCones};
pub use meshlets::{MeshletParams, Meshlets};
pub use snch::{Snch, SnchParams};
pub use statistics::Statistics;
