//! How close to edge-on a face of a posed rig may be before f32 cannot tell its side.
//!
//! Faces of rigid parts have the margin of [`EdgePlanes::doubt`], as those of any model. A face that bends is
//! decided from vertices that were posed in f32, and even the definition rounds them to f32, so that its
//! margin is wider, the more so for slivers.
//!
//! Let u = 2⁻²³, what a shader may be off by in one operation. A vertex with k influences and m morph offsets is
//! a sum of w · (M q + t), with q in the frame of a carrier, M and t from there to the frame of the pose. Of each
//! term, rounding M, t, q and w, at most m products and sums of offsets, four products and sums for a coordinate,
//! and one product and k sums to blend are off by (k + 2 m + 10) u of |w| (|M| |q| + |t|), where |M| and the like
//! are sums of sizes. That, over all influences, is δ; the definition is off by u/2 of each coordinate in the space
//! of the rig, and δ is the larger of both.
//!
//! With a, b, c where the corners are, U = b − a, V = c − a and d = v − w a for the viewpoint (v, w), the side is
//! the sign of U × V · d. Moving each corner by δ changes that by at most
//!
//! ```text
//! (2 δ (|U| + |V|) + 4 δ²) (|d| + w δ)  +  w δ |U × V|
//! ```
//!
//! Rounding v and w a is off by 4 u (|v| + w |a|) |U × V|, and differences, the cross and the dot product by
//! 12 u |U| |V| |d|. Beyond that, a GPU may take what is below 2⁻¹²⁶ for 0. The margin is the sum of all these. A
//! face two of whose corners are one vertex is beside no edge, so nobody asks for its side.

use drypoint_mesh::rig::{Rig, Skin};
use glam::{DVec3, DVec4, Vec4};

use super::content::welded_face;
use super::input::{RigInstance, carried};
use super::layout::RigLayout;
use crate::Frame;
use crate::edge::{is_normal_sure, is_side_sure, plane};

/// What a shader may be off by in one operation.
const UNIT: f64 = 1.0 / (1u32 << 23) as f64;

/// More than a few numbers amount to that a GPU takes for 0, because they are below 2⁻¹²⁶.
const FLUSHED: f64 = 1.0 / (1u128 << 120) as f64;

/// A vertex in the frame of a pose.
#[derive(Clone, Copy)]
struct Posed {
    at: DVec3,
    /// δ of the definition, and of a shader.
    doubt: f64,
}

impl RigLayout {
    /// Whether f32 may mistake the side of a face, for each face of the rig: then a GPU may find its edges where
    /// the definition ([`Skin::contour_edges`]) does not, or the reverse. All may be if there is no viewpoint.
    ///
    /// `rig` and `skin` are what this was made of.
    ///
    /// # Panics
    /// If they, or the pose, are of another rig.
    pub fn doubtful_faces(&self, rig: &Rig, skin: &Skin, instance: &RigInstance<'_>) -> Vec<bool> {
        let faces = u32::try_from(rig.triangles().len()).unwrap_or(u32::MAX);
        let Some(viewpoint) = instance.placement.viewpoint_of_part() else {
            return vec![true; rig.triangles().len()];
        };
        let pose = instance.pose;
        let frame = self.frame_of_pose(pose);
        let seen = frame.viewpoint(viewpoint);
        let posed_face = |face: u32| {
            let corners = rig.triangles()[face as usize];
            let [a, b, c] = corners;
            let corners = corners.map(|vertex| self.posed_in_f64(rig, instance, &frame, vertex));
            // Two that are one vertex are at one place, however it is rounded.
            let is_collapsed = a == b || b == c || c == a;
            !is_collapsed && !is_sure(corners, seen)
        };
        let is_face_doubtful = |face: u32| {
            let Some((part, local)) = skin.part_of_face(face) else { return posed_face(face) };
            let place = &self.parts[part as usize];
            let to_rig = &pose.to_scene[place.carrier as usize];
            let shape = &skin.shapes()[skin.parts()[part as usize].shape as usize];
            let corners = welded_face(skin, part, local);
            let positions = shape.mesh.positions();
            let plane = if is_normal_sure(positions, corners) {
                plane(positions, corners, &place.frame)
            } else {
                DVec4::NAN
            };
            let is_flat = viewpoint.carried_into(to_rig).is_none();
            !is_side_sure(plane, carried(viewpoint, to_rig, &place.frame))
                || is_flat && posed_face(face)
        };
        (0..faces).map(is_face_doubtful).collect()
    }

    fn posed_in_f64(
        &self,
        rig: &Rig,
        instance: &RigInstance<'_>,
        frame: &Frame,
        vertex: u32,
    ) -> Posed {
        let pose = instance.pose;
        let position = rig.position(vertex, pose);
        let influences = rig.influences(vertex);
        let offsets = rig.offsets(vertex);
        let mut reach = DVec3::ZERO;
        for (number, influence) in (0..).zip(influences) {
            let to_rig = &pose.to_scene[influence.carrier as usize];
            let center = self.carriers[influence.carrier as usize].frame.center;
            let of_it = offsets.iter().filter(|offset| offset.influence == number);
            let moved =
                of_it.fold((influence.position.as_dvec3() - center).abs(), |sum, offset| {
                    sum + pose.weights[offset.morph as usize].abs() * offset.by.as_dvec3().abs()
                });
            let [x, y, z] = to_rig.matrix3.to_cols_array_2d().map(|c| DVec3::from_array(c).abs());
            let turned = x * moved.x + y * moved.y + z * moved.z;
            let translated = (to_rig.transform_point3(center) - frame.center).abs();
            reach += influence.weight.abs() * (turned + translated);
        }
        let operations = 10.0 + influences.len() as f64 + 2.0 * offsets.len() as f64;
        let of_shader = operations * UNIT * reach.length();
        let of_definition = 0.5 * UNIT * position.length();
        let doubt = of_shader.max(of_definition) * frame.scale + FLUSHED;
        Posed { at: frame.point(position), doubt }
    }
}

/// Whether all of them agree on which side of the face is seen. Not where something is NaN.
fn is_sure(corners: [Posed; 3], viewpoint: Vec4) -> bool {
    let viewpoint = viewpoint.as_dvec4();
    let (v, w) = (viewpoint.truncate(), viewpoint.w);
    let doubt = corners.iter().fold(0.0, |most: f64, corner| most.max(corner.doubt));
    let [a, b, c] = corners.map(|corner| corner.at);
    let (ab, ac, d) = (b - a, c - a, v - w * a);
    let normal = ab.cross(ac);
    // The normal, and with it the vector to the viewpoint.
    let moved = (2.0 * doubt * (ab.length() + ac.length()) + 4.0 * doubt * doubt)
        * (d.length() + w * doubt);
    let along = normal.length() * (w * doubt + 4.0 * UNIT * (v.length() + w * a.length()));
    let rounded = 12.0 * UNIT * ab.length() * ac.length() * d.length() + 4.0 * FLUSHED;
    normal.dot(d).abs() > moved + along + rounded
}
