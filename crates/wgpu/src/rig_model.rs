//! What of a rig is uploaded once.

use std::sync::Arc;

use drypoint_fusion::PatchSet;
use drypoint_mesh::rig::{Rig, Skin};
use drypoint_shaders::{BendingFace, Chunk, RigContent, RigLayout};
use glam::Vec3;
use wgpu::BufferUsages;

use crate::Error;
use crate::bindings::bind;
use crate::device::filled;
use crate::extractor::Extractor;
use crate::model::upload_chunks;
use crate::rig_pipelines::RigPipelines;

/// A rig in GPU memory: its shapes with their patches, each once however many rigid parts have it, and what
/// loose edges need.
///
/// 48 bytes an edge and 48 a patch of shapes; 24 a loose edge, 36 an influence and 16 a morph offset of a vertex
/// beside one, and 16 a face that bends. A clone is the same rig; memory is freed with the last.
#[derive(Clone, Debug)]
pub struct RigModel {
    pub(crate) uploaded: Arc<UploadedRig>,
}

/// What a [`RigModel`] consists of.
#[derive(Debug)]
pub(crate) struct UploadedRig {
    pub(crate) layout: RigLayout,
    /// Pieces of each class that fit the device's bindings ...
    pub(crate) chunks: Vec<Vec<Chunk>>,
    /// ... and these bindings.
    pub(crate) chunk_bindings: Vec<Vec<wgpu::BindGroup>>,
    pub(crate) pipelines: Arc<RigPipelines>,
    /// What posing vertices, finding sides and testing loose edges read of the rig.
    pub(crate) loose_bindings: [wgpu::BindGroup; 3],
    /// Vertices of all shapes.
    pub(crate) positions: Vec<Vec3>,
    pub(crate) loose_edges: u32,
    pub(crate) bending_faces: Vec<BendingFace>,
    pub(crate) edge_count: u64,
}

impl RigModel {
    /// Uploads a rig that is split into `skin`, whose shapes have `patches`
    /// ([`fuse_shapes`](drypoint_fusion::fuse_shapes)). The first on a device compiles three shaders. Waits for
    /// no GPU work.
    ///
    /// # Errors
    /// [`Error::OtherPatches`] if the patches are not those of the shapes; if the GPU has not enough memory, or
    /// what is loose does not fit its bindings.
    pub fn new(
        extractor: &Extractor,
        rig: &Rig,
        skin: &Skin,
        patches: &[PatchSet],
    ) -> Result<Self, Error> {
        let content = RigContent::new(rig, skin, patches).ok_or(Error::OtherPatches)?;
        let pipelines = extractor.rig_pipelines()?;
        let uploads = content.classes.iter().map(|class| upload_chunks(extractor, class));
        let (chunks, chunk_bindings) = uploads.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let loose_bindings = upload_loose(extractor, &pipelines, &content)?;
        let edge_count = content.edge_count();
        #[expect(clippy::cast_possible_truncation, reason = "edges have a u32 each")]
        let loose_edges = content.loose_edges.len() as u32;
        let RigContent { layout, positions, bending_faces, .. } = content;
        Ok(Self {
            uploaded: Arc::new(UploadedRig {
                layout,
                chunks,
                chunk_bindings,
                pipelines,
                loose_bindings,
                positions,
                loose_edges,
                bending_faces,
                edge_count,
            }),
        })
    }

    /// What the rig has, and where placements are.
    pub fn layout(&self) -> &RigLayout {
        &self.uploaded.layout
    }

    /// Number of edges of an instance: of all its parts, and loose ones.
    pub fn edge_count(&self) -> u64 {
        self.uploaded.edge_count
    }
}

fn upload_loose(
    extractor: &Extractor,
    pipelines: &RigPipelines,
    content: &RigContent,
) -> Result<[wgpu::BindGroup; 3], Error> {
    let device = extractor.device();
    let counts =
        filled(device, "the counts of a rig", &[content.layout.counts], BufferUsages::UNIFORM)?;
    let vertices = [
        storage(device, "the vertices of a rig", &content.first_influences)?,
        storage(device, "the influences of a rig", &content.influences)?,
        storage(device, "the morph targets of a rig", &content.offsets)?,
    ];
    let faces = [
        storage(device, "the bending faces of a rig", &content.bending_faces)?,
        storage(device, "the rigid faces of a rig", &content.part_faces)?,
    ];
    let edges = [storage(device, "the loose edges of a rig", &content.loose_edges)?];
    let bind = |layout, buffers: &[wgpu::Buffer]| {
        let all = std::iter::once(&counts).chain(buffers);
        let resources = all.map(wgpu::Buffer::as_entire_binding).collect();
        bind(device, "the bindings of a rig", layout, resources)
    };
    Ok([
        bind(&pipelines.vertices.model_layout, &vertices)?,
        bind(&pipelines.faces.model_layout, &faces)?,
        bind(&pipelines.edges.model_layout, &edges)?,
    ])
}

/// A buffer that may be empty: a binding may not be smaller than an element.
fn storage<T: bytemuck::Pod>(
    device: &wgpu::Device,
    what: &'static str,
    content: &[T],
) -> Result<wgpu::Buffer, Error> {
    let nothing = [T::zeroed()];
    let content = if content.is_empty() { &nothing } else { content };
    filled(device, what, content, BufferUsages::STORAGE)
}
