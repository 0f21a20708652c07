//! Extraction on the CPU: every brute force and every kernel, in turn.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_cpu::{
    Batch, BruteForce, Extractor, FaceSigns, FaceStrips, Instructions, StoredPlanes,
    extract_all_wings, extract_naively, extract_patches,
};
use drypoint_fusion::{CostModel, FusionParams, Levels, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use drypoint_tests::compare::compare;
use drypoint_tests::viewpoints;
use rayon::ThreadPoolBuilder;

use crate::floor::Floor;
use crate::quartiles;

/// An extractor, by name: looks from all viewpoints.
type Contender<'a> = (String, Box<dyn FnMut(&[Viewpoint]) + 'a>);

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
    let params = FusionParams { cost: CostModel::CPU_SIMD, ..FusionParams::DEFAULT };
    let patches = fused(params)?;
    let by_paper = fused(FusionParams::DEFAULT)?;
    let two_levels = fused(FusionParams { levels: Levels::Two, ..params })?;
    let start = Instant::now();
    black_box(Extractor::new(&patches));
    println!("  laid out in {:.1} ms", 1e3 * start.elapsed().as_secs_f64());
    let [newest, of_default] = [&patches, &by_paper].map(Extractor::new);
    let mut contenders = exact_ones(mesh, &adjacency, &patches);
    for instructions in Instructions::ALL.into_iter().filter(|set| set.are_here()) {
        contenders.extend(brute_forces(mesh, &adjacency, instructions));
        let name = format!("{instructions:?}");
        let extractor = Extractor::with(&patches, instructions);
        contenders.extend(extractor.into_iter().flat_map(|e| through_patches(e, &name)));
        let name = format!("{instructions:?}, two levels");
        let extractor = Extractor::with(&two_levels, instructions);
        contenders.extend(extractor.into_iter().flat_map(|e| through_patches(e, &name)));
    }
    contenders.push(contender("patches, ids, newest, one view on all threads", |view, found| {
        newest.edges_on_threads(view, found);
    }));
    for threads in [1, rayon::current_num_threads()] {
        contenders.extend(in_batches(&newest, threads)?);
    }
    contenders.push(contender(
        "patches, ids, newest, made for the paper's costs",
        |view, found| {
            of_default.edges(view, found);
        },
    ));
    // As cameras have them.
    let rounded = |viewpoint: &Viewpoint| Viewpoint::at(viewpoint.xyz().as_vec3().as_dvec3());
    let rounded: Vec<Viewpoint> = viewpoints.iter().map(rounded).collect();
    let mut floor = Floor::new(&patches, &rounded);
    let name = "the floor: ids written, of accepted blocks that are read";
    contenders.push((name.into(), Box::new(move |viewpoints| floor.look(viewpoints))));
    let exact = viewpoints.clone();
    let (name, mut look) = contender("patches, ids, newest, viewpoints in f64", |view, found| {
        newest.edges(view, found);
    });
    contenders.push((name, Box::new(move |_| look(&exact))));
    report(&mut contenders, &rounded, rounds);
    Ok(())
}

fn contender<'a, T>(
    name: impl Into<String>,
    mut look: impl FnMut(Viewpoint, &mut T) + 'a,
) -> Contender<'a>
where
    T: Default + 'a,
{
    let mut found = T::default();
    let look = move |viewpoints: &[Viewpoint]| {
        for &viewpoint in viewpoints {
            look(viewpoint, &mut found);
            black_box(&found);
        }
    };
    (name.into(), Box::new(look))
}

/// The naive loop, and those with exact predicates throughout.
fn exact_ones<'a>(
    mesh: &'a Mesh,
    adjacency: &MeshAdjacency,
    patches: &'a PatchSet,
) -> Vec<Contender<'a>> {
    let mut by_face = BruteForce::new(mesh, adjacency, EdgeFilter::Convex);
    vec![
        contender("every edge in f32, normals from vertices, inexact", |viewpoint, found| {
            extract_naively(patches, viewpoint, found);
        }),
        contender("every edge, exact predicates", |viewpoint, found| {
            extract_all_wings(patches, viewpoint, found);
        }),
        contender("every face, then every edge, exact predicates", move |viewpoint, found| {
            by_face.extract(viewpoint, found);
        }),
        contender("patches, exact predicates", |viewpoint, found| {
            extract_patches(patches, viewpoint, found);
        }),
    ]
}

