//! Models that move: nodes, skins, morph targets, animations, and meshes that are placed many times.
//!
//! A [`Rig`] is one mesh whose vertices are carried. A **carrier** is a space that moves as a whole:
//! a joint, an animated node, an instance of a mesh, or the scene itself. Most vertices follow one
//! carrier; others follow several by weights (linear blend skinning), or are displaced by morph
//! targets. A [`Pose`] says where the carriers are, [`Rig::mesh`] what the surface then looks like.
//!
//! [`Skin`] splits a rig into **rigid parts** (Tsiapkolis and Bénard, CGF 2024, §4.1): faces all of
//! whose vertices follow one and the same carrier. A part keeps its shape in every pose, so its
//! edges can be grouped into patches once, in its own space, and the viewpoint is carried there.
//! Parts of one shape share it: an assembly with a thousand screws has one screw. What is left are
//! **loose** edges, beside a face that bends, or between parts; they are tested on posed vertices.
//!
//! [`Skin::contour_edges`] is the definition for models that move: what all that is faster must find.
//!
//! ```
//! use drypoint_mesh::rig::{Influence, RigBuilder, Skin};
//! use drypoint_mesh::{EdgeFilter, Viewpoint};
//! use glam::{DAffine3, DVec3, Vec3};
//!
//! // A tetrahedron in a space of its own, which moves.
//! let mut builder = RigBuilder::default();
//! let carrier = builder.carrier(None, None);
//! let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]
//!     .map(|position| builder.vertex(&[Influence { carrier, weight: 1.0, position }], &[]));
//! for [a, b, c] in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
//!     builder.triangle([corners[a], corners[b], corners[c]]);
//! }
//! let rig = builder.finish();
//!
//! let skin = Skin::new(&rig)?;
//! assert_eq!((skin.parts().len(), skin.rigid_share()), (1, 1.0));
//! let mut pose = rig.rest();
//! pose.to_scene[carrier as usize] = DAffine3::from_translation(DVec3::X) * DAffine3::from_rotation_z(2.0);
//! let mut contours = Vec::new();
//! let viewpoint = Viewpoint::at(DVec3::new(4.0, 3.0, 9.0));
//! skin.contour_edges(&rig, &pose, viewpoint, EdgeFilter::All, &mut contours);
//! assert!(contours.len() >= 3);
//! # Ok::<(), drypoint_mesh::MeshError>(())
//! ```

mod animation;
mod builder;
mod contours;
mod curve;
mod model;
mod nodes;
mod skin;

pub use animation::{Animation, Channel, Property};
pub use builder::{Influence, Offset, RigBuilder};
pub use contours::FaceSides;
pub use curve::{Curve, CurveError, Interpolation};
#[cfg(feature = "gltf")]
pub(crate) use model::posed_position;
pub use model::{Carrier, Morph, Pose, Rig};
pub use nodes::{Local, Node};
pub use skin::{RigidPart, Shape, Skin};
