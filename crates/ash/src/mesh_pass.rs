//! One pass: task shaders cull patches, mesh shaders test edges and emit contour edges.

use ash::vk;
use drypoint_shaders::{Culling, DrawLimits, Emitted, LineStyle, MeshShape, Method, mesh_source};
use glam::Mat4;

use crate::binding::{Layout, Set};
use crate::commands::Commands;
use crate::device::{MOST_TESTS, MeshProperties};
use crate::look::{Look, compare};
use crate::mesh_contours::MeshContours;
use crate::pipeline::{Blending, Drawing, Formats, Pipeline};
use crate::rendering::{Rendering, Targets};
use crate::shader::{CUSTOM_ENTRY, Shader};
use crate::{Device, Error, layouts};

/// What a [`MeshPass`] draws, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshOptions<'a> {
    /// What becomes of contour edges.
    pub output: MeshOutput<'a>,
    /// Lanes of a task workgroup, each for a patch: at most 128 and what the device allows. What it
    /// prefers, if `None`.
    pub task_width: Option<u32>,
    /// Lanes of a mesh workgroup: at most 128 and what the device allows. What it prefers, and 64 at most, if
    /// `None`.
    pub mesh_width: Option<u32>,
    /// Edges of a mesh workgroup, a multiple of its lanes, which take an edge each in every round: at most 128, and
    /// half of that for strokes. About 64, if `None`: fewer are workgroups that find nothing, more are room for vertices
    /// that few of them need.
    pub edges_per_workgroup: Option<u32>,
    /// Whether [`Segment`](crate::Segment)s are written to a buffer too.
    pub records: bool,
}

/// What becomes of contour edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshOutput<'a> {
    /// Nothing is drawn: for counting and recording.
    Nothing,
    /// Lines one pixel wide, in the color of the line style.
    Lines(Attached),
    /// The same, drawn by a fragment shader of one's own: WGSL after the line `enable wgpu_mesh_shader;`, with
    /// an entry point `fragment` that binds nothing and gives `@location(0)`: numbers of the kind that the color
    /// attachment holds. It may read `@per_primitive @location(0) edge: u32` and
    /// `@per_primitive @location(1) edge_class: u32`, both `@interpolate(flat)`: the id of the edge and its
    /// [`EdgeClass`](drypoint_mesh::EdgeClass) as a number; and built-in values.
    Custom(Attached, &'a str),
}

/// What is drawn to: a color attachment, and a depth attachment that hides lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attached {
    /// Format of the color attachment.
    pub color: vk::Format,
    /// Format of the depth attachment, and which way depths run.
    pub depth: Option<(vk::Format, drypoint_shaders::DepthOrder)>,
}

impl Attached {
    /// Fails if the device cannot draw to it, blended or not.
    pub(crate) fn check(&self, device: &Device, is_blended: bool) -> Result<(), Error> {
        let color = if is_blended {
            vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND
        } else {
            vk::FormatFeatureFlags::COLOR_ATTACHMENT
        };
        device.check_format((self.color, color), "a color attachment")?;
        self.depth.map_or(Ok(()), |(depth, _)| {
            let tested = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
            device.check_format((depth, tested), "a depth attachment")
        })
    }
}

impl Default for MeshOptions<'_> {
    fn default() -> Self {
        Self {
            output: MeshOutput::Nothing,
            task_width: None,
            mesh_width: None,
            edges_per_workgroup: None,
            records: true,
        }
    }
}

/// Pipelines of task, mesh and fragment shaders, one for each way to find contour edges.
#[derive(Debug)]
pub struct MeshPass {
    device: Device,
    shape: MeshShape,
    /// By [`Culling`].
    pipelines: [Pipeline; 3],
    look: Look,
}

/// Most lanes for which the payload has room everywhere.
const MOST_TASK_LANES: u32 = 128;

/// Most edges for which there is room everywhere for what is emitted, as lines.
const MOST_EDGES: u32 = 128;

/// Edges of a mesh workgroup, and lanes at most, where nobody chooses.
const USUAL_EDGES: u32 = 64;

/// What is compiled to a [`MeshPass`].
pub(crate) struct MeshParts<'a> {
    pub(crate) emitted: Emitted,
    pub(crate) shape: MeshShape,
    /// Of the third set.
    pub(crate) style: &'a Layout,
    /// Another fragment shader than the source's own, and its entry point; or none.
    pub(crate) fragment: Fragment<'a>,
    pub(crate) formats: Formats,
    pub(crate) blending: Blending,
    pub(crate) depth: Option<vk::CompareOp>,
}

/// What shades what mesh shaders emit.
#[derive(Clone, Copy)]
pub(crate) enum Fragment<'a> {
    None,
    Entry(&'a str),
    Custom(&'a Shader<'a>),
}

