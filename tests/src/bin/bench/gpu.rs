//! Extraction on a GPU: all viewpoints of the protocol as instances of one model, in one go (Tsiapkolis
//! and Bénard, CGF 2024, §4.3). Times are the GPU's own; answers are compared with the definition first.

pub(crate) mod check;
pub(crate) mod frames;
mod reading;
pub(crate) mod variants;

pub(crate) mod calibrate;

use std::time::{Duration, Instant};

use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency};
use drypoint_tests::report::{
    FLOOR, GpuReport, GpuRun, GpuTested, GpuTime, INSTANCES, Quartiles, Run,
};
use drypoint_tests::viewpoints;
use drypoint_wgpu::{Error, Extractor, Gpu, Placement, Segment, Timer};

use self::check::Seen;
use self::variants::{Grouped, Variant, groupings};
use crate::{Options, Section};

/// Which edges are looked at.
pub(crate) const FILTER: EdgeFilter = EdgeFilter::Convex;

/// What can be recorded into a compute pass for any number of instances.
trait Work {
    fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        placements: &[Placement],
    ) -> Result<(), Error>;

    fn record(&self, pass: &mut wgpu::ComputePass<'_>);
}

/// The device, if it is wanted and there is one that can tell the time.
///
/// # Errors
/// If there is none, and sections on it were asked for by name.
pub(crate) fn device(options: &Options) -> Result<Option<Gpu>, String> {
    let sections = [Section::Gpu, Section::GpuCalibration];
    if !sections.iter().any(|&section| options.wants(section)) {
        return Ok(None);
    }
    let found = Gpu::request().and_then(|gpu| Timer::new(&gpu.device, &gpu.queue).map(|_| gpu));
    match found {
        Ok(gpu) => Ok(Some(gpu)),
        Err(error) if options.only.is_empty() => {
            eprintln!("bench: nothing is measured on a GPU: {error}");
            Ok(None)
        }
        Err(error) => Err(format!("nothing can be measured on a GPU: {error}")),
    }
}

/// What is said of the device.
pub(crate) fn run(gpu: &Gpu, run: Run) -> GpuRun {
    GpuRun { device: gpu.name(), is_software: gpu.is_software(), run }
}

/// After which clocks are as high as they get.
const WARM_UP: Duration = Duration::from_millis(500);

/// Times of passes, by waiting for each.
struct Stopwatch<'a> {
    gpu: &'a Gpu,
    timer: Timer,
}

impl<'a> Stopwatch<'a> {
    fn new(gpu: &'a Gpu) -> Result<Self, Error> {
        Ok(Self { gpu, timer: Timer::new(&gpu.device, &gpu.queue)? })
    }

    /// Works for a while: a GPU that has idled takes several times as long at first.
    fn warm_up(&mut self, work: &mut dyn Work, placements: &[Placement]) -> Result<(), Error> {
        let start = Instant::now();
        while start.elapsed() < WARM_UP {
            self.time(work, placements)?;
        }
        Ok(())
    }

    /// Milliseconds of the GPU.
    fn time(&mut self, work: &mut dyn Work, placements: &[Placement]) -> Result<f64, Error> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        work.prepare(&mut encoder, placements)?;
        let timestamp_writes = Some(self.timer.compute_pass());
        let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
        work.record(&mut encoder.begin_compute_pass(&descriptor));
        self.timer.request(&mut encoder);
        submit(self.gpu, encoder)?;
        millis(&mut self.timer)
    }
}

/// Waits until the GPU has done it.
fn submit(gpu: &Gpu, encoder: wgpu::CommandEncoder) -> Result<(), Error> {
    gpu.queue.submit([encoder.finish()]);
    let polled = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    polled.map(|_| ()).map_err(|_| Error::DeviceLost)
}

/// What has come by now.
fn millis(timer: &mut Timer) -> Result<f64, Error> {
    timer.newest().map(|time| 1e3 * time.as_secs_f64()).ok_or(Error::DeviceLost)
}

