//! What `cargo xtask bench` measures, as it is written to JSON and read back.

mod claims;
mod gpu;
mod gpu_tables;
mod markdown;
mod page;
mod paper;
mod plots;
mod tables;

pub use claims::{CONES, Claim, FAST, MESHLETS, OURS, SNCH, SNCH_SINGLE, TB24, TWO_LEVELS, claims};
pub use gpu::{
    BRUTE_FORCE, FLOOR, GpuCalibration, GpuFrame, GpuReport, GpuRun, GpuTested, GpuTime, INSTANCES,
    VulkanCounts, VulkanFrame,
};
pub use markdown::{blocks, marks, replace_blocks};
pub use page::page;
pub use tables::{Table, tables};

use serde::{Deserialize, Serialize};
use statrs::statistics::{Data, OrderStatistics, Statistics};

use crate::judges::Tested;

/// Where the repository keeps the summary of a report.
pub const SUMMARY: &str = "docs/measurements.json";

/// Documents of the repository that hold tables made from it.
pub const DOCUMENTS: [&str; 2] = ["docs/measurements.md", "README.md"];

/// A run of the benchmark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Where it ran.
    pub machine: Machine,
    /// What ran, and how.
    pub run: Run,
    /// What was measured on each mesh.
    pub meshes: Vec<MeshReport>,
    /// Which GPU, if there was one.
    #[serde(default)]
    pub gpu: Option<GpuRun>,
    /// Which GPU frames were drawn on in Vulkan, if there was one.
    #[serde(default)]
    pub vulkan: Option<GpuRun>,
    /// What reading files takes, if that was measured.
    #[serde(default)]
    pub reading: Option<Reading>,
}

/// What reading files takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Where.
    pub machine: Machine,
    /// How.
    pub run: Run,
    /// In the order in which they were read.
    pub files: Vec<FileRead>,
}

/// What reading a file takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FileRead {
    /// Its name, and what it is.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// Triangles in it.
    pub faces: usize,
    /// Readers that read the same from it, ours first.
    pub readers: Vec<ReaderTime>,
}

/// What a reader takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReaderTime {
    /// Which.
    pub name: String,
    /// Median over rounds.
    pub seconds: f64,
    /// How many times as long as ours, round by round.
    pub over_ours: Quartiles,
}

/// Where a benchmark ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// As the processor calls itself.
    pub processor: String,
    /// Threads that it runs at once.
    pub threads: usize,
    /// The newest instructions that kernels use on it.
    pub instructions: String,
    /// Memory in GB.
    pub memory: f64,
    /// Name and version of the system.
    pub system: String,
}

/// What ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Of Drypoint.
    pub version: String,
    /// Of its repository, if that is known.
    pub commit: String,
    /// That measures the same.
    pub command: String,
    /// Interleaved rounds of what is timed.
    pub rounds: u32,
    /// Whether only small meshes and cheap methods were measured.
    pub is_quick: bool,
}

/// What was measured on a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeshReport {
    /// Of the file, without its ending.
    pub name: String,
    /// Faces.
    pub faces: usize,
    /// Edges that the convex filter keeps.
    pub edges: usize,
    /// All edges.
    pub all_edges: usize,
    /// Contour edges of those that the filter keeps.
    pub contours: Views<Sample>,
    /// The published method, by the largest number of edges fused as one group.
    pub partitions: Vec<Partition>,
    /// Ways to group the edges that the filter keeps.
    pub decompositions: Vec<Decomposition>,
    /// Ways to group all edges.
    pub of_all_edges: Vec<Decomposition>,
    /// What the cost model is made of; none if there are no patches.
    pub calibration: Option<Calibration>,
    /// Times of a view, in turn. The first is what all are measured by.
    pub times: Vec<Time>,
    /// The stages of a drawing, in seconds.
    pub drawing: Vec<(String, f64)>,
    /// Extraction on the GPU; none if there was no GPU, or no edge.
    #[serde(default)]
    pub gpu: Option<GpuReport>,
    /// What the cost model is made of on the GPU.
    #[serde(default)]
    pub gpu_calibration: Vec<GpuCalibration>,
    /// Frames in Vulkan.
    #[serde(default)]
    pub vulkan: Vec<VulkanFrame>,
}

/// Something counted from three sets of viewpoints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Views<T> {
    /// The 252 viewpoints of TB24 §4.3.
    pub far: T,
    /// On, in and beside the surface.
    pub near: T,
    /// A spiral around the mesh, from pole to pole.
    pub spiral: T,
}

/// A count from each viewpoint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// 0 of no viewpoints.
    pub mean: f64,
    /// All 0 of no viewpoints.
    pub quartiles: Quartiles,
    /// In the order of the viewpoints; empty in a summary.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub counts: Vec<u32>,
}

/// What views took.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Bounds tested.
    pub bounds: Sample,
    /// Edges tested.
    pub edges: Sample,
}

/// Patches of the published method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Partition {
    /// c_max.
    pub edges: u32,
    /// Wall time of fusion, in seconds, on all threads.
    pub seconds: f64,
    /// How many.
    pub patches: usize,
    /// From the 252 viewpoints.
    pub tested: Counts,
}

/// Edges grouped in some way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decomposition {
    /// Which.
    pub name: String,
    /// Wall time of building it, in seconds, on all threads.
    pub seconds: f64,
    /// Patches and super-patches, nodes or meshlets.
    pub bounds: usize,
    /// Mean radius of what bounds the position, in units of half the mesh's longest side: t cos α. None
    /// for two anchors.
    pub radius: Option<f64>,
    /// Mean half-angle α of the normals, in radians.
    pub half_angle: f64,
    /// From each viewpoint.
    pub tested: Views<Counts>,
}

