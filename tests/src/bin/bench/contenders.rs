//! Extraction on the CPU: every brute force and every kernel, in turn.

use std::hint::black_box;
use std::time::Instant;

use drypoint_baselines::{AnchoredCones, Meshlets, Snch, SnchParams};
use drypoint_cpu::{
    Batch, BruteForce, Extractor, FaceSigns, FaceStrips, Instructions, StoredPlanes,
    extract_all_wings, extract_naively, extract_patches,
};
use drypoint_fusion::{CostModel, FusionParams, Levels, PatchSet};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint};
use drypoint_tests::compare::Expected;
use drypoint_tests::judges::Judge;
use drypoint_tests::report::{Quartiles, Time};
use drypoint_tests::viewpoints;
use rayon::ThreadPoolBuilder;

use crate::decompositions::fused;
use crate::floor::Floor;

type Look<'a> = Box<dyn FnMut(&[Viewpoint]) + 'a>;

/// An extractor that looks from all viewpoints.
struct Contender<'a> {
    name: String,
    is_brute_force: bool,
    look: Look<'a>,
}

impl Contender<'_> {
    fn brute_force(mut self) -> Self {
        self.is_brute_force = true;
        self
    }
}

/// The median time of a view for each, and how many times as fast as the first it is.
pub(crate) fn measure(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    rounds: u32,
) -> Result<Vec<Time>, String> {
    // In f32, as cameras have them.
    let rounded = |viewpoint: Viewpoint| Viewpoint::at(viewpoint.xyz().as_vec3().as_dvec3());
    let viewpoints: Vec<Viewpoint> = viewpoints::protocol(mesh).into_iter().map(rounded).collect();
    let filter = EdgeFilter::Convex;
    let expected =
        Expected::new(mesh, adjacency, filter, &viewpoints).map_err(|wrong| wrong.to_string())?;
    let sets = Sets::new(mesh, adjacency, &expected)?;
    let judges = Judges::new(mesh, adjacency, &expected)?;
    let [newest, by_paper] = [&sets.patches, &sets.by_paper].map(Extractor::new);
    let mut contenders = exact_ones(mesh, adjacency, &sets);
    contenders.extend(judges.contenders());
    for instructions in Instructions::ALL.into_iter().filter(|set| set.are_here()) {
        contenders.extend(brute_forces(mesh, adjacency, instructions));
        let name = format!("{instructions}");
        let extractor = Extractor::with(&sets.patches, instructions);
        contenders.extend(extractor.into_iter().flat_map(|e| through_patches(e, &name)));
        let name = format!("{instructions}, two levels");
        let extractor = Extractor::with(&sets.two_levels, instructions);
        contenders.extend(extractor.into_iter().flat_map(|e| through_patches(e, &name)));
    }
    let (set, all_threads) = (Instructions::newest(), rayon::current_num_threads());
    if all_threads > 1 {
        let name = format!("patches, ids, {set}, one view on {all_threads} threads");
        contenders.push(contender(name, |view, found| {
            newest.edges_on_threads(view, found);
        }));
    }
    for threads in [1, all_threads].into_iter().take(all_threads.min(2)) {
        contenders.extend(in_batches(&newest, threads)?);
    }
    let name = format!("patches, ids, {set}, made for the paper's costs");
    contenders.push(contender(name, |view, found| {
        by_paper.edges(view, found);
    }));
    let mut floor = Floor::new(&sets.patches, &viewpoints);
    contenders.push(Contender {
        name: "floor: ids written, of accepted blocks that are read".to_owned(),
        is_brute_force: false,
        look: Box::new(move |viewpoints| floor.look(viewpoints)),
    });
    Ok(in_turn(&mut contenders, &viewpoints, rounds))
}

/// Patches, compared with the definition by every kernel.
struct Sets {
    patches: PatchSet,
    /// Made for what tests cost in the paper.
    by_paper: PatchSet,
    two_levels: PatchSet,
}

impl Sets {
    fn new(mesh: &Mesh, adjacency: &MeshAdjacency, expected: &Expected) -> Result<Self, String> {
        let compared = |params| {
            let set = fused(mesh, adjacency, EdgeFilter::Convex, &params)?;
            expected.compare(&set).map_err(|wrong| wrong.to_string())?;
            Ok::<_, String>(set)
        };
        let params = FusionParams { cost: CostModel::CPU_SIMD, ..FusionParams::DEFAULT };
        Ok(Self {
            patches: compared(params)?,
            by_paper: compared(FusionParams::DEFAULT)?,
            two_levels: compared(FusionParams { levels: Levels::Two, ..params })?,
        })
    }
}

/// What others have published.
struct Judges<'a>([(&'static str, Box<dyn Judge + 'a>); 4]);

