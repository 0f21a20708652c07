//! What is uploaded once.

use std::sync::Arc;

use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency};
use drypoint_shaders::{Chunk, Content, EdgeEnds, EdgePlanes, Frame, Group, MAX_PIECE};
use glam::Vec3;
use wgpu::BufferUsages;

use crate::Error;
use crate::bindings::bind;
use crate::device::{filled, largest_storage};
use crate::extractor::Extractor;

/// Edges, planes and patches of a model in GPU memory: 48 bytes an edge, 12 a vertex and 48 a patch.
///
/// A model of several rigid parts has a patch set for each, and is placed part by part. A clone is the same
/// model; memory is freed with the last.
#[derive(Clone, Debug)]
pub struct Model {
    pub(crate) content: Arc<Uploaded>,
}

/// What a [`Model`] consists of.
#[derive(Debug)]
pub(crate) struct Uploaded {
    pub(crate) frames: Vec<Frame>,
    /// Pieces that fit the device's bindings ...
    pub(crate) chunks: Vec<Chunk>,
    /// ... and these bindings.
    pub(crate) bindings: Vec<wgpu::BindGroup>,
    pub(crate) positions: wgpu::Buffer,
    pub(crate) edge_count: u64,
    pub(crate) has_patches: bool,
}

impl Model {
    /// Uploads a patch set for each rigid part. Waits for no GPU work; takes about as long as reading the
    /// patch sets, with exact predicates and a normal for each edge.
    ///
    /// # Errors
    /// If there is no part, if the GPU has not enough memory, or if the vertices of all parts, 12 bytes each, do
    /// not fit one binding.
    pub fn new(extractor: &Extractor, parts: &[&PatchSet]) -> Result<Self, Error> {
        Self::upload(extractor, &Content::new(parts))
    }

    /// Uploads a mesh without patches, for brute force alone.
    ///
    /// # Errors
    /// As [`Model::new`].
    ///
    /// # Panics
    /// If `adjacency` is of another mesh, with more vertices.
    pub fn without_patches(
        extractor: &Extractor,
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
    ) -> Result<Self, Error> {
        Self::upload(extractor, &Content::without_patches(mesh, adjacency, filter))
    }

    /// Uploads what was made by other means than the two above: groups of one's own
    /// ([`Content::with_groups`]), or a content that several devices share.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn upload(extractor: &Extractor, content: &Content) -> Result<Self, Error> {
        if content.frames.is_empty() {
            return Err(Error::NoParts);
        }
        let device = extractor.device();
        let positions: &[f32] = bytemuck::cast_slice(&content.positions);
        let usage = BufferUsages::STORAGE | BufferUsages::VERTEX | BufferUsages::COPY_SRC;
        let positions = filled(device, "the vertices of a model", positions, usage)?;
        let (chunks, bindings) = upload_chunks(extractor, content)?;
        Ok(Self {
            content: Arc::new(Uploaded {
                frames: content.frames.clone(),
                chunks,
                bindings,
                positions,
                edge_count: u64::from(content.edge_count()),
                has_patches: !content.patches.is_empty(),
            }),
        })
    }

    /// Number of rigid parts, each of which needs a placement in each instance; at least 1.
    pub fn part_count(&self) -> u32 {
        u32::try_from(self.content.frames.len()).unwrap_or(u32::MAX)
    }

    /// Number of edges of all parts.
    pub fn edge_count(&self) -> u64 {
        self.content.edge_count
    }

    /// Whether it was made from patch sets.
    pub fn has_patches(&self) -> bool {
        self.content.has_patches
    }

    /// Whether its parts have as many vertices as `meshes`.
    pub(crate) fn is_of(&self, meshes: &[&Mesh]) -> bool {
        let vertices: usize = meshes.iter().map(|mesh| mesh.positions().len()).sum();
        meshes.len() == self.content.frames.len()
            && self.content.positions.size() == ((vertices * size_of::<Vec3>()) as u64).max(16)
    }

    /// Vertices of all parts in model units, three f32 each, in the order that segments count in.
    pub fn positions(&self) -> &wgpu::Buffer {
        &self.content.positions
    }
}

/// Cuts a content into pieces that fit the device's bindings, and uploads them.
pub(crate) fn upload_chunks(
    extractor: &Extractor,
    content: &Content,
) -> Result<(Vec<Chunk>, Vec<wgpu::BindGroup>), Error> {
    let limit = largest_storage(&extractor.device().limits());
    let fitting = |size: usize| u32::try_from(limit / size as u64).unwrap_or(u32::MAX);
    let most_edges = fitting(size_of::<EdgePlanes>()).min(extractor.plan_limits().edges);
    let chunks = content.chunks(most_edges.max(MAX_PIECE), fitting(size_of::<Group>()));
    let upload = |chunk: &Chunk| upload_chunk(extractor, content, chunk);
    let bindings = chunks.iter().map(upload).collect::<Result<_, _>>()?;
    Ok((chunks, bindings))
}

fn upload_chunk(
    extractor: &Extractor,
    content: &Content,
    chunk: &Chunk,
) -> Result<wgpu::BindGroup, Error> {
    let device = extractor.device();
    let edges = chunk.edges.start as usize..chunk.edges.end as usize;
    let usage = BufferUsages::STORAGE;
    let planes: &[EdgePlanes] = &content.planes[edges.clone()];
    let ends: &[EdgeEnds] = &content.ends[edges];
    let buffers = [
        filled(device, "the planes of a model", planes, usage)?,
        filled(device, "the edges of a model", ends, usage)?,
        filled(device, "the patches of a model", &at_least_one(&chunk.patches), usage)?,
        filled(device, "the super-patches of a model", &at_least_one(&chunk.super_patches), usage)?,
    ];
    let resources = buffers.iter().map(wgpu::Buffer::as_entire_binding).collect();
    bind(device, "the bindings of a model", extractor.model_layout(), resources)
}

/// A binding may not be smaller than an element.
fn at_least_one(groups: &[Group]) -> Vec<Group> {
    if groups.is_empty() { vec![bytemuck::Zeroable::zeroed()] } else { groups.to_vec() }
}
