//! A device with the validation layers on, and what they say.
#![allow(dead_code, reason = "each test program uses what it needs")]

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use drypoint_fusion::{FusionParams, Levels, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, is_contour};
use drypoint_shaders::{EdgePlanes, Frame};
use drypoint_wgpu::{Contours, Error, Extractor, Gpu, Method, Placement, Segment};

/// Warnings and errors of wgpu and of the validation layers, all tests of one program together.
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

struct Listener;

impl log::Log for Listener {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let said = record.args().to_string();
        // What a message is about comes as one of its own. Layers older than WGSL's number in SPIR-V object to
        // the note of where a shader comes from, and then check it all the same.
        if !said.trim_start().starts_with("objects:")
            && !said.contains("Invalid source language operand: 10")
        {
            messages().push(format!("{}: {said}", record.target()));
        }
    }

    fn flush(&self) {}
}

/// What was said so far.
pub(crate) fn messages() -> MutexGuard<'static, Vec<String>> {
    MESSAGES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Fails if anything was said.
#[track_caller]
pub(crate) fn expect_silence() {
    let said = messages();
    assert!(said.is_empty(), "the validation layers have something to say: {said:#?}");
}

/// Whether the machine says that it has no GPU, not even software: tests are passed over then. Without
/// that, having none is a failure.
pub(crate) fn is_without_gpu() -> bool {
    std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1")
}

/// A device with validation, and limits lowered by `adjust`.
pub(crate) fn gpu_with(adjust: &dyn Fn(&mut wgpu::Limits)) -> Gpu {
    static LISTENING: OnceLock<()> = OnceLock::new();
    LISTENING.get_or_init(|| {
        log::set_logger(&Listener).expect("no test has another");
        log::set_max_level(log::LevelFilter::Warn);
    });
    // Without DEBUG, wgpu installs the layers but does not listen to them.
    let flags = wgpu::InstanceFlags::VALIDATION | wgpu::InstanceFlags::DEBUG;
    match Gpu::request_with(flags, adjust) {
        Ok(gpu) => gpu,
        Err(error) => panic!(
            "{error}; install a Vulkan driver, as Mesa's software one (Debian: mesa-vulkan-drivers), or \
             set DRYPOINT_NO_GPU=1 to pass over the GPU tests"
        ),
    }
}

/// A device with validation.
pub(crate) fn gpu() -> Gpu {
    gpu_with(&|_| {})
}

/// An example, which cargo builds beside the tests.
pub(crate) fn example(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("this runs from a file");
    let folder = test.parent().and_then(|deps| deps.parent()).expect("tests are in target/*/deps");
    let example = folder.join("examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    assert!(example.exists(), "build it first: cargo build -p drypoint-wgpu --example {name}");
    example
}

/// Patches of all edges.
pub(crate) fn patches(mesh: &Mesh, levels: Levels) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    let params = FusionParams { levels, ..FusionParams::FAST };
    fuse(mesh, &adjacency, EdgeFilter::All, &params, &|_| ControlFlow::Continue(()))
        .expect("nothing stops it")
}

/// Records one extraction, submits it, and reads what it finds, sorted.
pub(crate) fn extract(
    gpu: &Gpu,
    extractor: &Extractor,
    contours: &mut Contours,
    placements: &[Placement],
    method: Method,
) -> Result<Vec<Segment>, Error> {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    contours.prepare(&mut encoder, placements, method)?;
    extractor
        .record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()), contours);
    gpu.queue.submit([encoder.finish()]);
    let mut segments = contours.read_segments(&gpu.queue)?;
    segments.sort_unstable();
    Ok(segments)
}

/// What brute force with exact predicates says about placements of a patch set's edges.
pub(crate) struct Expected {
    /// Contour edges that f32 must find too.
    sure: BTreeSet<Segment>,
    /// Edges with a face within the margin: found or not, as it comes.
    doubtful: BTreeSet<Segment>,
}

impl Expected {
    pub(crate) fn new(set: &PatchSet, placements: &[Placement]) -> Self {
        let (mut sure, mut doubtful) = (BTreeSet::new(), BTreeSet::new());
        let edges = || set.wings().iter().zip(set.edge_ids());
        let frame = Frame::new(
            edges()
                .flat_map(|(w, _)| [w.tail, w.head, w.left, w.right])
                .map(|vertex| set.positions()[vertex as usize]),
        );
        let planes: Vec<_> =
            edges().map(|(wing, _)| EdgePlanes::in_f64(set.positions(), wing, &frame)).collect();
        for (index, placement) in (0..).zip(placements) {
            let viewpoint = placement.viewpoint_of_part().expect("it has an inverse");
            let seen = frame.viewpoint(viewpoint);
            for ((wing, &edge), planes) in edges().zip(&planes) {
                let [from_vertex, to_vertex] = wing.ends();
                let segment = Segment { from_vertex, to_vertex, placement: index, edge };
                if EdgePlanes::is_doubtful(planes, seen) {
                    doubtful.insert(segment);
                } else if is_contour(set.positions(), wing, viewpoint) {
                    sure.insert(segment);
                }
            }
        }
        Self { sure, doubtful }
    }

    /// Number of contour edges that are sure, and of doubtful edges.
    pub(crate) fn counts(&self) -> [usize; 2] {
        [self.sure.len(), self.doubtful.len()]
    }

    /// Compares sorted segments.
    #[track_caller]
    pub(crate) fn compare(&self, found: &[Segment], what: &str) {
        assert!(found.is_sorted_by(|a, b| a < b), "{what}: a segment is there twice");
        let missing = self.sure.iter().find(|segment| found.binary_search(segment).is_err());
        assert_eq!(missing, None, "{what}: it is missing");
        let extra = found.iter().find(|s| !self.sure.contains(s) && !self.doubtful.contains(s));
        assert_eq!(extra, None, "{what}: it is no contour edge");
    }
}