impl<'a> Judges<'a> {
    /// Compared with the definition.
    fn new(mesh: &'a Mesh, adjacency: &MeshAdjacency, expected: &Expected) -> Result<Self, String> {
        let filter = EdgeFilter::Convex;
        let single = SnchParams { edges_per_leaf: 1 };
        let judges: [(_, Box<dyn Judge + 'a>); 4] = [
            ("SNCH", Box::new(Snch::new(mesh, adjacency, filter, &Default::default()))),
            ("SNCH, an edge in a leaf", Box::new(Snch::new(mesh, adjacency, filter, &single))),
            (
                "anchored cones",
                Box::new(AnchoredCones::new(mesh, adjacency, filter, &Default::default())),
            ),
            ("meshlets", Box::new(Meshlets::new(mesh, adjacency, filter, &Default::default()))),
        ];
        for (name, judge) in &judges {
            expected.watch(name, judge.as_ref()).map_err(|wrong| wrong.to_string())?;
        }
        Ok(Self(judges))
    }

    fn contenders(&self) -> impl Iterator<Item = Contender<'_>> {
        self.0.iter().map(|(name, judge)| {
            contender(format!("{name}, exact predicates"), |view, found: &mut Vec<EdgeId>| {
                judge.extract(view, found);
            })
        })
    }
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
    Contender { name: name.into(), is_brute_force: false, look: Box::new(look) }
}

/// The naive loop, and those with exact predicates throughout.
fn exact_ones<'a>(mesh: &'a Mesh, adjacency: &MeshAdjacency, sets: &'a Sets) -> Vec<Contender<'a>> {
    let Sets { patches, by_paper, two_levels } = sets;
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
        contender("patches (DEFAULT), exact predicates", |viewpoint, found| {
            extract_patches(by_paper, viewpoint, found);
        }),
        contender("patches made for kernels, exact predicates", |viewpoint, found| {
            extract_patches(patches, viewpoint, found);
        }),
        contender("the same on two levels, exact predicates", |viewpoint, found| {
            extract_patches(two_levels, viewpoint, found);
        }),
    ]
}

/// Those with planes in whole numbers.
fn brute_forces<'a>(
    mesh: &'a Mesh,
    adjacency: &MeshAdjacency,
    instructions: Instructions,
) -> Vec<Contender<'a>> {
    let filter = EdgeFilter::Convex;
    let stored = StoredPlanes::new(mesh, adjacency, filter).with_instructions(instructions);
    let stored = stored.map(|stored| {
        contender(format!("stored planes, {instructions}"), move |view, found| {
            stored.extract(view, found);
        })
    });
    let signs = FaceSigns::new(mesh, adjacency, filter).with_instructions(instructions);
    let signs = signs.map(|mut signs| {
        contender(format!("face signs, {instructions}"), move |view, found| {
            signs.extract(view, found);
        })
    });
    let strips = FaceStrips::new(mesh, adjacency, filter).with_instructions(instructions);
    let strips = strips.map(|strips| {
        contender(format!("face strips, {instructions}"), move |view, found| {
            strips.extract(view, found);
        })
    });
    [stored, signs, strips].into_iter().flatten().map(Contender::brute_force).collect()
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
    let plural = if threads == 1 { "" } else { "s" };
    let batch = |what, look: Look<'a>| Contender {
        name: format!("batch, {what}, {}, {threads} thread{plural}", Instructions::newest()),
        is_brute_force: false,
        look,
    };
    Ok([batch("ids", Box::new(look_for_edges)), batch("vertex pairs", Box::new(look_for_pairs))])
}

/// Times all in turn, again and again, each after some views that bring its own data into the caches.
fn in_turn(contenders: &mut [Contender<'_>], viewpoints: &[Viewpoint], rounds: u32) -> Vec<Time> {
    let mut times = vec![Vec::new(); contenders.len()];
    let some: Vec<Viewpoint> = viewpoints.iter().copied().step_by(5).collect();
    // The first time, memory grows.
    contenders.iter_mut().for_each(|contender| (contender.look)(viewpoints));
    for _ in 0..rounds {
        for (contender, times) in contenders.iter_mut().zip(&mut times) {
            (contender.look)(&some);
            let start = Instant::now();
            (contender.look)(viewpoints);
            times.push(1e6 * start.elapsed().as_secs_f64() / viewpoints.len().max(1) as f64);
        }
    }
    let median = |own: &[f64]| Quartiles::of(own.iter().copied()).median;
    let brute_forces = contenders.iter().zip(&times).filter(|(each, _)| each.is_brute_force);
    let best = brute_forces
        .map(|(_, own)| own)
        .min_by(|a, b| median(a).total_cmp(&median(b)))
        .unwrap_or(&times[0]);
    let time = |(contender, own): (&Contender<'_>, &Vec<f64>)| Time {
        name: contender.name.clone(),
        micros: median(own),
        speed_up: Quartiles::of_ratios(&times[0], own),
        over_brute_force: Quartiles::of_ratios(best, own),
        is_brute_force: contender.is_brute_force,
    };
    contenders.iter().zip(&times).map(time).collect()
}
