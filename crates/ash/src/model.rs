//! What is uploaded once.

use std::sync::Arc;

use ash::vk::BufferUsageFlags as Usage;
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency};
use drypoint_shaders::{BLOCK_PATCHES, Chunk, Content, EdgePlanes, Frame, Group, MAX_PIECE};

use crate::barrier::Use;
use crate::binding::{Layout, Resource, Set};
use crate::commands::Commands;
use crate::device::MOST_TESTS;
use crate::execution::Fate;
use crate::memory::Buffer;
use crate::{Device, Error, layouts};

/// Edges, planes and patches of a model in GPU memory: 48 bytes an edge, 12 a vertex and 48 a patch.
///
/// A model of several rigid parts has a patch set for each, and is placed part by part. A clone is the same
/// model; memory is freed with the last.
#[derive(Clone, Debug)]
pub struct Model {
    content: Arc<Uploaded>,
}

#[derive(Debug)]
struct Uploaded {
    device: Device,
    fate: Fate,
    frames: Vec<Frame>,
    /// Pieces that fit the device's bindings ...
    chunks: Vec<Chunk>,
    /// ... how many blocks the super-patches of each are in ...
    block_counts: Vec<u32>,
    /// ... and where they are.
    bindings: Vec<Set>,
    positions: Buffer,
    vertex_count: usize,
    edge_count: u64,
    has_patches: bool,
}

impl Model {
    /// Records the upload of a patch set for each rigid part. Takes about as long as reading the patch sets,
    /// with exact predicates and a normal for each edge.
    ///
    /// # Errors
    /// If there is no part, if there is not enough memory, or if the vertices of all parts, 12 bytes each, do
    /// not fit one binding.
    pub fn new(commands: &mut Commands, parts: &[&PatchSet]) -> Result<Self, Error> {
        Self::upload(commands, &Content::new(parts))
    }

    /// Records the upload of a mesh without patches, for brute force alone.
    ///
    /// # Errors
    /// As [`Model::new`].
    ///
    /// # Panics
    /// If `adjacency` is of another mesh, with more vertices.
    pub fn without_patches(
        commands: &mut Commands,
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
    ) -> Result<Self, Error> {
        Self::upload(commands, &Content::without_patches(mesh, adjacency, filter))
    }

    /// Records the upload of what was made by other means than the two above: groups of one's own
    /// ([`Content::with_groups`]), or a content that several devices share.
    ///
    /// # Errors
    /// As [`Model::new`], and [`Error::Inconsistent`] if the content refers to what it does not have.
    pub fn upload(commands: &mut Commands, content: &Content) -> Result<Self, Error> {
        if content.frames.is_empty() {
            return Err(Error::NoParts);
        }
        content.check().map_err(|what| Error::Inconsistent { what })?;
        let device = commands.device().clone();
        let limit = u64::from(device.limits().max_storage_buffer_range);
        let fitting = |size: usize| u32::try_from(limit / size as u64).unwrap_or(u32::MAX);
        let most_edges = fitting(size_of::<EdgePlanes>()).clamp(MAX_PIECE, MOST_TESTS);
        let chunks = content.chunks(most_edges, fitting(size_of::<Group>()));
        let usage = Usage::STORAGE_BUFFER | Usage::VERTEX_BUFFER;
        let positions = bytemuck::cast_slice(&content.positions);
        let positions = commands.upload("the vertices of a model", positions, usage)?;
        let layout = layouts::model(&device)?;
        let (mut block_counts, mut bindings) = (Vec::new(), Vec::new());
        for chunk in &chunks {
            let blocks = chunk.blocks(BLOCK_PATCHES);
            bindings.push(upload_chunk(commands, &layout, content, (chunk, &blocks))?);
            block_counts.push(u32::try_from(blocks.len().saturating_sub(1)).unwrap_or(u32::MAX));
        }
        commands.barrier(Use::COPIED_TO, Use::USED_BY_SHADERS);
        Ok(Self {
            content: Arc::new(Uploaded {
                device,
                fate: commands.fate().clone(),
                frames: content.frames.clone(),
                chunks,
                block_counts,
                bindings,
                positions,
                vertex_count: content.positions.len(),
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
        meshes.len() == self.content.frames.len() && self.content.vertex_count == vertices
    }

    /// Fails if it was made for another device, or never uploaded.
    pub(crate) fn check(&self, device: &Device) -> Result<(), Error> {
        let what = "the model";
        self.content.fate.check(what)?;
        if self.content.device.is(device) { Ok(()) } else { Err(Error::OtherDevice { what }) }
    }

    pub(crate) fn device(&self) -> &Device {
        &self.content.device
    }

    pub(crate) fn frames(&self) -> &[Frame] {
        &self.content.frames
    }

    pub(crate) fn chunks(&self) -> &[Chunk] {
        &self.content.chunks
    }

    pub(crate) fn block_counts(&self) -> &[u32] {
        &self.content.block_counts
    }

    pub(crate) fn bindings(&self, chunk: usize) -> &Set {
        &self.content.bindings[chunk]
    }

    pub(crate) fn positions(&self) -> &Buffer {
        &self.content.positions
    }
}

fn upload_chunk(
    commands: &mut Commands,
    layout: &Layout,
    content: &Content,
    (chunk, blocks): (&Chunk, &[u32]),
) -> Result<Set, Error> {
    let edges = chunk.edges.start as usize..chunk.edges.end as usize;
    let mut upload = |what, bytes: &[u8]| commands.upload(what, bytes, Usage::STORAGE_BUFFER);
    let buffers = [
        upload("the planes of a model", bytemuck::cast_slice(&content.planes[edges.clone()]))?,
        upload("the edges of a model", bytemuck::cast_slice(&content.ends[edges]))?,
        upload("the patches of a model", bytemuck::cast_slice(&chunk.patches))?,
        upload("the super-patches of a model", bytemuck::cast_slice(&chunk.super_patches))?,
        upload("blocks of super-patches", bytemuck::cast_slice(blocks))?,
    ];
    let resources = buffers.each_ref().map(Resource::Buffer);
    Set::new(layout, "the bindings of a model", &resources)
}
