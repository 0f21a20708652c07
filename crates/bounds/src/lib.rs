//! Bounds on sets of planes, by which a patch of edges is culled without looking at them.
//!
//! An edge is a contour edge if one of its faces looks towards the viewpoint and the other away. If
//! all faces around a patch of edges look the same way, no edge of it is one, and a bound on the
//! planes of the faces can tell, in a few operations: that the bound says *culled* is a proof, that
//! the patch survives is only a suspicion. So everything here errs to one side. What cannot be
//! bounded (a face without area, normals over a hemisphere or more, NaN) is never culled, and every
//! rounding goes outward.
//!
//! Bounds are built in f64 and evaluated in f32:
//!
//! - [`NormalCone`]: the directions of the normals, around their mean or as narrow as can be.
//! - [`Sphere`]: a ball that every plane meets, by the edges' vertices or by the lines through them.
//! - [`SpatializedNormalCone`]: both together (Johnson and Cohen, I3D 2001), and the test of
//!   Tsiapkolis and Bénard (CGF 2024, eq. 1) in f64, as reference.
//! - [`DoubleCone`]: the same set of viewpoints as two cones, back to back, in 8 floats for a GPU:
//!   no root, no division, no trigonometry. Made from both of these, or by [`DoubleCone::tight`] from
//!   the planes themselves: as cheap to test, and never looser.
//!
//! ```
//! use drypoint_bounds::{DoubleCone, NormalCone, Plane, SpatializedNormalCone, Sphere};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use glam::DVec3;
//!
//! let mesh = shapes::icosphere(2_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let position = |vertex| mesh.position(vertex).as_dvec3();
//! let normal = |[a, b, c]: [u32; 3]| {
//!     let normal = (position(b) - position(a)).cross(position(c) - position(a));
//!     normal / normal.length() // NaN for a face without area, and then nothing is culled.
//! };
//!
//! // One patch of the edges around the north pole of the ball.
//! let is_polar = |wing: &drypoint_mesh::Wing| wing.ends().iter().all(|&v| position(v).z > 0.9);
//! let wings: Vec<_> = adjacency
//!     .edges(EdgeFilter::All)
//!     .map(|edge| adjacency.wing(edge))
//!     .filter(is_polar)
//!     .collect();
//! let faces = wings.iter().flat_map(|w| [w.left_face(), w.right_face()]);
//! let planes = faces.map(|face| Plane { normal: normal(face), point: position(face[0]) });
//! let cone = DoubleCone::tight(planes.clone());
//!
//! let from = |x, y, z| cone.may_hold_contour(Viewpoint::at(DVec3::new(x, y, z)));
//! assert!(!from(0.0, 0.0, 5.0), "from above, all its faces look this way");
//! assert!(!from(0.0, 0.0, -5.0), "from below, none does");
//! assert!(from(5.0, 0.0, 0.9), "from the side, who knows");
//! assert!(cone.acceptance(5.0) < 0.5, "half of the viewpoints see some contour here, at most");
//!
//! // As published, with a sphere between the planes and the cones: larger, and no cheaper.
//! let bound = SpatializedNormalCone {
//!     cone: NormalCone::mean(planes.map(|plane| plane.normal)),
//!     sphere: Sphere::reduced(wings.iter().map(|wing| [position(wing.tail), position(wing.head)])),
//! };
//! assert!(cone.acceptance(5.0) < 0.9 * DoubleCone::from(bound).acceptance(5.0));
//! ```

mod cap;
mod cone;
mod double_cone;
mod least_ball;
mod least_spread;
mod spatialized;
mod sphere;
mod tight;

pub use cone::NormalCone;
pub use double_cone::{DoubleCone, MAX_HALF_ANGLE, MIN_CLEARANCE, SLACK};
pub use spatialized::SpatializedNormalCone;
pub use sphere::Sphere;
pub use tight::Plane;
