//! Small assets of each kind.

use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, InvalidPatches, PatchSet, SuperPatch, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, shapes};

use crate::Failure;

pub(crate) fn all() -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let meshes = [
        ("empty", shapes::empty()),
        ("cube", shapes::cube()),
        ("icosphere", shapes::icosphere(80)),
        ("open-grid", shapes::open_grid(32)),
        ("book", shapes::book(3)),
    ];
    let mut seeds = Vec::new();
    for (name, mesh) in meshes {
        let adjacency = MeshAdjacency::new(&mesh);
        for (kind, filter, params) in [
            ("convex", EdgeFilter::Convex, FusionParams::PAPER),
            ("all", EdgeFilter::All, FusionParams::PAPER_MEAN.with_max_partition(None)),
            ("planes", EdgeFilter::All, FusionParams::FAST),
        ] {
            let set = fuse(&mesh, &adjacency, filter, &params, &|_| ControlFlow::Continue(()))?;
            seeds.push((format!("{name}-{kind}"), set.to_bytes()));
            let two_levels = with_second_level(set)?.to_bytes();
            seeds.push((format!("{name}-{kind}-two-levels"), two_levels));
        }
    }
    Ok(seeds)
}

/// All patches but the last in super-patches of one patch each.
fn with_second_level(set: PatchSet) -> Result<PatchSet, InvalidPatches> {
    let count = set.patches().len().saturating_sub(1);
    let of_one = |(first_patch, index): (u32, usize)| {
        let bound = set.patches()[index].bound;
        SuperPatch { bound, first_patch, patch_count: 1 }
    };
    let groups = (0..).zip(0..count).map(of_one).collect();
    set.with_super_patches(groups)
}
