//! Frames in Vulkan: contours of all instances and their lines, by compute shaders and an indirect draw, and by task
//! and mesh shaders in one pass (Tsiapkolis and Bénard, CGF 2024, Table 6). Segments and pictures are compared
//! first.

use std::time::Instant;

use drypoint_ash::{
    Attached, Capacity, Contours, Counting, Error, Executed, Extractor, Gpu, LinePass, LineStyle,
    MeshContours, MeshOptions, MeshOutput, MeshPass, Method, Model, Offscreen, Pixels, Placement,
    Queries, Timer,
};
use drypoint_fusion::{CostModel, FusionParams};
use drypoint_mesh::{Mesh, MeshAdjacency};
use drypoint_shaders::Content;
use drypoint_tests::report::{GpuRun, INSTANCES, Quartiles, Run, VulkanCounts, VulkanFrame};
use glam::Mat4;

use crate::gpu::FILTER;
use crate::gpu::check::Seen;
use crate::gpu::frames::{MOST_FRAMES, SIZE, placements, seconds_per_round};
use crate::gpu::variants::{Grouped, groupings, patches};
use crate::{Options, Section};

/// Patches of at most 64 vertices and 126 edges, as mesh shaders like to emit.
const FOR_MESH_SHADERS: &str = "patches (MESH_SHADER)";

const ATTACHED: Attached = Attached { color: Offscreen::FORMAT, depth: None };

/// The device, if it is wanted and there is one that can tell the time and count.
///
/// # Errors
/// If there is none, and frames on it were asked for by name.
pub(crate) fn device(options: &Options) -> Result<Option<Gpu>, String> {
    if !options.wants(Section::Vulkan) {
        return Ok(None);
    }
    let measures = |gpu: &Gpu| {
        Timer::new(gpu.device())?;
        Queries::new(gpu.device(), Counting::MeshShaders).map(|_| ())
    };
    match Gpu::request().and_then(|gpu| measures(&gpu).map(|()| gpu)) {
        Ok(gpu) => Ok(Some(gpu)),
        Err(error) if options.only.is_empty() => {
            eprintln!("bench: nothing is measured in Vulkan: {error}");
            Ok(None)
        }
        Err(error) => Err(format!("nothing can be measured in Vulkan: {error}")),
    }
}

/// What is said of the device.
pub(crate) fn run(gpu: &Gpu, run: Run) -> GpuRun {
    GpuRun { device: gpu.device().name(), is_software: gpu.device().is_software(), run }
}

/// Edges in groups, and both ways to draw their contours.
struct Subject {
    name: &'static str,
    method: Method,
    /// Edges of its largest piece of a patch.
    largest: u32,
    computed: Contours,
    meshed: MeshContours,
    /// Milliseconds of both.
    taken: [Vec<f64>; 2],
}

/// Pipelines, and the picture that all draw to.
struct Frames<'a> {
    gpu: &'a Gpu,
    extractor: Extractor,
    line_pass: LinePass,
    mesh_pass: MeshPass,
    offscreen: Offscreen,
    placements: Vec<Placement>,
    timer: Timer,
}

/// None of a mesh without edges.
pub(crate) fn measure(
    gpu: &Gpu,
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    options: &Options,
) -> Result<Vec<VulkanFrame>, String> {
    if adjacency.edges(FILTER).next().is_none() {
        return Ok(Vec::new());
    }
    let say = |error: Error| error.to_string();
    let mut frames = Frames::new(gpu, placements(mesh)).map_err(say)?;
    let seen = Seen::new(mesh, adjacency, &frames.placements);
    let mut groups = groupings(mesh, adjacency, options.quick)?;
    let for_mesh = FusionParams { cost: CostModel::MESH_SHADER, ..FusionParams::DEFAULT };
    groups.insert(2, patches(FOR_MESH_SHADERS, mesh, adjacency, &for_mesh)?);
    let frame = groups[0].content.frames[0];
    let mut subjects = Vec::new();
    let mut counts = Vec::new();
    for Grouped { name, content, .. } in &groups {
        let fail = |why: String| format!("{name} in Vulkan: {why}");
        let mut subject = frames.subject(name, content, seen.capacity()).map_err(say)?;
        for segments in frames.find(&mut subject, content, seen.capacity()).map_err(say)? {
            seen.compare(&segments, &frame).map_err(fail)?;
        }
        counts.push(frames.count(&mut subject).map_err(fail)?);
        subjects.push(subject);
    }
    frames.time(&mut subjects, options).map_err(say)?;
    Ok(report(&subjects, &counts))
}

