//! What the cost model is made of, on a GPU (Tsiapkolis and Bénard, CGF 2024, §4.2): with workgroups of
//! every width.

use drypoint_fusion::{CostModel, FusionParams};
use drypoint_mesh::{Mesh, MeshAdjacency};
use drypoint_shaders::{Content, WIDTHS};
use drypoint_tests::report::{
    BRUTE_FORCE, Calibration, GpuCalibration, GpuTested, OURS, Quartiles,
};
use drypoint_tests::viewpoints;
use drypoint_wgpu::{Error, Extractor, ExtractorOptions, Gpu, Placement};

use super::check::Seen;
use super::variants::Variant;
use super::{FILTER, Stopwatch, check};
use crate::decompositions::fused;

/// One viewpoint of the protocol in so many.
const VIEWPOINTS_EVERY: usize = 5;

/// A test that costs next to nothing, so that no edge is better off without a patch.
const SINGLE_EDGES: CostModel = CostModel { patch_test: 1e-3, max_edges: 1, ..CostModel::GPU };

/// Milliseconds of one round.
struct Round {
    brute_force: f64,
    /// One patch for each edge.
    single: f64,
    patches: f64,
}

/// Workgroups of one width, with what they are measured by: brute force, patches of one edge, and patches.
struct Subject<'a> {
    width: u32,
    variants: Vec<Variant<'a>>,
    tested: Vec<GpuTested>,
    rounds: Vec<Round>,
}

/// None of a mesh without edges that patches can hold.
pub(crate) fn measure(
    gpu: &Gpu,
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    rounds: u32,
) -> Result<Vec<GpuCalibration>, String> {
    let single = FusionParams { cost: SINGLE_EDGES, ..FusionParams::FAST };
    let ours = FusionParams { cost: CostModel::GPU, ..FusionParams::FAST };
    let [single, ours] = [single, ours].map(|params| fused(mesh, adjacency, FILTER, &params));
    let (single, ours) = (single?, ours?);
    if single.patches().is_empty() || ours.patches().is_empty() {
        return Ok(Vec::new());
    }
    let contents = [
        (BRUTE_FORCE, Content::without_patches(mesh, adjacency, FILTER)),
        ("patches of one edge", Content::new(&[&single])),
        (OURS, Content::new(&[&ours])),
    ];
    let views = viewpoints::protocol(mesh).into_iter().step_by(VIEWPOINTS_EVERY);
    let placements: Vec<Placement> = views.map(Placement::at_origin).collect();
    let seen = Seen::new(mesh, adjacency, &placements);
    let extractors = extractors(gpu).map_err(|error| error.to_string())?;
    let mut subjects = Vec::new();
    for extractor in &extractors {
        let mut subject = Subject {
            width: extractor.width(),
            variants: Vec::new(),
            tested: Vec::new(),
            rounds: Vec::new(),
        };
        for (name, content) in &contents {
            let variant = Variant::new(extractor, name, content, seen.capacity());
            let mut variant = variant.map_err(|error| error.to_string())?;
            let compare = |found: &[_]| seen.compare(found, &content.frames[0]);
            subject.tested.push(check(gpu, &mut variant, &placements, compare)?);
            subject.variants.push(variant);
        }
        subjects.push(subject);
    }
    in_turn(gpu, &mut subjects, &placements, rounds).map_err(|error| error.to_string())?;
    Ok(subjects.iter().map(|subject| subject.calibration(placements.len())).collect())
}

/// Of all widths that the device has.
fn extractors(gpu: &Gpu) -> Result<Vec<Extractor>, Error> {
    let mut extractors = Vec::new();
    for width in WIDTHS {
        let extractor = Extractor::with_options(&gpu.device, &ExtractorOptions { width })?;
        // Narrower ones are what the device gives where it does not allow as many lanes.
        if extractor.width() == width {
            extractors.push(extractor);
        }
    }
    Ok(extractors)
}

fn in_turn(
    gpu: &Gpu,
    subjects: &mut [Subject<'_>],
    placements: &[Placement],
    rounds: u32,
) -> Result<(), Error> {
    let mut watch = Stopwatch::new(gpu)?;
    if let Some(variant) = subjects.first_mut().and_then(|subject| subject.variants.first_mut()) {
        watch.warm_up(variant, placements)?;
    }
    for _ in 0..rounds {
        for subject in &mut *subjects {
            let mut time = |variant: usize| watch.time(&mut subject.variants[variant], placements);
            let round = Round { brute_force: time(0)?, single: time(1)?, patches: time(2)? };
            subject.rounds.push(round);
        }
    }
    Ok(())
}

impl Subject<'_> {
    fn calibration(&self, instances: usize) -> GpuCalibration {
        let [brute_force, single, patches] =
            [0, 1, 2].map(|variant| tested_by_all(&self.tested[variant], instances as f64));
        // In milliseconds.
        let edge = |round: &Round| round.brute_force / brute_force.edges;
        let patch_test =
            |round: &Round| (round.single - single.edges * edge(round)) / single.bounds;
        let accepted_patch = |round: &Round| {
            let rest =
                round.patches - patches.bounds * patch_test(round) - patches.edges * edge(round);
            rest / patches.accepted.max(1.0)
        };
        let of = |value: &dyn Fn(&Round) -> f64| Quartiles::of(self.rounds.iter().map(value));
        GpuCalibration {
            width: self.width,
            costs: Calibration {
                edge: of(&|round| 1e6 * edge(round)),
                patch_test: of(&|round| patch_test(round) / edge(round)),
                accepted_patch: of(&|round| accepted_patch(round) / edge(round)),
            },
            brute_force: of(&|round| round.brute_force),
            patches: of(&|round| round.patches),
        }
    }
}

fn tested_by_all(mean: &GpuTested, instances: f64) -> GpuTested {
    GpuTested {
        segments: mean.segments * instances,
        edges: mean.edges * instances,
        bounds: mean.bounds * instances,
        accepted: mean.accepted * instances,
        ..*mean
    }
}
