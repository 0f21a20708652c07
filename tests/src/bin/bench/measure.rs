//! All that is measured on a mesh.

use drypoint_fusion::mesh_hash;
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency};
use drypoint_tests::report::MeshReport;

use crate::decompositions::Subject;
use crate::kept::Kept;
use crate::{
    Devices, Options, Section, calibrate, contenders, drawing, gpu as on_gpu, vulkan as on_vulkan,
};

pub(crate) fn mesh(
    name: &str,
    mesh: &Mesh,
    options: &Options,
    (kept, devices): (&Kept, &Devices),
) -> Result<MeshReport, String> {
    let fail = |why: String| format!("{name}: {why}");
    let adjacency = MeshAdjacency::new(mesh);
    let subject = |filter| Subject::new((name, mesh, &adjacency), filter, (options, kept));
    let (visible, all) = (subject(EdgeFilter::Convex), subject(EdgeFilter::All));
    let rounds = options.rounds();
    let key = format!("{:016x} {rounds}", mesh_hash(mesh));
    let timed = |section, what: &str| options.wants(section).then(|| format!("{name}, {what}"));
    let report = MeshReport {
        name: name.to_owned(),
        faces: mesh.triangles().len(),
        edges: adjacency.edges(EdgeFilter::Convex).count(),
        all_edges: adjacency.edges(EdgeFilter::All).count(),
        contours: visible.contours().map_err(fail)?,
        partitions: visible.partitions().map_err(fail)?,
        decompositions: visible.decompositions().map_err(fail)?,
        of_all_edges: all.decompositions().map_err(fail)?,
        calibration: match timed(Section::Calibration, "calibration") {
            Some(what) => kept
                .or_measure(&what, &key, || calibrate::measure(mesh, &adjacency, rounds))
                .map_err(fail)?,
            None => None,
        },
        times: match timed(Section::Times, "times") {
            Some(what) => kept
                .or_measure(&what, &key, || contenders::measure(mesh, &adjacency, rounds))
                .map_err(fail)?,
            None => Vec::new(),
        },
        drawing: match timed(Section::Drawing, "drawing") {
            Some(what) => {
                kept.or_measure(&what, &key, || drawing::measure(mesh, &adjacency)).map_err(fail)?
            }
            None => Vec::new(),
        },
        gpu: None,
        gpu_calibration: Vec::new(),
        vulkan: Vec::new(),
    };
    on_gpus(report, (mesh, &adjacency), options, (kept, devices))
}

/// The same with what is measured on GPUs.
fn on_gpus(
    mut report: MeshReport,
    (mesh, adjacency): (&Mesh, &MeshAdjacency),
    options: &Options,
    (kept, Devices { gpu, vulkan }): (&Kept, &Devices),
) -> Result<MeshReport, String> {
    let name = &report.name;
    let fail = |why: String| format!("{name}: {why}");
    let rounds = options.rounds();
    let key = format!("{:016x} {rounds}", mesh_hash(mesh));
    if let Some(gpu) = gpu.as_ref().filter(|_| options.wants(Section::Gpu)) {
        let key = format!("{key} {} {}", options.quick, gpu.name());
        let measure = || on_gpu::measure(gpu, mesh, adjacency, options);
        report.gpu = kept.or_measure(&format!("{name}, GPU"), &key, measure).map_err(fail)?;
    }
    if let Some(gpu) = gpu.as_ref().filter(|_| options.wants(Section::GpuCalibration)) {
        let (key, what) = (format!("{key} {}", gpu.name()), format!("{name}, GPU calibration"));
        let measure = || on_gpu::calibrate::measure(gpu, mesh, adjacency, rounds);
        report.gpu_calibration = kept.or_measure(&what, &key, measure).map_err(fail)?;
    }
    if let Some(gpu) = vulkan.as_ref().filter(|_| options.wants(Section::Vulkan)) {
        let key = format!("{key} {} {}", options.quick, gpu.device().name());
        let measure = || on_vulkan::measure(gpu, mesh, adjacency, options);
        report.vulkan = kept.or_measure(&format!("{name}, Vulkan"), &key, measure).map_err(fail)?;
    }
    Ok(report)
}
