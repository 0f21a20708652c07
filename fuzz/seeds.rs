//! Writes what fuzzing starts from: small assets of each kind.

use std::ops::ControlFlow;
use std::path::PathBuf;

use drypoint_fusion::{FusionParams, PatchSet, SuperPatch, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, shapes};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("usage: seeds FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let meshes = [
        ("empty", shapes::empty()),
        ("cube", shapes::cube()),
        ("icosphere", shapes::icosphere(80)),
        ("open-grid", shapes::open_grid(32)),
        ("book", shapes::book(3)),
    ];
    for (name, mesh) in meshes {
        let adjacency = MeshAdjacency::new(&mesh);
        for (kind, filter, params) in [
            ("convex", EdgeFilter::Convex, FusionParams::PAPER),
            ("all", EdgeFilter::All, FusionParams::PAPER_MEAN.with_max_partition(None)),
            ("planes", EdgeFilter::All, FusionParams::FAST),
        ] {
            let set = fuse(&mesh, &adjacency, filter, &params, &|_| ControlFlow::Continue(()))?;
            set.save(&folder.join(format!("{name}-{kind}")))?;
            with_second_level(set)?.save(&folder.join(format!("{name}-{kind}-two-levels")))?;
        }
    }
    Ok(())
}

/// All patches but the last in super-patches of one patch each.
fn with_second_level(set: PatchSet) -> Result<PatchSet, drypoint_fusion::InvalidPatches> {
    let count = set.patches().len().saturating_sub(1);
    let of_one = |(first_patch, index): (u32, usize)| {
        let bound = set.patches()[index].bound;
        SuperPatch { bound, first_patch, patch_count: 1 }
    };
    let groups = (0..).zip(0..count).map(of_one).collect();
    set.with_super_patches(groups)
}