/// Those with planes in whole numbers.
fn brute_forces<'a>(
    mesh: &'a Mesh,
    adjacency: &MeshAdjacency,
    instructions: Instructions,
) -> Vec<Contender<'a>> {
    let mut contenders = Vec::new();
    let filter = EdgeFilter::Convex;
    if let Some(stored) = StoredPlanes::new(mesh, adjacency, filter).with_instructions(instructions)
    {
        contenders.push(contender(
            format!("stored planes, {instructions:?}"),
            move |view, found| {
                stored.extract(view, found);
            },
        ));
    }
    if let Some(mut signs) = FaceSigns::new(mesh, adjacency, filter).with_instructions(instructions)
    {
        contenders.push(contender(format!("face signs, {instructions:?}"), move |view, found| {
            signs.extract(view, found);
        }));
    }
    if let Some(strips) = FaceStrips::new(mesh, adjacency, filter).with_instructions(instructions) {
        contenders.push(contender(format!("face strips, {instructions:?}"), move |view, found| {
            strips.extract(view, found);
        }));
    }
    contenders
}

fn through_patches<'a>(extractor: Extractor<'a>, name: &str) -> [Contender<'a>; 2] {
    let by_pairs = extractor.clone();
    [
        contender(format!("patches, ids, {name}"), move |viewpoint, found| {
            extractor.edges(viewpoint, found);
        }),
        contender(format!("patches, vertex pairs, {name}"), move |viewpoint, found| {
            by_pairs.vertex_pairs(viewpoint, found);
        }),
    ]
}

/// All viewpoints at once.
fn in_batches<'a>(
    extractor: &'a Extractor<'a>,
    threads: usize,
) -> Result<[Contender<'a>; 2], String> {
    let pool = || {
        let builder = ThreadPoolBuilder::new().num_threads(threads);
        builder.build().map_err(|error| error.to_string())
    };
    let (for_edges, for_pairs) = (pool()?, pool()?);
    let (mut edges, mut pairs) = (Batch::default(), Batch::default());
    let look_for_edges = move |viewpoints: &[Viewpoint]| {
        for_edges.install(|| extractor.edges_of_batch(viewpoints, &mut edges));
    };
    let look_for_pairs = move |viewpoints: &[Viewpoint]| {
        for_pairs.install(|| extractor.vertex_pairs_of_batch(viewpoints, &mut pairs));
    };
    Ok([
        (format!("batch, ids, newest, {threads} threads"), Box::new(look_for_edges)),
        (format!("batch, vertex pairs, newest, {threads} threads"), Box::new(look_for_pairs)),
    ])
}

/// Times all in turn, again and again, each after some views that bring its own data into the caches.
fn report(contenders: &mut [Contender<'_>], viewpoints: &[Viewpoint], rounds: u32) {
    let mut times = vec![Vec::new(); contenders.len()];
    let some: Vec<Viewpoint> = viewpoints.iter().copied().step_by(5).collect();
    for _ in 0..rounds {
        for ((_, look), times) in contenders.iter_mut().zip(&mut times) {
            look(&some);
            let start = Instant::now();
            look(viewpoints);
            times.push(1e6 * start.elapsed().as_secs_f64() / viewpoints.len().max(1) as f64);
        }
    }
    for ((name, _), own) in contenders.iter().zip(&times) {
        let ratios = times[0].iter().zip(own).map(|(first, own)| first / own).collect();
        let [low, ratio, high] = quartiles(ratios);
        let micros = quartiles(own.clone())[1];
        println!("  {name:<52}{micros:>9.1} µs {ratio:>7.1} x [{low:.1}, {high:.1}]");
    }
}
