//! Tables of what was measured on a GPU.

use super::gpu::{GpuCalibration, GpuFrame, GpuTime, VulkanFrame};
use super::tables::{Table, count, ratio};
use super::{BRUTE_FORCE, GpuRun, MeshReport, Quartiles, Report};
use crate::viewpoints::DISTANCES;

/// What is said wherever a processor plays the GPU.
pub(super) const SOFTWARE: &str = "times of a processor, they say nothing about GPUs";

const NOTE: &str = "The 252 viewpoints of TB24 §4.3 as 252 instances in one go; GPU time stamps, medians and \
    quartiles over rounds, one after the other in each. Edges and bounds are means over instances; bounds are \
    those of patches and super-patches; \"on the CPU\" are edges that the same bounds let through there. \
    \"Doubtful\" are edges found otherwise than by the exact definition, over all instances, each within the \
    margin of f32. The floor reads the planes that brute force reads, and tests nothing. After TB24, Table 5.";

const FRAMES_NOTE: &str = "252 instances, since other numbers that TB24 draws are not known to us: contours in a \
    compute pass, then their lines, one pixel wide and drawn indirectly, 1920 × 1080 pixels off-screen. \
    Every instance is in a cell of the picture, as its viewpoint sees it. \"Recording\" is what the processor \
    takes to make the command buffer of the extraction. After TB24, Table 6, its first pipeline.";

const VULKAN_NOTE: &str = "The same frames in Vulkan, on one device with one driver: contours by compute shaders and \
    an indirect draw of lines, or by task and mesh shaders in one pass. Both draw the same picture. Invocations and \
    primitives are what the device itself counts; mesh workgroups, those that survivors need and those of them \
    that found no contour edge, are what shaders count. \"Survivors\" are patches in pieces of 256 edges at \
    most. After TB24, Table 6.";

/// Of one mesh; without rows where nothing was measured.
pub(super) fn tables(report: &Report, mesh: &MeshReport) -> Vec<Table> {
    let is_software = |run: &Option<GpuRun>| run.as_ref().is_some_and(|gpu| gpu.is_software);
    let vulkan = made(
        (mesh, is_software(&report.vulkan)),
        ["vulkan", "frames in Vulkan"],
        VULKAN_NOTE,
        [VULKAN, VULKAN_IN_SOFTWARE],
        mesh.vulkan.iter().map(vulkan_frame).collect(),
    );
    let mut tables = of_wgpu(mesh, is_software(&report.gpu)).to_vec();
    tables.push(vulkan);
    tables
}

