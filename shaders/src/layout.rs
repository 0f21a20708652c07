//! The structs that shaders read and write, as they lie in buffers.

use bytemuck::{Pod, Zeroable};
use drypoint_bounds::DoubleCone;
use drypoint_mesh::EdgeId;
use glam::{DAffine3, Mat4, Vec2, Vec3, Vec4};

/// Lanes that handle one segment each in a workgroup of what follows extraction.
pub const SEGMENTS_PER_WORKGROUP: u32 = 64;

/// Workgroups in a row of [`Arguments::workgroups`].
pub const ROW: u32 = 32_768;

/// A patch with its edges, or a super-patch with its patches.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Group {
    /// In the frame of its part.
    pub bound: DoubleCone,
    /// Its first edge or patch.
    pub first: u32,
    /// Number of edges or patches.
    pub count: u32,
    /// The part it belongs to.
    pub part: u32,
    /// What it counts as in statistics: 1, or 0 for a further piece of one and for what stands for none.
    pub weight: u32,
}

/// What one dispatch has to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Work {
    /// First edge for brute force, first patch or super-patch otherwise.
    pub first_item: u32,
    /// Number of these for each instance.
    pub item_count: u32,
    /// Number of these for a workgroup; no more than its width, but for brute force.
    pub items_per_workgroup: u32,
    /// The first instance.
    pub first_instance: u32,
    /// Number of instances.
    pub instance_count: u32,
    /// Parts of an instance: part p of instance i is placement `first_placement + i * part_count + p`.
    pub part_count: u32,
    /// The part that the edges belong to; for brute force.
    pub part: u32,
    /// Segments that fit the output.
    pub segment_capacity: u32,
    /// Where the placements of these parts begin: 0, but for those of a rig.
    pub first_placement: u32,
    /// Instances that a frame has room for.
    pub most_instances: u32,
    /// Workgroups along x.
    pub row: u32,
}

/// What is counted during one dispatch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Counters {
    /// Where its first segment goes.
    pub first_segment: u32,
    /// Contour edges found.
    pub segments: u32,
    /// Edges tested.
    pub edges_tested: u32,
    /// Patches tested.
    pub patches_tested: u32,
    /// Patches that were not culled.
    pub patches_accepted: u32,
    /// Super-patches tested.
    pub super_patches_tested: u32,
    /// Super-patches that were not culled.
    pub super_patches_accepted: u32,
}

/// What is counted during one draw of mesh shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct DrawCounters {
    /// Contour edges found.
    pub segments: u32,
    /// Edges tested.
    pub edges_tested: u32,
    /// Patches tested.
    pub patches_tested: u32,
    /// Patches that were not culled.
    pub patches_accepted: u32,
    /// Super-patches tested.
    pub super_patches_tested: u32,
    /// Super-patches that were not culled.
    pub super_patches_accepted: u32,
    /// Entries of [`Content::patches`](crate::Content::patches) that were not culled: further pieces of a
    /// patch too, and edges that no patch holds.
    pub groups_accepted: u32,
    /// Mesh workgroups that task shaders launched.
    pub mesh_workgroups: u32,
    /// Mesh workgroups without a contour edge among their edges.
    pub idle_mesh_workgroups: u32,
}

/// What was counted since extraction began: pairs of a low and a high word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Totals {
    /// Contour edges found, whether they fit or not.
    pub segments: [u32; 2],
    /// Edges tested.
    pub edges_tested: [u32; 2],
    /// Patches tested.
    pub patches_tested: [u32; 2],
    /// Patches that were not culled.
    pub patches_accepted: [u32; 2],
    /// Super-patches tested.
    pub super_patches_tested: [u32; 2],
    /// Super-patches that were not culled.
    pub super_patches_accepted: [u32; 2],
}

/// A contour edge as seen from one placement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Pod, Zeroable)]
#[repr(C)]
pub struct Segment {
    /// Vertex with the lower index; vertices are numbered on from part to part.
    pub from_vertex: u32,
    /// Vertex with the higher index.
    pub to_vertex: u32,
    /// Part p of instance i is `i * part_count + p`.
    pub placement: u32,
    /// Id of the edge in the mesh of its part.
    pub edge: EdgeId,
}

/// A [`Segment`] as a line in the space of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PlacedSegment {
    /// Where it begins.
    pub from_position: Vec3,
    /// As [`Segment::placement`].
    pub placement: u32,
    /// Where it ends.
    pub to_position: Vec3,
    /// As [`Segment::edge`].
    pub edge: EdgeId,
}

/// Indirect arguments that go with the segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Arguments {
    /// To draw a list of lines: vertices, two a segment, instances, first vertex, first instance.
    pub line_list: [u32; 4],
    /// To draw a strip of four vertices for each segment, which is an instance.
    pub quads: [u32; 4],
    /// To dispatch [`SEGMENTS_PER_WORKGROUP`] lanes a workgroup, in rows of [`ROW`]: workgroups along x, y
    /// and z, and then the number of segments.
    pub workgroups: [u32; 4],
}

impl Arguments {
    /// Byte at which [`Arguments::line_list`] begins.
    pub const LINE_LIST: u64 = 0;
    /// Byte at which [`Arguments::quads`] begins.
    pub const QUADS: u64 = 16;
    /// Byte at which [`Arguments::workgroups`] begins.
    pub const WORKGROUPS: u64 = 32;
}

/// Rows of an affine map from the space of a part to that of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Transform {
    /// Gives x, as the product with (x, y, z, 1).
    pub x: Vec4,
    /// Gives y.
    pub y: Vec4,
    /// Gives z.
    pub z: Vec4,
}

impl From<DAffine3> for Transform {
    fn from(map: DAffine3) -> Self {
        let rows = map.matrix3.transpose();
        let row = |axis: glam::DVec3, moved: f64| axis.extend(moved).as_vec4();
        let moved = map.translation;
        Self {
            x: row(rows.x_axis, moved.x),
            y: row(rows.y_axis, moved.y),
            z: row(rows.z_axis, moved.z),
        }
    }
}

/// Which part of a model is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Part {
    /// Its index in the model.
    pub part: u32,
    /// Parts of an instance: part p of instance i is placement `first_placement + i * part_count + p`.
    pub part_count: u32,
    /// Where the placements of these parts begin: 0, but for those of a rig.
    pub first_placement: u32,
}

/// How segments are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Stroke {
    /// From the space of the scene to clip space, where z runs from 0 to w.
    pub scene_to_clip: Mat4,
    /// Red, green and blue multiplied by alpha, and alpha.
    pub color: Vec4,
    /// In pixels.
    pub half_width: f32,
    /// Up to a multiple of 16 bytes.
    pub padding: [f32; 3],
}

/// The depth texture that lines are tested against.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Raster {
    /// In pixels.
    pub size: Vec2,
    /// 1 where farther is larger, -1 where it is smaller.
    pub depth_sign: f32,
    /// Between two values of the texture; 0 if they are f32.
    pub depth_step: f32,
}