impl MeshPass {
    /// Compiles all shaders: some tens of milliseconds.
    ///
    /// # Errors
    /// If an option is beyond what the device allows, or a shader is refused.
    pub fn new(device: &Device, options: &MeshOptions<'_>) -> Result<Self, Error> {
        let shape = shape(device, Emitted::Lines, options)?;
        let style = layouts::stroke(device)?;
        let custom = match options.output {
            MeshOutput::Custom(attached, source) => {
                Some(Shader::custom(device, source, attached.color)?)
            }
            MeshOutput::Nothing | MeshOutput::Lines(_) => None,
        };
        let (fragment, attached) = match (&options.output, &custom) {
            (MeshOutput::Custom(attached, _), Some(shader)) => {
                (Fragment::Custom(shader), Some(attached))
            }
            (MeshOutput::Lines(attached), _) => (Fragment::Entry("line_color"), Some(attached)),
            _ => (Fragment::None, None),
        };
        if let Some(attached) = attached {
            attached.check(device, custom.is_none())?;
        }
        let depth = attached.and_then(|attached| attached.depth);
        let formats = Formats {
            color: attached.map(|attached| attached.color),
            depth: depth.map(|(format, _)| format),
        };
        // Numbers of one's own are not blended.
        let blending = if custom.is_some() { Blending::Replace } else { Blending::Over };
        let depth = depth.map(|(_, order)| compare(order));
        let emitted = Emitted::Lines;
        let parts = MeshParts { emitted, shape, style: &style, fragment, formats, blending, depth };
        let pipelines = parts.pipelines(device)?;
        Ok(Self { device: device.clone(), shape, pipelines, look: Look::new(device, &style)? })
    }

    /// For strokes, whose style is bound by whoever records them.
    pub(crate) fn strokes(
        device: &Device,
        style: &Layout,
        format: vk::Format,
    ) -> Result<Self, Error> {
        let options = MeshOptions { records: false, ..MeshOptions::default() };
        let shape = shape(device, Emitted::Strokes, &options)?;
        let parts = MeshParts {
            emitted: Emitted::Strokes,
            shape,
            style,
            fragment: Fragment::Entry("stroke_coverage"),
            formats: Formats { color: Some(format), depth: None },
            blending: Blending::Larger,
            depth: None,
        };
        let pipelines = parts.pipelines(device)?;
        let look = Look::new(device, &layouts::stroke(device)?)?;
        Ok(Self { device: device.clone(), shape, pipelines, look })
    }

    /// The device it was made for.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Lanes of a task workgroup, each for a patch.
    pub fn task_width(&self) -> u32 {
        self.shape.task_width
    }

    /// Lanes of a mesh workgroup.
    pub fn mesh_width(&self) -> u32 {
        self.shape.mesh_width
    }

    /// Edges of a mesh workgroup.
    pub fn edges_per_workgroup(&self) -> u32 {
        self.shape.edges_per_workgroup
    }

    /// Whether segments are written to a buffer.
    pub fn records(&self) -> bool {
        self.shape.records
    }

    /// Records the look of lines, and the matrix from the space of the scene to clip space, for what is recorded
    /// from here on. Outside of rendering.
    ///
    /// # Errors
    /// If the commands are of another device.
    pub fn prepare(
        &self,
        commands: &mut Commands,
        scene_to_clip: Mat4,
        style: &LineStyle,
    ) -> Result<(), Error> {
        commands.check(&self.device, "the pass of mesh shaders")?;
        self.look.record(commands, scene_to_clip, style);
        Ok(())
    }

    /// Draws what `contours` was prepared for. Recorded again, it is drawn, counted and written down again.
    ///
    /// # Errors
    /// If rendering is to other attachments than the pass was made for, or of another device; if the contours were not
    /// prepared in these commands, or made for a pass with other workgroups; if [`MeshPass::prepare`] was never called;
    /// or while compute shaders are counted.
    pub fn record(
        &self,
        rendering: &mut Rendering<'_>,
        contours: &MeshContours,
    ) -> Result<(), Error> {
        self.look.check()?;
        self.record_with(rendering, contours, self.look.set())
    }

    /// Finds contour edges and draws nothing: for a pass of [`MeshOutput::Nothing`]. Outside of rendering.
    ///
    /// # Errors
    /// If the pass draws something, and as [`MeshPass::record`].
    pub fn extract(&self, commands: &mut Commands, contours: &MeshContours) -> Result<(), Error> {
        let nothing = Targets { color: None, depth: None, size: [1, 1] };
        self.record_with(&mut commands.render(&nothing), contours, self.look.set())
    }