/// None of a mesh without edges.
pub(crate) fn measure(
    gpu: &Gpu,
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    options: &Options,
) -> Result<Option<GpuReport>, String> {
    if adjacency.edges(FILTER).next().is_none() {
        return Ok(None);
    }
    let say = |error: Error| error.to_string();
    let extractor = Extractor::new(&gpu.device).map_err(say)?;
    let placements: Vec<Placement> =
        viewpoints::protocol(mesh).into_iter().map(Placement::at_origin).collect();
    let seen = Seen::new(mesh, adjacency, &placements);
    let groupings = groupings(mesh, adjacency, options.quick)?;
    let mut variants = Vec::new();
    for Grouped { name, content, .. } in &groupings {
        variants.push(Variant::new(&extractor, name, content, seen.capacity()).map_err(say)?);
    }
    let all_edges = &groupings[0].content;
    let mut tested = Vec::new();
    for (variant, grouped) in variants.iter_mut().zip(&groupings) {
        let compare = |found: &[Segment]| seen.compare(found, &all_edges.frames[0]);
        let on_gpu = check(gpu, variant, &placements, compare)?;
        let edges_on_cpu = grouped.judge.as_ref().map(|judge| seen.edges_tested(judge.as_ref()));
        tested.push(Some(GpuTested { edges_on_cpu, ..on_gpu }));
    }
    let mut floor = reading::PlanesRead::new(gpu, all_edges, extractor.width());
    tested.push(None);
    let mut names: Vec<&str> = variants.iter().map(|variant| variant.name).collect();
    names.push(FLOOR);
    let mut works: Vec<&mut dyn Work> =
        variants.iter_mut().map(|variant| variant as &mut dyn Work).collect();
    works.push(&mut floor);
    let times = in_turn(gpu, &mut works, &placements, options.rounds()).map_err(say)?;
    let with_names = names.into_iter().zip(tested).zip(times);
    let times = with_names.map(|((name, tested), times)| GpuTime {
        name: name.to_owned(),
        tested,
        ..times
    });
    Ok(Some(GpuReport {
        width: extractor.width(),
        times: times.collect(),
        frames: frames::measure(gpu, &mut variants, mesh, options)?,
    }))
}

/// Looks once from everywhere, and compares.
fn check(
    gpu: &Gpu,
    variant: &mut Variant<'_>,
    placements: &[Placement],
    compare: impl FnOnce(&[Segment]) -> Result<usize, String>,
) -> Result<GpuTested, String> {
    let name = variant.name;
    let fail = |why: String| format!("{name} on the GPU: {why}");
    let look = |variant: &mut Variant<'_>| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        variant.prepare(&mut encoder, placements)?;
        variant.record(&mut encoder.begin_compute_pass(&Default::default()));
        submit(gpu, encoder)?;
        let statistics = variant.contours.read_statistics(&gpu.queue)?;
        Ok((statistics, variant.contours.read_segments(&gpu.queue)?))
    };
    let (statistics, found) = look(variant).map_err(|error: Error| fail(error.to_string()))?;
    let mean = |count: u64| count as f64 / placements.len() as f64;
    Ok(GpuTested {
        segments: mean(statistics.segments),
        edges: mean(statistics.edges_tested),
        edges_on_cpu: None,
        bounds: mean(statistics.patches_tested + statistics.super_patches_tested),
        accepted: mean(statistics.patches_accepted + statistics.super_patches_accepted),
        doubtful: compare(&found).map_err(fail)?,
    })
}

