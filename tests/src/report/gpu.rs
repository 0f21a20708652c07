//! What is measured on a GPU.

use serde::{Deserialize, Serialize};

use super::{Calibration, Quartiles, Run};

/// Instances of the protocol: a viewpoint each (TB24 §4.3).
pub const INSTANCES: usize = 252;

/// Every edge tested. Names of what is timed on a GPU, but for those that decompositions have, too.
pub const BRUTE_FORCE: &str = "brute force";
/// What brute force cannot be faster than.
pub const FLOOR: &str = "floor: planes read";

/// Which GPU, and the run that measured on it: another one than that of the rest, where a summary was
/// put together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GpuRun {
    /// Name of the device and of its driver.
    pub device: String,
    /// Whether a processor plays the GPU.
    pub is_software: bool,
    /// What ran.
    pub run: Run,
}

/// Contours of all instances of a mesh in one go. Times are differences of the GPU's time stamps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GpuReport {
    /// Lanes in a workgroup.
    pub width: u32,
    /// Extraction. The first is brute force.
    pub times: Vec<GpuTime>,
    /// Frames: extraction, and its lines drawn.
    pub frames: Vec<GpuFrame>,
}

/// Extraction from all viewpoints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GpuTime {
    /// How.
    pub name: String,
    /// Milliseconds for all instances.
    pub millis: Quartiles,
    /// How many times as fast as brute force.
    pub over_brute_force: Quartiles,
    /// What was counted; nothing of the floor.
    pub tested: Option<GpuTested>,
    /// Median milliseconds for the 42 instances of each distance, in the order of the protocol.
    pub by_distance: Vec<f64>,
}

/// What extraction counts. Means over instances, but for the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GpuTested {
    /// Contour edges.
    pub segments: f64,
    /// Edges tested.
    pub edges: f64,
    /// Edges that the same bounds let through on the CPU; none of brute force.
    pub edges_on_cpu: Option<f64>,
    /// Patches tested, and super-patches.
    pub bounds: f64,
    /// Those of them that were not culled.
    pub accepted: f64,
    /// Edges found otherwise than by the exact definition, all instances together: all of them so close
    /// to edge-on that f32 cannot tell.
    pub doubtful: usize,
}

/// A frame that extracts contours and draws them as lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GpuFrame {
    /// How contours are extracted.
    pub name: String,
    /// Lines drawn.
    pub lines: u64,
    /// Milliseconds of the compute pass.
    pub extraction: Quartiles,
    /// Milliseconds of the render pass.
    pub drawing: Quartiles,
    /// Milliseconds of both.
    pub both: Quartiles,
    /// How many times as fast as without culling.
    pub over_brute_force: Quartiles,
    /// Microseconds of the processor until the frame's extraction is recorded.
    pub recording: Quartiles,
}

/// A frame in Vulkan that finds contours and draws them as lines, in one pass or in two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VulkanFrame {
    /// How edges are grouped; [`BRUTE_FORCE`] without culling.
    pub name: String,
    /// Whether by task and mesh shaders in one pass, or by compute shaders and an indirect draw.
    pub is_mesh: bool,
    /// Milliseconds of the GPU.
    pub millis: Quartiles,
    /// How many times as fast as the same pipeline without culling.
    pub over_brute_force: Quartiles,
    /// As a multiple of what the compute pipeline takes with the same groups.
    pub of_compute: Quartiles,
    /// What was counted.
    pub counts: VulkanCounts,
}

/// What is counted in one frame, all instances together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct VulkanCounts {
    /// Contour edges, by shaders' own counts.
    pub lines: u64,
    /// Patches that were not culled, counted as
    /// [`Content::patches`](drypoint_shaders::Content::patches) counts them; of mesh shaders.
    pub survivors: u64,
    /// Mesh workgroups that survivors need, by shaders' own counts.
    pub mesh_workgroups: u64,
    /// Those of them that found no contour edge.
    pub idle_mesh_workgroups: u64,
    /// By the device's count, as all that follows.
    pub compute_invocations: u64,
    /// Of vertex shaders.
    pub vertex_invocations: u64,
    /// Of task shaders.
    pub task_invocations: u64,
    /// Of mesh shaders.
    pub mesh_invocations: u64,
    /// Lines.
    pub primitives: u64,
}

/// What the cost model is made of (TB24 §4.2), with workgroups of one width.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GpuCalibration {
    /// Lanes in a workgroup.
    pub width: u32,
    /// From brute force, and from patches of one edge.
    pub costs: Calibration,
    /// Milliseconds of brute force.
    pub brute_force: Quartiles,
    /// Milliseconds through patches.
    pub patches: Quartiles,
}

impl GpuReport {
    /// The time of that name.
    pub fn time(&self, name: &str) -> Option<&GpuTime> {
        self.times.iter().find(|time| time.name == name)
    }
}
