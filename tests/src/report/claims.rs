//! What is claimed of patches, held against what was measured.

use super::paper::TB24_TESTED_SHARE;
use super::tables::count;
use super::{Decomposition, FLOOR, INSTANCES, Report, VulkanFrame};

/// A claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// What is claimed.
    pub what: String,
    /// The numbers.
    pub measured: String,
    /// Whether it is so.
    pub holds: bool,
    /// What else was measured, for where it is not so.
    pub why: String,
}

/// Names of decompositions that claims are about.
pub const OURS: &str = "patches (DEFAULT)";
/// Patches that are built in haste.
pub const FAST: &str = "patches (FAST)";
/// Patches of patches.
pub const TWO_LEVELS: &str = "patches (two levels)";
/// The published method, at its best.
pub const TB24: &str = "TB24, Reduced Sphere";
/// Spatialized normal cone hierarchy, with as many edges in a leaf as make its cost least.
pub const SNCH: &str = "SNCH";
/// The same down to single edges.
pub const SNCH_SINGLE: &str = "SNCH, an edge in a leaf";
/// Anchored-cone forest.
pub const CONES: &str = "anchored cones";
/// Meshlets.
pub const MESHLETS: &str = "meshlets";

/// On the bunny, if it was measured: per view, mean of the 252 viewpoints. And of GPUs.
pub fn claims(report: &Report) -> Vec<Claim> {
    [of_counts(report), of_gpu(report), of_vulkan(report)].concat()
}

fn of_counts(report: &Report) -> Vec<Claim> {
    let Some(bunny) = report.mesh("stanford-bunny") else { return Vec::new() };
    let Some(ours) = bunny.decomposition(OURS) else { return Vec::new() };
    let share = ours.tested.far.edges.mean / bunny.edges as f64;
    let mut claims = vec![Claim {
        what: "patches test fewer edges than the 16 % of TB24".to_owned(),
        measured: format!("{:.1} %", 100.0 * share),
        holds: share < TB24_TESTED_SHARE,
        why: "TB24 does not say how it scales meshes.".to_owned(),
    }];
    for name in [SNCH, SNCH_SINGLE] {
        claims.extend(bunny.decomposition(name).into_iter().flat_map(|snch| hierarchy(ours, snch)));
    }
    claims.extend([(OURS, CONES), (TWO_LEVELS, CONES), (OURS, MESHLETS)].into_iter().filter_map(
        |(ours, theirs)| {
            Some(fewer_edges(bunny.decomposition(ours)?, bunny.decomposition(theirs)?))
        },
    ));
    claims
}

/// How many times as fast as brute force patches are to be on GPUs.
const OVER_BRUTE_FORCE: [(&str, f64); 2] = [("stanford-bunny", 5.0), ("dragon_vrip", 2.8)];

/// How many times as long as reading its buffers brute force may take.
const OVER_READING: f64 = 1.5;

/// Microseconds that recording a frame of the bunny may take.
const RECORDING: f64 = 100.0;

/// A processor that plays the GPU says nothing.
fn of_gpu(report: &Report) -> Vec<Claim> {
    let Some(gpu) = report.gpu.as_ref().filter(|gpu| !gpu.is_software) else { return Vec::new() };
    let mut claims = Vec::new();
    let mut claim = |what, measured, holds| {
        let why = format!("Measured on {}.", gpu.device);
        claims.push(Claim { what, measured, holds, why });
    };
    for mesh in &report.meshes {
        let Some(measured) = &mesh.gpu else { continue };
        let name = &mesh.name;
        let least = OVER_BRUTE_FORCE.iter().find(|(mesh, _)| mesh == name);
        if let Some((ours, (_, least))) = measured.time(OURS).zip(least) {
            let times = ours.over_brute_force.median;
            let what =
                format!("on the GPU, patches of {name} are {least} times as fast as brute force");
            claim(what, format!("{times:.1}"), times >= *least);
        }
        if let Some(floor) = measured.time(FLOOR) {
            let times = floor.over_brute_force.median;
            let what = format!(
                "on the GPU, brute force of {name} takes {OVER_READING} times as long as reading its \
                 buffers at most"
            );
            claim(what, format!("{times:.2}"), times <= OVER_READING);
        }
        let frame = measured.frames.iter().find(|frame| frame.name == OURS);
        if let Some(frame) = frame.filter(|_| name == "stanford-bunny") {
            let micros = frame.recording.median;
            let what = format!("a frame of {INSTANCES} bunnies is recorded in {RECORDING} µs");
            claim(what, format!("{micros:.0} µs"), micros <= RECORDING);
        }
    }
    claims
}

