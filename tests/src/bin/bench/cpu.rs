//! Extraction on the CPU: every brute force and every kernel, in turn.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_cpu::{
    BruteForce, Contours, Extractor, Instructions, extract_all_wings, extract_patches,
};
use drypoint_fusion::{FusionParams, Levels, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, Wing};
use drypoint_tests::compare::compare;
use drypoint_tests::viewpoints;

use crate::quartiles;

/// An extractor, by name: looks from one viewpoint.
type Contender<'a> = (String, Box<dyn FnMut(Viewpoint) + 'a>);

/// Prints the median time of a view for each, and how many times as fast as the first it is.
pub(crate) fn run(mesh: &Mesh, rounds: u32) -> Result<(), String> {
    let adjacency = MeshAdjacency::new(mesh);
    let viewpoints = viewpoints::protocol(mesh);
    let fused = |params| {
        let go_on = |_| ControlFlow::Continue(());
        let set = fuse(mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)
            .map_err(|error| error.to_string())?;
        compare(mesh, &adjacency, &set, &viewpoints)
            .map_err(|wrong| format!("{} disagrees with the definition", wrong.extractor))?;
        Ok::<_, String>(set)
    };
    let patches = fused(FusionParams::DEFAULT)?;
    let two_levels = fused(FusionParams { levels: Levels::Two, ..FusionParams::DEFAULT })?;
    let start = Instant::now();
    black_box(Extractor::new(&patches));
    println!("  laid out in {:.1} ms", 1e3 * start.elapsed().as_secs_f64());
    let brute_force = BruteForce::new(mesh, &adjacency, EdgeFilter::Convex);
    let mut contenders = exact_ones(&patches, brute_force);
    for instructions in Instructions::ALL {
        let Some(extractor) = Extractor::with(&patches, instructions) else { continue };
        let mut contours = Contours::default();
        let every_edge = extractor.clone();
        let look = move |viewpoint| {
            black_box(every_edge.all_edges(viewpoint, &mut contours));
        };
        contenders.push((format!("every edge, {instructions:?}"), Box::new(look)));
        contenders.extend(through_patches(extractor, &format!("{instructions:?}")));
        let extractor = Extractor::with(&two_levels, instructions);
        let name = format!("{instructions:?}, two levels");
        contenders.extend(extractor.into_iter().flat_map(|e| through_patches(e, &name)));
    }
    report(&mut contenders, &viewpoints, rounds);
    Ok(())
}

/// The naive loop, and those with exact predicates throughout.
fn exact_ones<'a>(patches: &'a PatchSet, mut brute_force: BruteForce<'a>) -> Vec<Contender<'a>> {
    let [mut naively, mut every_edge, mut by_face, mut by_patches] = [const { Vec::new() }; 4];
    vec![
        (
            "every edge in f32, normals from vertices, inexact".into(),
            Box::new(move |viewpoint| {
                naive(patches, viewpoint, &mut naively);
                black_box(&naively);
            }),
        ),
        (
            "every edge, exact predicates".into(),
            Box::new(move |viewpoint| {
                black_box(extract_all_wings(patches, viewpoint, &mut every_edge));
            }),
        ),
        (
            "every face, then every edge, exact predicates".into(),
            Box::new(move |viewpoint| {
                black_box(brute_force.extract(viewpoint, &mut by_face));
            }),
        ),
        (
            "patches, exact predicates".into(),
            Box::new(move |viewpoint| {
                black_box(extract_patches(patches, viewpoint, &mut by_patches));
            }),
        ),
    ]
}

fn through_patches<'a>(extractor: Extractor<'a>, name: &str) -> [Contender<'a>; 2] {
    let by_pairs = extractor.clone();
    let (mut edges, mut pairs) = (Contours::default(), Contours::default());
    let look_for_edges = move |viewpoint| {
        black_box(extractor.edges(viewpoint, &mut edges));
    };
    let look_for_pairs = move |viewpoint| {
        black_box(by_pairs.vertex_pairs(viewpoint, &mut pairs));
    };
    [
        (format!("patches, ids, {name}"), Box::new(look_for_edges)),
        (format!("patches, vertex pairs, {name}"), Box::new(look_for_pairs)),
    ]
}

/// Times all in turn, again and again.
fn report(contenders: &mut [Contender<'_>], viewpoints: &[Viewpoint], rounds: u32) {
    let mut times = vec![Vec::new(); contenders.len()];
    // The first round only warms up.
    for round in 0..=rounds {
        for ((_, look), times) in contenders.iter_mut().zip(&mut times) {
            let start = Instant::now();
            viewpoints.iter().for_each(|&viewpoint| look(viewpoint));
            let micros = 1e6 * start.elapsed().as_secs_f64() / viewpoints.len().max(1) as f64;
            if round > 0 {
                times.push(micros);
            }
        }
    }
    for ((name, _), own) in contenders.iter().zip(&times) {
        let ratios = times[0].iter().zip(own).map(|(first, own)| first / own).collect();
        let [low, ratio, high] = quartiles(ratios);
        let micros = quartiles(own.clone())[1];
        println!("  {name:<50}{micros:>9.1} µs {ratio:>7.1} x [{low:.1}, {high:.1}]");
    }
}

/// What renderers do, and the first thing one would write: two normals for each edge, and the signs as
/// they come. Edges that are seen at grazing angles may be lost or invented.
fn naive(patches: &PatchSet, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) {
    let (eye, positions) = (viewpoint.xyz().as_vec3(), patches.positions());
    let is_front = |face: [u32; 3]| {
        let [a, b, c] = face.map(|vertex| positions[vertex as usize]);
        (b - a).cross(c - a).dot(eye - a) >= 0.0
    };
    let is_contour = |wing: &Wing| is_front(wing.left_face()) != is_front(wing.right_face());
    let edges = patches.wings().iter().zip(patches.edge_ids());
    contours.clear();
    contours.extend(edges.filter(|(wing, _)| is_contour(wing)).map(|(_, edge)| *edge));
}