fn report(subjects: &[Subject], counts: &[[VulkanCounts; 2]]) -> Vec<VulkanFrame> {
    let frame = |subject: &Subject, counts: &[VulkanCounts; 2], is_mesh: bool| {
        let index = usize::from(is_mesh);
        let own = &subject.taken[index];
        VulkanFrame {
            name: subject.name.to_owned(),
            is_mesh,
            millis: Quartiles::of(own.iter().copied()),
            over_brute_force: Quartiles::of_ratios(&subjects[0].taken[index], own),
            of_compute: Quartiles::of_ratios(own, &subject.taken[0]),
            counts: counts[index],
        }
    };
    let both = |(subject, counts)| [false, true].map(|is_mesh| frame(subject, counts, is_mesh));
    subjects.iter().zip(counts).flat_map(both).collect()
}

impl<'a> Frames<'a> {
    fn new(gpu: &'a Gpu, placements: Vec<Placement>) -> Result<Self, Error> {
        let device = gpu.device();
        let output = MeshOutput::Lines(ATTACHED);
        let options = MeshOptions { output, records: false, ..MeshOptions::default() };
        let (line_pass, mesh_pass) =
            (LinePass::new(device, &ATTACHED)?, MeshPass::new(device, &options)?);
        // The scene is in clip space.
        let (offscreen, _) = gpu.run(|commands| {
            line_pass.prepare(commands, Mat4::IDENTITY, &LineStyle::default())?;
            mesh_pass.prepare(commands, Mat4::IDENTITY, &LineStyle::default())?;
            Offscreen::new(commands, [SIZE.width, SIZE.height])
        })?;
        let (extractor, timer) = (Extractor::new(device)?, Timer::new(device)?);
        Ok(Self { gpu, extractor, line_pass, mesh_pass, offscreen, placements, timer })
    }

    fn subject(
        &self,
        name: &'static str,
        content: &Content,
        segments: u32,
    ) -> Result<Subject, Error> {
        let (model, _) = self.gpu.run(|commands| Model::upload(commands, content))?;
        let method = if model.has_patches() { Method::Patches } else { Method::BruteForce };
        #[expect(clippy::cast_possible_truncation, reason = "252")]
        let capacity = Capacity { placements: INSTANCES as u32, segments };
        Ok(Subject {
            name,
            method,
            largest: content.patches.iter().map(|patch| patch.count).max().unwrap_or(0),
            computed: Contours::new(&self.extractor, &model, capacity)?,
            meshed: MeshContours::new(&self.mesh_pass, &model, capacity)?,
            taken: [Vec::new(), Vec::new()],
        })
    }

    /// Segments by both ways.
    fn find(
        &self,
        subject: &mut Subject,
        content: &Content,
        segments: u32,
    ) -> Result<[Vec<drypoint_ash::Segment>; 2], Error> {
        let Self { gpu, extractor, placements, .. } = self;
        let (found, executed) = gpu.run(|commands| {
            subject.computed.prepare(commands, placements, subject.method)?;
            extractor.record(commands, &subject.computed)?;
            subject.computed.download(commands)
        })?;
        let computed = found.segments(&executed)?;
        let pass = MeshPass::new(gpu.device(), &MeshOptions::default())?;
        let (found, executed) = gpu.run(|commands| {
            let model = Model::upload(commands, content)?;
            let capacity = Capacity { segments, ..subject.computed.capacity() };
            let mut contours = MeshContours::new(&pass, &model, capacity)?;
            contours.prepare(commands, placements, subject.method)?;
            pass.extract(commands, &contours)?;
            contours.download(commands)
        })?;
        Ok([computed, found.segments(&executed)?])
    }