/// How many times as long as the compute pipeline mesh shaders may take for a frame, and how many times as fast
/// culling is to make them.
const OF_COMPUTE: f64 = 1.2;
const OVER_NO_CULLING: f64 = 3.0;

/// Of the bunny; a processor that plays the GPU says nothing.
fn of_vulkan(report: &Report) -> Vec<Claim> {
    let gpu = report.vulkan.as_ref().filter(|gpu| !gpu.is_software);
    let mesh = report.mesh("stanford-bunny");
    let is_ours = |frame: &&VulkanFrame| frame.is_mesh && frame.name == OURS;
    let frame = mesh.and_then(|mesh| mesh.vulkan.iter().find(is_ours));
    let Some((gpu, frame)) = gpu.zip(frame) else { return Vec::new() };
    let why = format!("Measured on {}.", gpu.device);
    let (of_compute, faster) = (frame.of_compute.median, frame.over_brute_force.median);
    vec![
        Claim {
            what: format!(
                "a frame of {INSTANCES} bunnies takes mesh shaders {OF_COMPUTE} times as long as compute shaders \
                 at most"
            ),
            measured: format!("{of_compute:.2}"),
            holds: of_compute <= OF_COMPUTE,
            why: why.clone(),
        },
        Claim {
            what: format!(
                "culling makes mesh shaders {OVER_NO_CULLING} times as fast on {INSTANCES} bunnies"
            ),
            measured: format!("{faster:.1}"),
            holds: faster >= OVER_NO_CULLING,
            why,
        },
    ]
}

fn hierarchy(ours: &Decomposition, snch: &Decomposition) -> [Claim; 2] {
    let name = &snch.name;
    let (our, their) = (&ours.tested.far, &snch.tested.far);
    [
        Claim {
            what: format!("{name} tests at least twice the edges that patches do"),
            measured: format!("{} and {}", count(their.edges.mean), count(our.edges.mean)),
            holds: their.edges.mean >= 2.0 * our.edges.mean,
            why: in_bounds(ours, snch),
        },
        Claim {
            what: format!("{name} visits more nodes than patches are tested"),
            measured: format!("{} and {}", count(their.bounds.mean), count(our.bounds.mean)),
            holds: their.bounds.mean > our.bounds.mean,
            why: in_bounds(ours, snch),
        },
    ]
}

fn fewer_edges(ours: &Decomposition, theirs: &Decomposition) -> Claim {
    let [our_edges, their_edges] = [ours, theirs].map(|each| each.tested.far.edges.mean);
    Claim {
        what: format!("{} test fewer edges than {}", ours.name, theirs.name),
        measured: format!("{} and {}", count(our_edges), count(their_edges)),
        holds: our_edges < their_edges,
        why: in_bounds(ours, theirs),
    }
}

/// What fewer edges cost in bounds.
fn in_bounds(ours: &Decomposition, theirs: &Decomposition) -> String {
    let [ours_far, theirs_far] = [ours, theirs].map(|each| &each.tested.far);
    format!(
        "{}: {} bounds tested, of {} that there are, and a cost of {}; {}: {} of {}, and {}.",
        theirs.name,
        count(theirs_far.bounds.mean),
        count(theirs.bounds as f64),
        count(theirs_far.cost()),
        ours.name,
        count(ours_far.bounds.mean),
        count(ours.bounds as f64),
        count(ours_far.cost()),
    )
}
