//! The definition of a contour edge of a model that moves.

use std::cmp::Ordering;

use glam::Vec3;

use super::{Pose, Rig, Skin};
use crate::contours::is_front;
use crate::{EdgeFilter, EdgeId, Viewpoint, face_side};

/// Which sides of a rig's faces a viewpoint sees in one pose.
///
/// A face of a rigid part is decided in the space of the part, exactly, from the viewpoint that is carried
/// there: it keeps the shape that it was stored with, and is not rounded anew in every pose. A face that bends is
/// decided in the scene, exactly, on vertices that are posed in f64 and rounded to f32, as [`Rig::mesh`] has
/// them; so are those of a part that is flattened, into which no viewpoint can be carried. There is one sign for each
/// face, so that contours close.
#[derive(Clone, Debug)]
pub struct FaceSides<'a> {
    rig: &'a Rig,
    skin: &'a Skin,
    pose: &'a Pose,
    viewpoint: Viewpoint,
    /// The viewpoint as each part sees it.
    carried: Vec<Option<Viewpoint>>,
    mirrored: Vec<bool>,
    /// Whether any carrier is.
    mirrors: bool,
}

impl<'a> FaceSides<'a> {
    /// Carries `viewpoint` into each part; some 50 ns each.
    ///
    /// # Panics
    /// If `skin` is of another rig, or `pose` has not a place for each carrier.
    pub fn new(rig: &'a Rig, skin: &'a Skin, pose: &'a Pose, viewpoint: Viewpoint) -> Self {
        let carry =
            |part: &super::RigidPart| viewpoint.carried_into(&pose.to_scene[part.carrier as usize]);
        let carried = skin.parts().iter().map(carry).collect();
        let mirrored = rig.mirrored(pose);
        let mirrors = mirrored.contains(&true);
        Self { rig, skin, pose, viewpoint, carried, mirrored, mirrors }
    }

    /// The viewpoint in the space of a part; `None` if that is flattened.
    pub fn carried(&self, part: u32) -> Option<Viewpoint> {
        self.carried[part as usize]
    }

    /// The side of a face that the viewpoint is on: `Greater` in front.
    pub fn side(&self, face: u32) -> Ordering {
        self.side_with(face, |corner| self.posed(self.rig.triangles[face as usize][corner]))
    }

    /// The same, asking `position` where a corner, 0 .. 3, of a face that bends is: for callers who know.
    pub fn side_with(&self, face: u32, position: impl Fn(usize) -> Vec3) -> Ordering {
        if let Some((part, local)) = self.skin.part_of_face(face)
            && let Some(viewpoint) = self.carried(part)
        {
            let shape = &self.skin.shapes()[self.skin.parts()[part as usize].shape as usize];
            return face_side(shape.mesh.corners(local), viewpoint);
        }
        let side = face_side([0, 1, 2].map(position), self.viewpoint);
        if self.is_turned(face) { side.reverse() } else { side }
    }

    /// Whether an edge is a contour, given the sides of its left and its right face.
    pub fn is_contour(&self, edge: EdgeId, [left, right]: [Ordering; 2]) -> bool {
        let adjacency = self.skin.adjacency();
        // Where the right face is wound the other way, or one of them is mirrored, the edge reads it turned
        // over.
        let is_turned = adjacency.is_right_turned(edge)
            ^ adjacency
                .sides(edge)
                .into_iter()
                .fold(false, |turned, half_edge| turned ^ self.is_turned(half_edge.triangle()));
        let right = if is_turned { right.reverse() } else { right };
        is_front(left) != is_front(right)
    }

    /// Where a vertex is, as [`Rig::mesh`] has it.
    pub fn posed(&self, vertex: u32) -> Vec3 {
        self.rig.position(vertex, self.pose).as_vec3()
    }

    /// Whether a carrier mirrors a face.
    fn is_turned(&self, face: u32) -> bool {
        // Most poses mirror nothing.
        self.mirrors && {
            let [corner, ..] = self.rig.triangles[face as usize];
            self.mirrored[self.rig.leading_carrier(corner) as usize]
        }
    }
}

impl Skin {
    /// Writes to `contours` the contour edges of `rig` in a pose, among those that `filter` keeps, by id in
    /// [`Skin::adjacency`]. What it held is replaced.
    ///
    /// Brute force on the surface that [`Rig::mesh`] shows, but that rigid faces are decided before that
    /// surface is rounded to f32 ([`FaceSides`]). The two differ in edges with a face that is seen edge-on
    /// to within that rounding: some two in a million on the models that were tried.
    ///
    /// # Panics
    /// As [`FaceSides::new`].
    pub fn contour_edges(
        &self,
        rig: &Rig,
        pose: &Pose,
        viewpoint: Viewpoint,
        filter: EdgeFilter,
        contours: &mut Vec<EdgeId>,
    ) {
        let faces = FaceSides::new(rig, self, pose, viewpoint);
        let count = u32::try_from(rig.triangles().len()).unwrap_or(u32::MAX);
        let sides: Vec<Ordering> = (0..count).map(|face| faces.side(face)).collect();
        contours.clear();
        let is_contour = |&edge: &EdgeId| {
            let of_edge = self.adjacency().sides(edge);
            faces.is_contour(edge, of_edge.map(|half_edge| sides[half_edge.triangle() as usize]))
        };
        contours.extend(self.edges(filter).filter(is_contour));
    }
}
