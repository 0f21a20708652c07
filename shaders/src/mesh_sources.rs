//! Sources of task, mesh and fragment shaders, each complete but for what [`MeshShape::prelude`] gives.

/// What mesh shaders emit for a contour edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Emitted {
    /// A line one pixel wide; fragment entry point `line_color`.
    Lines,
    /// A stroke of two triangles; fragment entry point `stroke_coverage`.
    Strokes,
}

impl Emitted {
    /// Vertices of an edge.
    pub const fn vertices(self) -> u32 {
        match self {
            Self::Lines => 2,
            Self::Strokes => 4,
        }
    }

    /// Primitives of an edge.
    pub const fn primitives(self) -> u32 {
        match self {
            Self::Lines => 1,
            Self::Strokes => 2,
        }
    }
}

/// What comes before the edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Culling {
    /// Every edge is tested: no task shader, mesh entry point `all_edges`.
    Nothing,
    /// Task entry point `cull_patches`, mesh entry point `edges_of_survivors`.
    Patches,
    /// Task entry point `cull_super_patches`, mesh entry point `edges_of_survivors`.
    SuperPatches,
}

impl Culling {
    /// Entry point of the task shader.
    pub const fn task_entry(self) -> Option<&'static str> {
        match self {
            Self::Nothing => None,
            Self::Patches => Some("cull_patches"),
            Self::SuperPatches => Some("cull_super_patches"),
        }
    }

    /// Entry point of the mesh shader.
    pub const fn mesh_entry(self) -> &'static str {
        match self {
            Self::Nothing => "all_edges",
            Self::Patches | Self::SuperPatches => "edges_of_survivors",
        }
    }
}

/// Patches of the super-patches of a task workgroup, at most.
pub const BLOCK_PATCHES: u32 = 128;

/// Sizes of workgroups, and whether what is drawn is written down too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshShape {
    /// Lanes of a task workgroup, at most 128.
    pub task_width: u32,
    /// Lanes of a mesh workgroup.
    pub mesh_width: u32,
    /// Edges of a mesh workgroup, a multiple of its lanes: it emits up to [`Emitted::vertices`] times as many
    /// vertices.
    pub edges_per_workgroup: u32,
    /// Whether segments are written to a buffer.
    pub records: bool,
}

impl MeshShape {
    /// What goes before [`mesh_source`] of the same `culling`.
    pub fn prelude(&self, culling: Culling) -> String {
        let slots = match culling {
            Culling::Nothing | Culling::Patches => self.task_width,
            Culling::SuperPatches => BLOCK_PATCHES,
        };
        let Self { task_width, mesh_width, edges_per_workgroup, records } = self;
        format!(
            "enable wgpu_mesh_shader;\n\
             const TASK_WIDTH: u32 = {task_width}u;\n\
             const SLOTS: u32 = {slots}u;\n\
             const MESH_WIDTH: u32 = {mesh_width}u;\n\
             const EDGES_PER_WORKGROUP: u32 = {edges_per_workgroup}u;\n\
             const RECORDS: bool = {records};\n"
        )
    }
}

/// A source of all stages, for naga: subgroup operations in task and mesh shaders.
macro_rules! stages {
    ([$($culling:literal),+], [$($emitted:literal),+]) => {
        concat!(
            include_str!("../shared/contour.wgsl"),
            include_str!("../shared/segment.wgsl"),
            include_str!("../shared/work.wgsl"),
            include_str!("../shared/edges.wgsl"),
            include_str!("../shared/draw_counters.wgsl"),
            include_str!("../shared/stroke.wgsl"),
            include_str!("../shared/clip.wgsl"),
            include_str!("../shared/emit.wgsl"),
            $(include_str!($culling),)+
            $(include_str!($emitted)),+
        )
    };
}

/// All shaders of one pipeline.
pub const fn mesh_source(culling: Culling, emitted: Emitted) -> &'static str {
    macro_rules! emitting {
        ($($culling:literal),+) => {
            match emitted {
                Emitted::Lines => stages!(
                    [$($culling),+], ["../mesh/lines.wgsl", "../shared/line_color.wgsl"]
                ),
                Emitted::Strokes => stages!(
                    [$($culling),+], ["../shared/strokes.wgsl", "../mesh/strokes.wgsl"]
                ),
            }
        };
    }
    match culling {
        Culling::Nothing => emitting!("../mesh/all_edges.wgsl"),
        Culling::Patches => emitting!(
            "../shared/group.wgsl",
            "../shared/tasks.wgsl",
            "../mesh/patches.wgsl",
            "../mesh/edges_of_survivors.wgsl"
        ),
        Culling::SuperPatches => emitting!(
            "../shared/group.wgsl",
            "../shared/tasks.wgsl",
            "../mesh/super_patches.wgsl",
            "../mesh/edges_of_survivors.wgsl"
        ),
    }
}