/// Times all in turn, again and again: all instances, and those of each distance. Names are left empty.
fn in_turn(
    gpu: &Gpu,
    works: &mut [&mut dyn Work],
    placements: &[Placement],
    rounds: u32,
) -> Result<Vec<GpuTime>, Error> {
    let mut watch = Stopwatch::new(gpu)?;
    if let Some(work) = works.first_mut() {
        watch.warm_up(*work, placements)?;
    }
    let groups: Vec<&[Placement]> = std::iter::once(placements)
        .chain(placements.chunks(INSTANCES / viewpoints::DISTANCES.len()))
        .collect();
    // By work, by group, by round. The first time is that of a driver that gets ready.
    let mut times = vec![vec![Vec::new(); groups.len()]; works.len()];
    for round in 0..=rounds {
        for (group, placements) in groups.iter().enumerate() {
            for (work, times) in works.iter_mut().zip(&mut times) {
                let time = watch.time(*work, placements)?;
                if round > 0 {
                    times[group].push(time);
                }
            }
        }
    }
    let time = |own: &Vec<Vec<f64>>| GpuTime {
        name: String::new(),
        millis: Quartiles::of(own[0].iter().copied()),
        over_brute_force: Quartiles::of_ratios(&times[0][0], &own[0]),
        tested: None,
        by_distance: own[1..]
            .iter()
            .map(|times| Quartiles::of(times.iter().copied()).median)
            .collect(),
    };
    Ok(times.iter().map(time).collect())
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::shapes;

    use super::*;

    /// None where the machine says that it has no GPU, not even software.
    pub(super) fn gpu() -> Option<Gpu> {
        let is_without = std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1");
        (!is_without).then(|| Gpu::request().expect("DRYPOINT_NO_GPU=1 passes over the GPU tests"))
    }

    /// Segments of what the content called `name` gives from everywhere, and what was counted.
    fn look(
        gpu: &Gpu,
        mesh: &Mesh,
        alter: impl FnOnce(&mut Vec<Segment>),
    ) -> Result<usize, String> {
        let adjacency = MeshAdjacency::new(mesh);
        let placements: Vec<Placement> =
            viewpoints::protocol(mesh).into_iter().map(Placement::at_origin).collect();
        let seen = Seen::new(mesh, &adjacency, &placements);
        let extractor = Extractor::new(&gpu.device).unwrap();
        let groupings = groupings(mesh, &adjacency, true).unwrap();
        let Grouped { name, content, .. } = groupings.last().unwrap();
        let mut variant = Variant::new(&extractor, name, content, seen.capacity()).unwrap();
        let compare = |found: &[Segment]| {
            let mut found = found.to_vec();
            alter(&mut found);
            seen.compare(&found, &content.frames[0])
        };
        check(gpu, &mut variant, &placements, compare).map(|tested| tested.doubtful)
    }

    #[test]
    fn what_is_wrong_is_not_timed() {
        let Some(gpu) = gpu() else { return };
        let mesh = shapes::bumpy_sphere(500);
        let says = |alter: fn(&mut Vec<Segment>), what: &str| {
            let error = look(&gpu, &mesh, alter).unwrap_err();
            assert!(error.starts_with("meshlets on the GPU: ") && error.contains(what), "{error}");
        };
        assert!(look(&gpu, &mesh, |_| {}).is_ok());
        says(|found| found.truncate(found.len() / 2), "differ from the definition");
        says(|found| found.push(found[0]), "twice");
        says(|found| found[0].to_vertex += 1, "is between");
        says(|found| found[0].placement = 252, "no instance");
    }

    #[test]
    fn all_is_timed_of_any_mesh() {
        let Some(gpu) = gpu() else { return };
        let options = clap::Parser::parse_from(["bench", "--quick", "--rounds", "1"]);
        for mesh in [shapes::bumpy_sphere(500), shapes::cad_part(672), shapes::zero_area_fan()] {
            let adjacency = MeshAdjacency::new(&mesh);
            let report = measure(&gpu, &mesh, &adjacency, &options).unwrap().unwrap();
            let names: Vec<&str> = report.times.iter().map(|time| &time.name[..]).collect();
            assert_eq!(names[..2], ["brute force", "patches (DEFAULT)"]);
            assert_eq!(names.last(), Some(&FLOOR));
            let edges = adjacency.edges(FILTER).count() as f64;
            for time in &report.times {
                assert!(time.millis.median > 0.0, "{}", time.name);
                assert_eq!(time.by_distance.len(), viewpoints::DISTANCES.len());
                assert!(time.tested.is_none_or(|tested| tested.edges <= edges));
                // But for patches so near to the boundary that f32 in another frame sees it elsewhere.
                let on_cpu = time.tested.and_then(|tested| Some((tested, tested.edges_on_cpu?)));
                let is_same =
                    |(gpu, on_cpu): (GpuTested, f64)| (gpu.edges / on_cpu - 1.0).abs() < 0.01;
                assert!(on_cpu.is_none_or(is_same), "{on_cpu:?}");
            }
            assert_eq!(report.times[0].tested.unwrap().edges, edges);
            assert_eq!(report.frames.len(), 3);
            calibrate::measure(&gpu, &mesh, &adjacency, 1).unwrap();
        }
        let nothing = Mesh::new(Vec::new(), Vec::new()).unwrap();
        assert_eq!(measure(&gpu, &nothing, &MeshAdjacency::new(&nothing), &options), Ok(None));
    }
}