    pub(crate) fn record_with(
        &self,
        rendering: &mut Rendering<'_>,
        contours: &MeshContours,
        style: &Set,
    ) -> Result<(), Error> {
        rendering.check(&self.device, "the pass of mesh shaders")?;
        contours.input.check(rendering.commands())?;
        if contours.limits.shape != self.shape {
            return Err(Error::OtherPass);
        }
        for (index, draw) in contours.draws.iter().enumerate() {
            let offsets = [contours.input.offset(index), contours.counters_offset(index)];
            let model = contours.model().bindings(draw.chunk);
            let sets: [(&Set, &[u32]); 4] = [
                (model, &[]),
                (&contours.work_set, &offsets),
                (style, &[]),
                (&contours.vertex_set, &[]),
            ];
            let pipeline = &self.pipelines[draw.culling as usize];
            rendering.bind(pipeline, "the pass of mesh shaders", &sets)?;
            rendering.draw_mesh_tasks(draw.grid);
        }
        Ok(())
    }

    pub(crate) fn limits(&self) -> MeshLimits {
        let MeshProperties { task_grid, mesh_grid, .. } = self.device.mesh_properties();
        MeshLimits { shape: self.shape, task_grid, mesh_grid }
    }
}

/// What draws are cut for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshLimits {
    pub(crate) shape: MeshShape,
    task_grid: [u32; 2],
    mesh_grid: [u32; 2],
}

impl MeshLimits {
    pub(crate) fn of(self, method: Method) -> DrawLimits {
        let [row, workgroups] = match method {
            Method::BruteForce => self.mesh_grid,
            Method::Patches => self.task_grid,
        };
        DrawLimits { shape: self.shape, row, workgroups, edges: MOST_TESTS }
    }
}

impl MeshParts<'_> {
    /// By [`Culling`].
    fn pipelines(&self, device: &Device) -> Result<[Pipeline; 3], Error> {
        let pipeline = |culling| self.pipeline(device, culling);
        Ok([
            pipeline(Culling::Nothing)?,
            pipeline(Culling::Patches)?,
            pipeline(Culling::SuperPatches)?,
        ])
    }

    fn pipeline(&self, device: &Device, culling: Culling) -> Result<Pipeline, Error> {
        let what = "contours by mesh shaders";
        let source = self.shape.prelude(culling) + mesh_source(culling, self.emitted);
        let shader = Shader::new(device, what, &source)?;
        let mut stages = Vec::new();
        if let Some(entry) = culling.task_entry() {
            stages.push((vk::ShaderStageFlags::TASK_EXT, &shader, entry));
        }
        stages.push((vk::ShaderStageFlags::MESH_EXT, &shader, culling.mesh_entry()));
        match self.fragment {
            Fragment::None => {}
            Fragment::Entry(entry) => {
                stages.push((vk::ShaderStageFlags::FRAGMENT, &shader, entry));
            }
            Fragment::Custom(custom) => {
                stages.push((vk::ShaderStageFlags::FRAGMENT, custom, CUSTOM_ENTRY));
            }
        }
        let drawing = Drawing {
            what,
            stages: &stages,
            layouts: &[
                &layouts::model(device)?,
                &layouts::mesh_draws(device)?,
                self.style,
                &layouts::mesh_vertices(device)?,
            ],
            has_positions: false,
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            formats: self.formats,
            blending: self.blending,
            depth: self.depth,
        };
        drawing.pipeline(device)
    }
}

fn shape(device: &Device, emitted: Emitted, options: &MeshOptions<'_>) -> Result<MeshShape, Error> {
    let mesh = device.mesh_properties();
    let most_edges = (mesh.vertices / emitted.vertices())
        .min(mesh.primitives / emitted.primitives())
        .min(MOST_EDGES * Emitted::Lines.vertices() / emitted.vertices());
    let choose = |asked: Option<u32>, usual: u32, most: u32, what| {
        let asked = asked.unwrap_or(usual.clamp(1, most));
        if (1..=most).contains(&asked) {
            Ok(asked)
        } else {
            Err(Error::Lanes { what, asked, most })
        }
    };
    let [most, preferred] = mesh.task_width.map(|width| width.min(MOST_TASK_LANES));
    let task_width = choose(options.task_width, preferred, most, "a task workgroup")?;
    let [most, preferred] = mesh.mesh_width.map(|width| width.min(most_edges));
    let usual = preferred.min(USUAL_EDGES);
    let mesh_width = choose(options.mesh_width, usual, most, "a mesh workgroup")?;
    let rounds = (USUAL_EDGES.min(most_edges) / mesh_width).max(1);
    let (usual, what) = (rounds * mesh_width, "edges of a mesh workgroup");
    let edges_per_workgroup = choose(options.edges_per_workgroup, usual, most_edges, what)?;
    if !edges_per_workgroup.is_multiple_of(mesh_width) {
        return Err(Error::UnevenLanes { edges: edges_per_workgroup, lanes: mesh_width });
    }
    let records = options.records;
    Ok(MeshShape { task_width, mesh_width, edges_per_workgroup, records })
}
