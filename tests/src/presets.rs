//! The parameters that every test across crates takes in turn.

use drypoint_fusion::{BoundKind, CostModel, FusionParams, Levels, ViewProfile};

/// Meshes up to here take every preset, larger ones those that are quick enough.
pub const SMALL: usize = 20_000;
/// Meshes up to here take those that are slow, too.
const MEDIUM: usize = 150_000;

/// Names and parameters for a mesh of `edges` edges: each preset of the library, each bound, both
/// levels, near and far viewers, and a runtime with hard limits. The published method is given
/// smaller parts of space on larger meshes; BEST and the looser bounds are left out on the largest.
pub fn for_edges(edges: usize) -> Vec<(&'static str, FusionParams)> {
    let default = FusionParams::DEFAULT;
    let paper = FusionParams::PAPER;
    let limit = if edges <= SMALL { 4096 } else { 512 };
    let mut presets = vec![
        ("fast", FusionParams::FAST),
        ("default", default),
        ("two-levels", FusionParams { levels: Levels::Two, ..default }),
        ("paper", paper.with_max_partition(Some(limit))),
    ];
    if edges <= MEDIUM {
        let near = FusionParams { views: ViewProfile::NEAR, levels: Levels::Two, ..default };
        let bound = |bound| FusionParams { bound, ..FusionParams::FAST };
        presets.extend([
            ("best", FusionParams::BEST),
            ("near-two-levels", near),
            ("mean", bound(BoundKind::Mean)),
            ("reduced", bound(BoundKind::Reduced)),
            ("minimal", bound(BoundKind::Minimal)),
            ("paper-mean", FusionParams::PAPER_MEAN.with_max_partition(Some(limit))),
        ]);
    }
    if edges <= SMALL {
        let mesh_shader = FusionParams { cost: CostModel::MESH_SHADER, ..FusionParams::FAST };
        presets.extend([
            ("mesh-shader", mesh_shader),
            ("paper-128", paper.with_max_partition(Some(128))),
            ("paper-whole", paper.with_max_partition(None)),
        ]);
    }
    presets
}
