//! `drypoint extract`: the contour edges seen from a viewpoint.

use drypoint_cpu::{BruteForce, Statistics, extract_all_wings, extract_patches};
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeFilter, EdgeId, Viewpoint};
use glam::DVec3;
use serde::Serialize;

use crate::args::{ExtractArgs, Method};
use crate::gpu::{self, Api};
use crate::memory::Work;
use crate::output::{print, print_json, tell};
use crate::patches;
use crate::rigged;
use crate::source::{Source, holding, is_patches, load_patches};

/// What was found, in the shape that scripts read.
#[derive(Debug, Serialize)]
pub(crate) struct Found {
    method: &'static str,
    edges: usize,
    pub(crate) patches: usize,
    patches_tested: usize,
    patches_accepted: usize,
    pub(crate) super_patches: usize,
    super_patches_tested: usize,
    super_patches_accepted: usize,
    edges_tested: usize,
    contour_edges: usize,
    contour: Vec<[u32; 2]>,
}

pub(crate) fn run(args: &ExtractArgs) -> Result<(), String> {
    let viewpoint = viewpoint(args)?;
    let has_patches = is_patches(&args.model);
    let fuses = args.method.is_some_and(goes_through_patches) && !has_patches;
    if let Some(option) = args.fusion.first_given().filter(|_| !fuses) {
        return Err(format!(
            "{option}: is for building patches: --method patches, wgpu or ash on a mesh"
        ));
    }
    if has_patches {
        args.animation.check_patches(&args.model)?;
    }
    // What cannot be done is told before the mesh is read.
    args.method.and_then(Method::api).map_or(Ok(()), Api::check_feature)?;
    rigged::check(args)?;
    let found =
        if has_patches { from_patch_file(args, viewpoint)? } else { from_mesh(args, viewpoint)? };
    if args.json {
        return print_json(&found);
    }
    let lines: String = found.contour.iter().map(|[a, b]| format!("{a} {b}\n")).collect();
    print(lines.as_bytes())?;
    tell(&format!(
        "{}: {} contour edges; {} of {} edges and {} of {} patches tested, {} accepted",
        found.method,
        found.contour_edges,
        found.edges_tested,
        found.edges,
        found.patches_tested,
        found.patches,
        found.patches_accepted
    ));
    Ok(())
}

/// What is to be done with a mesh.
fn work(args: &ExtractArgs) -> Work {
    if args.method.is_some_and(goes_through_patches) { Work::Patches } else { Work::Edges }
}

pub(crate) fn goes_through_patches(method: Method) -> bool {
    method != Method::BruteForce
}

fn viewpoint(args: &ExtractArgs) -> Result<Viewpoint, String> {
    match (args.eye, args.direction) {
        (_, Some(DVec3::ZERO)) => Err("--direction 0,0,0 is no direction".to_owned()),
        (_, Some(direction)) => Ok(Viewpoint::from_direction(direction)),
        (eye, None) => Ok(Viewpoint::at(eye.unwrap_or_default())),
    }
}

fn from_mesh(args: &ExtractArgs, viewpoint: Viewpoint) -> Result<Found, String> {
    let source = Source::load(&args.model, args.read, work(args))?;
    if args.animation.find(&source)?.is_some() {
        return rigged::extract(args, &source, viewpoint);
    }
    let adjacency = source.adjacency();
    let filter = args.edges.map_or(EdgeFilter::Convex, Into::into);
    let mut contours = Vec::new();
    if args.method.is_some_and(goes_through_patches) {
        let built = patches::build(&source, &adjacency, filter, &args.fusion)?;
        return from_patches(&built, viewpoint, args.method);
    }
    let mut brute_force = BruteForce::new(source.mesh(), &adjacency, filter);
    let statistics = brute_force.extract(viewpoint, &mut contours);
    let ends = contours.iter().map(|&edge| adjacency.wing(edge).ends());
    Ok(found("brute-force", brute_force.edge_count(), statistics, ends.collect()))
}

fn from_patch_file(args: &ExtractArgs, viewpoint: Viewpoint) -> Result<Found, String> {
    let patches = holding(load_patches(&args.model)?, args.edges, &args.model)?;
    from_patches(&patches, viewpoint, args.method)
}

fn from_patches(
    patches: &PatchSet,
    viewpoint: Viewpoint,
    method: Option<Method>,
) -> Result<Found, String> {
    let mut contours = Vec::new();
    let (method, statistics) = if let Some(api) = method.and_then(Method::api) {
        (api.name(), gpu::extract(api, patches, viewpoint, &mut contours)?)
    } else if method == Some(Method::BruteForce) {
        ("brute-force", extract_all_wings(patches, viewpoint, &mut contours))
    } else {
        ("patches", extract_patches(patches, viewpoint, &mut contours))
    };
    Ok(Found { method, ..with_patches(patches, statistics, &contours) })
}

fn with_patches(patches: &PatchSet, statistics: Statistics, contours: &[EdgeId]) -> Found {
    let mut is_contour = contours.to_vec();
    is_contour.sort_unstable();
    let wings = patches.wings().iter().zip(patches.edge_ids());
    let seen = wings.filter(|(_, edge)| is_contour.binary_search(edge).is_ok());
    let pairs = seen.map(|(wing, _)| wing.ends()).collect();
    let found = found("patches", patches.wings().len(), statistics, pairs);
    let super_patches = patches.super_patches().len();
    Found { patches: patches.patches().len(), super_patches, ..found }
}

/// Sorts the pairs and leaves one of those that several wings of a non-manifold edge share.
pub(crate) fn found(
    method: &'static str,
    edges: usize,
    statistics: Statistics,
    mut contour: Vec<[u32; 2]>,
) -> Found {
    contour.sort_unstable();
    contour.dedup();
    Found {
        method,
        edges,
        patches: 0,
        patches_tested: statistics.patches_tested,
        patches_accepted: statistics.patches_accepted,
        super_patches: 0,
        super_patches_tested: statistics.super_patches_tested,
        super_patches_accepted: statistics.super_patches_accepted,
        edges_tested: statistics.edges_tested,
        contour_edges: contour.len(),
        contour,
    }
}
