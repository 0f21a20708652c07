//! Sources, each complete but for the line that [`prelude`] gives.

/// The tests of patches and edges alone, pure functions without bindings.
pub const CONTOUR: &str = include_str!("../shared/contour.wgsl");

/// A source of extraction.
macro_rules! extraction {
    ($($file:literal),+) => {
        concat!(
            include_str!("../shared/contour.wgsl"),
            include_str!("../shared/segment.wgsl"),
            include_str!("../shared/work.wgsl"),
            include_str!("../shared/counters.wgsl"),
            include_str!("../shared/edges.wgsl"),
            include_str!("../shared/append.wgsl"),
            $(include_str!($file)),+
        )
    };
}

/// Entry point `brute_force`.
pub const BRUTE_FORCE: &str = extraction!("../brute_force.wgsl");

/// Entry point `patches_and_edges`.
pub const PATCHES: &str =
    extraction!("../shared/group.wgsl", "../shared/survivors.wgsl", "../patches.wgsl");

/// Entry point `super_patches_to_edges`.
pub const SUPER_PATCHES: &str =
    extraction!("../shared/group.wgsl", "../shared/survivors.wgsl", "../super_patches.wgsl");

/// Entry point `tally`.
pub const TALLY: &str = concat!(
    include_str!("../shared/segment.wgsl"),
    include_str!("../shared/work.wgsl"),
    include_str!("../shared/counters.wgsl"),
    include_str!("../tally.wgsl"),
);

/// Entry point `pose_vertices`, after the line of [`prelude`], as the two that follow.
pub const RIG_VERTICES: &str = concat!(
    include_str!("../shared/work.wgsl"),
    include_str!("../shared/rig.wgsl"),
    include_str!("../rig/vertices.wgsl"),
);

/// Entry point `find_sides`.
pub const RIG_FACES: &str = concat!(
    include_str!("../shared/contour.wgsl"),
    include_str!("../shared/work.wgsl"),
    include_str!("../shared/rig.wgsl"),
    include_str!("../rig/faces.wgsl"),
);

/// Entry point `test_loose_edges`.
pub const RIG_EDGES: &str = concat!(
    include_str!("../shared/segment.wgsl"),
    include_str!("../shared/work.wgsl"),
    include_str!("../shared/counters.wgsl"),
    include_str!("../shared/rig.wgsl"),
    include_str!("../shared/append.wgsl"),
    include_str!("../rig/edges.wgsl"),
);

/// Entry point `place_segments`.
pub const POSITIONS: &str =
    concat!(include_str!("../shared/segment.wgsl"), include_str!("../positions.wgsl"));

/// Entry point `place_vertex`: a vertex shader for depth alone.
pub const DEPTH: &str =
    concat!(include_str!("../shared/segment.wgsl"), include_str!("../depth.wgsl"));

/// Entry points `stroke_vertex` and `stroke_coverage`.
pub const LINES: &str = concat!(
    include_str!("../shared/segment.wgsl"),
    include_str!("../shared/stroke.wgsl"),
    include_str!("../shared/clip.wgsl"),
    include_str!("../shared/strokes.wgsl"),
    include_str!("../lines.wgsl"),
);

/// Entry points `line_vertex` and `line_color`.
pub const THIN_LINES: &str = concat!(
    include_str!("../shared/segment.wgsl"),
    include_str!("../shared/stroke.wgsl"),
    include_str!("../shared/clip.wgsl"),
    include_str!("../thin_lines.wgsl"),
    include_str!("../shared/line_color.wgsl"),
);

/// Entry points `whole_screen` and `ink`.
pub const INK: &str = concat!(include_str!("../shared/stroke.wgsl"), include_str!("../ink.wgsl"));

/// Workgroup widths that [`prelude`] takes: powers of two that plain WebGPU allows, and no less than a
/// usual subgroup.
pub const WIDTHS: [u32; 4] = [32, 64, 128, 256];

/// The width where nobody chooses. On an NVIDIA H200 256 lanes are a tenth faster for brute force and for small models
/// on one level, some hundredths slower for large ones and on two levels, and take twice the memory of a workgroup.
pub const USUAL_WIDTH: u32 = 128;

/// What goes before [`BRUTE_FORCE`], [`PATCHES`], [`SUPER_PATCHES`] and those of rigs: lanes in a workgroup, one of
/// [`WIDTHS`].
pub fn prelude(width: u32) -> String {
    format!("const WIDTH: u32 = {width}u;\n")
}