/// What TB24 §4.2 calibrates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// t_e, a test of an edge, in nanoseconds.
    pub edge: Quartiles,
    /// t_P / t_e, the test of a bound.
    pub patch_test: Quartiles,
    /// t_A / t_e, what a survivor costs beside its edges.
    pub accepted_patch: Quartiles,
}

/// What a view takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Which extractor.
    pub name: String,
    /// Median over rounds of the mean over views, in microseconds.
    pub micros: f64,
    /// How many times as fast as the first.
    pub speed_up: Quartiles,
    /// How many times as fast as the best of those that test every edge.
    pub over_brute_force: Quartiles,
    /// Whether every edge is tested, with all that is known to make that fast.
    pub is_brute_force: bool,
}

/// Lower quartile, median and upper quartile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quartiles {
    /// A quarter is below.
    pub low: f64,
    /// Half is below.
    pub median: f64,
    /// Three quarters are below.
    pub high: f64,
}

impl Quartiles {
    /// All 0 of no values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        if values.is_empty() {
            return Self::default();
        }
        let mut data = Data::new(values);
        Self { low: data.lower_quartile(), median: data.median(), high: data.upper_quartile() }
    }

    /// Of how many times as much the first of each pair is.
    pub fn of_ratios(others: &[f64], own: &[f64]) -> Self {
        Self::of(others.iter().zip(own).map(|(other, own)| other / own))
    }
}

impl Sample {
    /// Of whole numbers that fit a u32: counts beyond are cut off there.
    pub fn of(counts: impl IntoIterator<Item = usize>) -> Self {
        let counts: Vec<u32> =
            counts.into_iter().map(|count| u32::try_from(count).unwrap_or(u32::MAX)).collect();
        let numbers: Vec<f64> = counts.iter().copied().map(f64::from).collect();
        let mean = if numbers.is_empty() { 0.0 } else { Statistics::mean(&numbers) };
        Self { mean, quartiles: Quartiles::of(numbers), counts }
    }
}

impl Counts {
    /// Of what each view took.
    pub fn of(views: &[Tested]) -> Self {
        Self {
            bounds: Sample::of(views.iter().map(|view| view.bounds)),
            edges: Sample::of(views.iter().map(|view| view.edges)),
        }
    }

    /// Mean cost of a view, in tests of an edge, if the test of a bound costs as much as in TB24 §4.2.
    pub fn cost(&self) -> f64 {
        PATCH_TEST * self.bounds.mean + self.edges.mean
    }
}

/// t_P / t_e of TB24 §4.2.
pub const PATCH_TEST: f64 = 1.363;

impl MeshReport {
    /// The decomposition of that name.
    pub fn decomposition(&self, name: &str) -> Option<&Decomposition> {
        self.decompositions.iter().find(|decomposition| decomposition.name == name)
    }

    /// The fastest of those that test every edge.
    pub fn best_brute_force(&self) -> Option<&Time> {
        let brute_forces = self.times.iter().filter(|time| time.is_brute_force);
        brute_forces.min_by(|a, b| a.micros.total_cmp(&b.micros))
    }
}

impl Report {
    /// The mesh of that name.
    pub fn mesh(&self, name: &str) -> Option<&MeshReport> {
        self.meshes.iter().find(|mesh| mesh.name == name)
    }

    /// Whether nothing was counted and timed but on a GPU.
    pub fn is_on_gpu_alone(&self) -> bool {
        let is_empty = |mesh: &MeshReport| mesh.decompositions.is_empty() && mesh.times.is_empty();
        (self.gpu.is_some() || self.vulkan.is_some()) && self.meshes.iter().all(is_empty)
    }

    /// Whether nothing was measured but how files are read.
    pub fn is_of_readers_alone(&self) -> bool {
        self.reading.is_some() && self.meshes.is_empty()
    }

    /// What was measured on a GPU replaced by that of `other`, as far as `other` has any: what it measured with
    /// wgpu, and in Vulkan. Only meshes that both have keep any then.
    #[must_use]
    pub fn with_gpu_of(mut self, other: &Self) -> Self {
        if other.gpu.is_some() {
            self.gpu.clone_from(&other.gpu);
            for mesh in &mut self.meshes {
                let measured = other.mesh(&mesh.name);
                mesh.gpu = measured.and_then(|measured| measured.gpu.clone());
                mesh.gpu_calibration =
                    measured.map_or(Vec::new(), |measured| measured.gpu_calibration.clone());
            }
        }
        if other.vulkan.is_some() {
            self.vulkan.clone_from(&other.vulkan);
            for mesh in &mut self.meshes {
                let measured = other.mesh(&mesh.name);
                mesh.vulkan = measured.map_or(Vec::new(), |measured| measured.vulkan.clone());
            }
        }
        self
    }

    /// The same without what was counted from each viewpoint: tables need no more.
    pub fn summary(mut self) -> Self {
        for mesh in &mut self.meshes {
            let contours = [&mut mesh.contours].into_iter().flat_map(Views::all);
            let grouped = mesh.decompositions.iter_mut().chain(&mut mesh.of_all_edges);
            let counts = (grouped.flat_map(|decomposition| decomposition.tested.all()))
                .chain(mesh.partitions.iter_mut().map(|partition| &mut partition.tested));
            let samples = counts.flat_map(|counts| [&mut counts.bounds, &mut counts.edges]);
            samples.chain(contours).for_each(|sample| sample.counts = Vec::new());
        }
        self
    }
}

impl<T> Views<T> {
    fn all(&mut self) -> [&mut T; 3] {
        [&mut self.far, &mut self.near, &mut self.spiral]
    }
}
