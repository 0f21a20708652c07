//! Each patch from its own cull boundary, and small meshes from near by.

use std::time::Instant;

use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency};
use drypoint_tests::boundary::{Looked, LostEdge, look};
use drypoint_tests::compare::Expected;
use drypoint_tests::presets::SMALL;
use drypoint_tests::{meshes, viewpoints};

use crate::{FILTERS, Options, explain, name_edge, name_viewpoint, patches, selected};

/// Viewpoints on, in and beside each small mesh: more than 100,000 over the shapes and models.
const NEAR_VIEWPOINTS: usize = 4_000;

/// What was looked at, over all meshes and presets.
#[derive(Default)]
struct Total {
    on_boundaries: Looked,
    /// Different ones, whatever the number of presets that they were given to.
    near: usize,
    sets: usize,
}

pub(crate) fn run(options: &Options) -> Result<(), String> {
    println!(
        "{:<24} {:<7}{:<16}{:>9}{:>8}{:>7}{:>11}{:>10}{:>8}",
        "mesh", "filter", "preset", "edges", "patches", "super", "boundary", "culled", "s"
    );
    let mut total = Total::default();
    meshes::for_each(&options.only, |name, mesh| validate(name, mesh, options, &mut total))?;
    if total.sets == 0 {
        return Err(format!("no preset has {:?} in its name", options.preset));
    }
    println!(
        "no contour edge is lost: {} patch sets, {} viewpoints on cull boundaries, {} of them culled, \
         {} viewpoints near a mesh or around it",
        total.sets, total.on_boundaries.viewpoints, total.on_boundaries.culled, total.near
    );
    Ok(())
}

fn validate(name: &str, mesh: &Mesh, options: &Options, total: &mut Total) -> Result<(), String> {
    let adjacency = MeshAdjacency::new(mesh);
    let is_small = adjacency.edges(EdgeFilter::All).count() <= SMALL;
    // The patches of a large mesh are many, and all edges make no harder ones than the convex.
    let filters = if is_small { &FILTERS[..] } else { &FILTERS[..1] };
    for &(filter, filter_name) in filters {
        let mut around = Vec::new();
        if is_small {
            around = viewpoints::near_at_random(mesh, NEAR_VIEWPOINTS / filters.len());
            around.extend(viewpoints::protocol(mesh));
        }
        let expected = Expected::new(mesh, &adjacency, filter, &around)
            .map_err(|wrong| format!("{name} ({filter_name}): {}", explain(&adjacency, &wrong)))?;
        total.near += around.len();
        for (preset, params) in selected(options, adjacency.edges(filter).count()) {
            let fail = |why: String| format!("{name} ({filter_name}, {preset}): {why}");
            let start = Instant::now();
            let set = patches(mesh, &adjacency, filter, &params).map_err(fail)?;
            let looked =
                look(&set, options.viewpoints).map_err(|lost| fail(tell(&adjacency, &lost)))?;
            expected.compare(&set).map_err(|wrong| fail(explain(&adjacency, &wrong)))?;
            println!(
                "{name:<24} {filter_name:<7}{preset:<16}{:>9}{:>8}{:>7}{:>11}{:>10}{:>8.1}",
                set.wings().len(),
                set.patches().len(),
                set.super_patches().len(),
                looked.viewpoints,
                looked.culled,
                start.elapsed().as_secs_f64()
            );
            total.on_boundaries += looked;
            total.sets += 1;
        }
    }
    Ok(())
}

fn tell(adjacency: &MeshAdjacency, lost: &LostEdge) -> String {
    format!(
        "{} {} loses edge {} from {}",
        if lost.is_super { "super-patch" } else { "patch" },
        lost.patch,
        name_edge(adjacency, lost.edge),
        name_viewpoint(lost.viewpoint)
    )
}
