//! How a rig is laid out: the structs that shaders read, as they lie in buffers, and where its placements are.

use bytemuck::{Pod, Zeroable};
use drypoint_mesh::EdgeId;
use glam::{DVec3, Vec3, Vec4};

use crate::Frame;

/// What a rig has of everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RigCounts {
    /// Where vertices that are posed begin among the positions, after those of the shapes.
    pub first_vertex: u32,
    /// Of these, for each instance.
    pub vertex_count: u32,
    /// Faces that bend; those of rigid parts that loose edges need follow.
    pub bending_count: u32,
    /// Both.
    pub face_count: u32,
    /// Carriers.
    pub carrier_count: u32,
    /// Morph targets.
    pub morph_count: u32,
}

/// Rows of an affine map from the frame of a carrier to that of the pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CarrierTransform {
    /// Gives x, as the product with (x, y, z, 1).
    pub x: Vec4,
    /// Gives y.
    pub y: Vec4,
    /// Gives z.
    pub z: Vec4,
    /// 1 if the carrier mirrors: the corners of its faces run the other way. Else 0.
    pub is_mirrored: u32,
    /// Up to a multiple of 16 bytes.
    pub padding: [u32; 3],
}

/// A carrier's part in a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct VertexInfluence {
    /// Where the vertex is in the frame of the carrier.
    pub position: Vec3,
    /// Its share.
    pub weight: f32,
    /// Index of the carrier.
    pub carrier: u32,
    /// The first [`MorphOffset`] that displaces it ...
    pub first_offset: u32,
    /// ... and one past the last.
    pub offset_end: u32,
    /// 1 for the last influence of a vertex, else 0.
    pub is_last: u32,
}

/// What a morph target adds to a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MorphOffset {
    /// At weight 1, in the frame of the carrier.
    pub by: Vec3,
    /// Index of the morph target.
    pub morph: u32,
}

/// A face that bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct BendingFace {
    /// Its vertices, among those that are posed.
    pub corners: [u32; 3],
    /// The carrier that turns it over if it mirrors.
    pub carrier: u32,
}

/// A face of a rigid part, beside a loose edge.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PartFace {
    /// In the frame of the part's shape, bit for bit as edges of the shape have it.
    pub plane: Vec4,
    /// Placements that an instance has in classes before that of the part.
    pub placements_before: u32,
    /// Placements that it has in the class of the part.
    pub class_placements: u32,
    /// Which of these is the part's.
    pub place: u32,
    /// The carrier of the part.
    pub carrier: u32,
}

/// An edge beside a face that bends, or between rigid parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct LooseEdge {
    /// Faces that bend come first, those of parts follow.
    pub left_face: u32,
    /// The same.
    pub right_face: u32,
    /// The lower index, counted from the first vertex that is posed.
    pub from_vertex: u32,
    /// The higher one.
    pub to_vertex: u32,
    /// Its id in the rig.
    pub edge: EdgeId,
    /// 1 where the right face is wound the other way, else 0.
    pub is_right_turned: u32,
}

impl LooseEdge {
    /// Twin of `is_loose_contour` in rig/edges.wgsl, of the sides of its faces.
    pub fn is_contour(&self, left: u32, right: u32) -> bool {
        let is_turned = self.is_right_turned ^ ((left ^ right) >> 2);
        (left & 1) != ((right >> is_turned) & 1)
    }
}

/// Shapes that equally many rigid parts have: one dispatch finds the contours of all of these parts, and each
/// shape is there once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassLayout {
    /// The shapes.
    pub shapes: Vec<u32>,
    /// How many parts have each.
    pub copies: u32,
    /// These parts: copy c of the shape at place s is at `c * shapes + s`.
    pub parts: Vec<u32>,
    /// Placements that an instance has in the classes before.
    pub placements_before: u32,
}

/// Where the vertices of one carrier are, in its space.
#[derive(Clone, Copy, Debug)]
pub(super) struct CarrierBox {
    pub(super) frame: Frame,
    /// Half its sides, in the carrier's units; negative if no vertex that is posed follows the carrier.
    pub(super) half_sides: DVec3,
}

/// A rigid part.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartPlace {
    pub(super) carrier: u32,
    /// Of its shape.
    pub(super) frame: Frame,
    pub(super) placements_before: u32,
    pub(super) class_placements: u32,
    pub(super) place: u32,
}

/// What a rig has of everything, and how it is placed.
///
/// An instance has a placement for each rigid part, and one for what is loose. In a frame with room for n
/// instances, those of each class follow one another: that of the part at place p of a class with k parts, in
/// instance i, is `n * placements_before + i * k + p`. The loose ones come last: `n * parts + i`.
#[derive(Clone, Debug)]
pub struct RigLayout {
    /// What there is.
    pub counts: RigCounts,
    /// Rigid parts, by how many have one shape.
    pub classes: Vec<ClassLayout>,
    pub(super) carriers: Vec<CarrierBox>,
    pub(super) parts: Vec<PartPlace>,
}

impl RigLayout {
    /// Number of rigid parts.
    pub fn part_count(&self) -> u32 {
        count(self.parts.len())
    }

    /// The placement of a part, in a frame with room for `most_instances`.
    pub fn placement(&self, part: u32, instance: u32, most_instances: u32) -> u32 {
        let PartPlace { placements_before, class_placements, place, .. } =
            self.parts[part as usize];
        placements_before * most_instances + instance * class_placements + place
    }

    /// The instance that a placement is of, and the part if it is not that of loose edges.
    pub fn placed(&self, placement: u32, most_instances: u32) -> (u32, Option<u32>) {
        let first = |class: &ClassLayout| class.placements_before * most_instances;
        let loose = self.part_count() * most_instances;
        if placement >= loose {
            return (placement - loose, None);
        }
        // Classes are never empty.
        let class = self.classes.partition_point(|class| first(class) <= placement) - 1;
        let class = &self.classes[class];
        let (place, parts) = (placement - first(class), count(class.parts.len()));
        (place / parts, Some(class.parts[(place % parts) as usize]))
    }
}

pub(super) fn count(length: usize) -> u32 {
    u32::try_from(length).expect("what a rig has is counted in 32 bits")
}