/// A table, with what has to be said where a processor plays the GPU.
fn made(
    (mesh, is_software): (&MeshReport, bool),
    [name, title]: [&str; 2],
    note: &'static str,
    head: [&[&'static str]; 2],
    rows: Vec<Vec<String>>,
) -> Table {
    Table {
        mesh: Some(mesh.name.clone()),
        name: format!("{}-{name}", mesh.name),
        title: if is_software {
            format!("{}: {title} (software: {SOFTWARE})", mesh.name)
        } else {
            format!("{}: {title}", mesh.name)
        },
        note,
        head: head[usize::from(is_software)].to_vec(),
        rows,
    }
}

fn of_wgpu(mesh: &MeshReport, is_software: bool) -> [Table; 4] {
    let table = |names, note, head, rows| made((mesh, is_software), names, note, head, rows);
    let (times, frames) = match &mesh.gpu {
        Some(gpu) => (&gpu.times[..], &gpu.frames[..]),
        None => (&[][..], &[][..]),
    };
    [
        table(
            ["gpu", "extraction on the GPU"],
            NOTE,
            [TIMES, TIMES_IN_SOFTWARE],
            times.iter().map(time).collect(),
        ),
        table(
            ["gpu-distances", "extraction on the GPU, by distance"],
            "The 42 instances of each distance in one go: medians. After TB24, Figure 7.",
            [DISTANCE_HEAD, DISTANCE_HEAD_IN_SOFTWARE],
            times.iter().map(by_distance).collect(),
        ),
        table(
            ["gpu-frames", "frames on the GPU"],
            FRAMES_NOTE,
            [FRAMES, FRAMES_IN_SOFTWARE],
            frames.iter().map(frame).collect(),
        ),
        table(
            ["gpu-calibration", "what the cost model is made of, on the GPU"],
            "51 of the viewpoints in one go. t_e is from brute force, t_P from patches of one edge each (TB24 \
             §4.2), t_A what is left over of a view through patches (FAST), for each survivor.",
            [CALIBRATION, CALIBRATION_IN_SOFTWARE],
            mesh.gpu_calibration.iter().map(calibration).collect(),
        ),
    ]
}

const TIMES: &[&str] = &[
    "252 instances",
    "ms",
    "over brute force",
    "edges tested",
    "on the CPU",
    "bounds tested",
    "accepted",
    "contour edges",
    "doubtful",
];
const TIMES_IN_SOFTWARE: &[&str] = &[
    "252 instances",
    "ms (software)",
    "over brute force (software)",
    "edges tested",
    "on the CPU",
    "bounds tested",
    "accepted",
    "contour edges",
    "doubtful",
];
const DISTANCE_HEAD: &[&str] = &["42 instances, ms", "5", "10", "25", "50", "75", "100"];
const DISTANCE_HEAD_IN_SOFTWARE: &[&str] =
    &["42 instances, ms (software)", "5", "10", "25", "50", "75", "100"];
const _: () = assert!(DISTANCE_HEAD.len() == DISTANCES.len() + 1);
const FRAMES: &[&str] = &[
    "frame of 252 instances",
    "culling",
    "lines",
    "extraction, ms",
    "drawing, ms",
    "both, ms",
    "over no culling",
    "recording, µs",
];
const FRAMES_IN_SOFTWARE: &[&str] = &[
    "frame of 252 instances",
    "culling",
    "lines",
    "extraction, ms (software)",
    "drawing, ms (software)",
    "both, ms (software)",
    "over no culling (software)",
    "recording, µs",
];
const VULKAN: &[&str] = &[
    "frame of 252 instances",
    "pipeline",
    "lines",
    "ms",
    "over no culling",
    "times the compute pipeline's",
    "survivors",
    "mesh workgroups",
    "idle",
    "compute invocations",
    "vertex",
    "task",
    "mesh",
    "primitives",
];
const VULKAN_IN_SOFTWARE: &[&str] = &[
    "frame of 252 instances",
    "pipeline",
    "lines",
    "ms (software)",
    "over no culling (software)",
    "times the compute pipeline's (software)",
    "survivors",
    "mesh workgroups",
    "idle",
    "compute invocations",
    "vertex",
    "task",
    "mesh",
    "primitives",
];
const CALIBRATION: &[&str] =
    &["lanes", "t_e", "t_P / t_e", "t_A / t_e", "brute force, ms", "patches, ms"];
const CALIBRATION_IN_SOFTWARE: &[&str] = &[
    "lanes",
    "t_e (software)",
    "t_P / t_e (software)",
    "t_A / t_e (software)",
    "brute force, ms (software)",
    "patches, ms (software)",
];

fn time(time: &GpuTime) -> Vec<String> {
    let mut row = vec![time.name.clone(), three(&time.millis), ratio(time.over_brute_force)];
    row.extend(match &time.tested {
        Some(tested) => {
            let on_cpu = tested.edges_on_cpu.map_or(String::new(), count);
            let edges = vec![count(tested.edges), on_cpu];
            let means = [tested.bounds, tested.accepted, tested.segments].map(count).to_vec();
            [edges, means, vec![count(tested.doubtful as f64)]].concat()
        }
        None => vec![String::new(); 6],
    });
    row
}

fn by_distance(time: &GpuTime) -> Vec<String> {
    let times = time.by_distance.iter().map(|&millis| digits(millis));
    std::iter::once(time.name.clone()).chain(times).collect()
}

fn frame(frame: &GpuFrame) -> Vec<String> {
    let culling = if frame.name == BRUTE_FORCE { "off" } else { "on" };
    vec![
        frame.name.clone(),
        culling.to_owned(),
        count(frame.lines as f64),
        three(&frame.extraction),
        three(&frame.drawing),
        three(&frame.both),
        ratio(frame.over_brute_force),
        three(&frame.recording),
    ]
}

fn vulkan_frame(frame: &VulkanFrame) -> Vec<String> {
    let counts = &frame.counts;
    let pipeline = if frame.is_mesh { "task and mesh" } else { "compute" };
    // What a pipeline does not have stays empty.
    let number = |number: u64, is_there: bool| {
        if is_there { count(number as f64) } else { String::new() }
    };
    let times = [
        three(&frame.millis),
        ratio(frame.over_brute_force),
        if frame.is_mesh { ratio(frame.of_compute) } else { String::new() },
    ];
    let is_mesh = frame.is_mesh;
    let counts = [
        number(counts.survivors, is_mesh && frame.name != BRUTE_FORCE),
        number(counts.mesh_workgroups, is_mesh),
        number(counts.idle_mesh_workgroups, is_mesh),
        number(counts.compute_invocations, !is_mesh),
        number(counts.vertex_invocations, !is_mesh),
        number(counts.task_invocations, is_mesh),
        number(counts.mesh_invocations, is_mesh),
        number(counts.primitives, true),
    ];
    let lines = count(frame.counts.lines as f64);
    let names = [frame.name.clone(), pipeline.to_owned(), lines];
    names.into_iter().chain(times).chain(counts).collect()
}

fn calibration(calibration: &GpuCalibration) -> Vec<String> {
    let costs = &calibration.costs;
    vec![
        calibration.width.to_string(),
        format!("{} ns", three(&costs.edge)),
        three(&costs.patch_test),
        three(&costs.accepted_patch),
        three(&calibration.brute_force),
        three(&calibration.patches),
    ]
}

fn three(Quartiles { low, median, high }: &Quartiles) -> String {
    format!("{} [{}, {}]", digits(*median), digits(*low), digits(*high))
}

/// Three digits that count, of what may be a thousand times as much on another GPU.
fn digits(number: f64) -> String {
    match number {
        ..0.0 => format!("−{}", digits(-number)),
        100.0.. => count(number),
        10.0.. => format!("{number:.1}"),
        1.0.. => format!("{number:.2}"),
        0.1.. => format!("{number:.3}"),
        _ => format!("{number:.4}"),
    }
}