    /// What one frame of either counts, once the device's own counts and both pictures agree.
    fn count(&mut self, subject: &mut Subject) -> Result<[VulkanCounts; 2], String> {
        let say = |error: Error| error.to_string();
        let (compute, picture) = self.count_compute(subject).map_err(say)?;
        let (mesh, same) = self.count_mesh(subject).map_err(say)?;
        let lanes = u64::from(self.mesh_pass.mesh_width());
        let launched = mesh.mesh_invocations / lanes;
        if mesh.mesh_invocations != lanes * mesh.mesh_workgroups {
            let needed = mesh.mesh_workgroups;
            return Err(format!(
                "{launched} mesh workgroups were launched, {needed} were asked for"
            ));
        }
        // Larger patches than fit a workgroup take several.
        let fits = subject.largest <= self.mesh_pass.edges_per_workgroup();
        if subject.method == Method::Patches && fits && launched > mesh.survivors {
            return Err(format!("{launched} mesh workgroups for {} survivors", mesh.survivors));
        }
        for counts in [compute, mesh] {
            if counts.primitives != counts.lines {
                let (lines, drawn) = (counts.lines, counts.primitives);
                return Err(format!("{drawn} primitives for {lines} contour edges"));
            }
        }
        let differ = picture.chunks(4).zip(same.chunks(4)).filter(|(a, b)| a != b).count();
        let inked = picture.chunks(4).filter(|pixel| pixel[0] < u8::MAX).count();
        if differ * 100 > inked {
            return Err(format!("both pipelines draw {inked} pixels, of which {differ} differ"));
        }
        Ok([compute, mesh])
    }

    fn count_compute(&self, subject: &mut Subject) -> Result<(VulkanCounts, Vec<u8>), Error> {
        let mut queries = Queries::new(self.gpu.device(), Counting::Compute)?;
        let ((found, pixels), executed) = self.gpu.run(|commands| {
            let contours = &mut subject.computed;
            contours.prepare(commands, &self.placements, subject.method)?;
            queries.begin(commands)?;
            self.extractor.record(commands, contours)?;
            self.line_pass.record(&mut self.offscreen.render(commands, [1.0; 4])?, contours)?;
            queries.end(commands)?;
            let found = contours.download_statistics(commands)?;
            Ok((found, self.offscreen.download(commands)?))
        })?;
        let counts = queries.read(&executed)?;
        let counts = VulkanCounts {
            lines: found.statistics(&executed)?.segments,
            compute_invocations: counts.compute_invocations,
            vertex_invocations: counts.vertex_invocations,
            primitives: counts.primitives,
            ..VulkanCounts::default()
        };
        pixels_of((&pixels, &executed), counts)
    }

    fn count_mesh(&self, subject: &mut Subject) -> Result<(VulkanCounts, Vec<u8>), Error> {
        let mut queries = Queries::new(self.gpu.device(), Counting::MeshShaders)?;
        let ((found, pixels), executed) = self.gpu.run(|commands| {
            let contours = &mut subject.meshed;
            contours.prepare(commands, &self.placements, subject.method)?;
            queries.begin(commands)?;
            self.mesh_pass.record(&mut self.offscreen.render(commands, [1.0; 4])?, contours)?;
            queries.end(commands)?;
            let found = contours.download(commands)?;
            Ok((found, self.offscreen.download(commands)?))
        })?;
        let (counts, drawn) = (queries.read(&executed)?, found.statistics(&executed)?);
        let counts = VulkanCounts {
            lines: drawn.found.segments,
            survivors: drawn.survivors,
            mesh_workgroups: drawn.mesh_workgroups,
            idle_mesh_workgroups: drawn.idle_mesh_workgroups,
            task_invocations: counts.task_invocations,
            mesh_invocations: counts.mesh_invocations,
            primitives: counts.primitives,
            ..VulkanCounts::default()
        };
        pixels_of((&pixels, &executed), counts)
    }

    /// Draws all in turn, again and again.
    fn time(&mut self, subjects: &mut [Subject], options: &Options) -> Result<(), Error> {
        // The first frame is that of a driver that gets ready.
        self.draw_all(subjects)?;
        let start = Instant::now();
        self.draw_all(subjects)?;
        let seconds = start.elapsed().as_secs_f64();
        subjects.iter_mut().for_each(|subject| subject.taken = [Vec::new(), Vec::new()]);
        let per_round = f64::from(MOST_FRAMES).min(seconds_per_round(options) / seconds).max(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "30 at most")]
        let frame_count = per_round as u32 * options.rounds();
        (0..frame_count).try_for_each(|_| self.draw_all(subjects))
    }

    fn draw_all(&mut self, subjects: &mut [Subject]) -> Result<(), Error> {
        for subject in subjects {
            for is_mesh in [false, true] {
                let millis = self.draw(subject, is_mesh)?;
                subject.taken[usize::from(is_mesh)].push(millis);
            }
        }
        Ok(())
    }

    /// Milliseconds of a frame.
    fn draw(&mut self, subject: &mut Subject, is_mesh: bool) -> Result<f64, Error> {
        let Self { gpu, extractor, line_pass, mesh_pass, offscreen, placements, timer } = self;
        let Subject { method, computed, meshed, .. } = subject;
        let ((), executed) = gpu.run(|commands| {
            if is_mesh {
                meshed.prepare(commands, placements, *method)?;
                timer.begin(commands)?;
                mesh_pass.record(&mut offscreen.render(commands, [1.0; 4])?, meshed)?;
            } else {
                computed.prepare(commands, placements, *method)?;
                timer.begin(commands)?;
                extractor.record(commands, computed)?;
                line_pass.record(&mut offscreen.render(commands, [1.0; 4])?, computed)?;
            }
            timer.end(commands)
        })?;
        Ok(1e3 * timer.seconds(&executed)?)
    }
}

fn pixels_of(
    (pixels, executed): (&Pixels, &Executed),
    counts: VulkanCounts,
) -> Result<(VulkanCounts, Vec<u8>), Error> {
    Ok((counts, pixels.read(executed)?))
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::shapes;

    use super::*;

    #[test]
    fn frames_of_any_mesh_are_counted_and_timed() {
        if std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1") {
            return;
        }
        let gpu = Gpu::request().expect("DRYPOINT_NO_GPU=1 passes over the GPU tests");
        let options = clap::Parser::parse_from(["bench", "--quick", "--rounds", "1"]);
        for mesh in [shapes::bumpy_sphere(500), shapes::zero_area_fan()] {
            let adjacency = MeshAdjacency::new(&mesh);
            let frames = measure(&gpu, &mesh, &adjacency, &options).unwrap();
            assert_eq!(frames.len(), 10);
            for frame in &frames {
                assert!(frame.millis.median > 0.0, "{}", frame.name);
                assert_eq!(frame.counts.lines, frames[0].counts.lines);
                assert_eq!(
                    frame.counts.task_invocations > 0,
                    frame.is_mesh && frame.name != "brute force"
                );
            }
        }
        let nothing = Mesh::new(Vec::new(), Vec::new()).unwrap();
        let none = measure(&gpu, &nothing, &MeshAdjacency::new(&nothing), &options);
        assert_eq!(none, Ok(Vec::new()));
    }
}
