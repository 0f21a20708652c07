//! Ways to find contour edges on a GPU.

use drypoint_baselines::Meshlets;
use drypoint_fusion::{CostModel, FusionParams, Levels};
use drypoint_mesh::{Mesh, MeshAdjacency};
use drypoint_shaders::{Content, ContentEdge};
use drypoint_tests::judges::Judge;
use drypoint_tests::report::{BRUTE_FORCE, INSTANCES, MESHLETS, OURS, TB24, TWO_LEVELS};
use drypoint_wgpu::{Capacity, Contours, Error, Extractor, Method, Model, Placement};

use super::{FILTER, Work};
use crate::decompositions::fused;

/// A model, and how contour edges are found in it.
pub(super) struct Variant<'a> {
    pub(super) name: &'static str,
    pub(super) contours: Contours,
    extractor: &'a Extractor,
    method: Method,
}

impl<'a> Variant<'a> {
    /// Room for all instances, and for that many segments. Through patches where `content` has any.
    pub(super) fn new(
        extractor: &'a Extractor,
        name: &'static str,
        content: &Content,
        segments: u32,
    ) -> Result<Self, Error> {
        let model = Model::upload(extractor, content)?;
        let method = if model.has_patches() { Method::Patches } else { Method::BruteForce };
        #[expect(clippy::cast_possible_truncation, reason = "252")]
        let capacity = Capacity { placements: INSTANCES as u32, segments };
        Ok(Self { name, contours: Contours::new(extractor, &model, capacity)?, extractor, method })
    }
}

impl Work for Variant<'_> {
    fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        placements: &[Placement],
    ) -> Result<(), Error> {
        self.contours.prepare(encoder, placements, self.method)
    }

    fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.extractor.record(pass, &self.contours);
    }
}

/// Edges in groups, or one by one.
pub(crate) struct Grouped<'a> {
    pub(crate) name: &'static str,
    pub(crate) content: Content,
    /// What does the same on the CPU, with exact predicates; none for edges one by one.
    pub(crate) judge: Option<Box<dyn Judge + 'a>>,
}

/// For each variant, brute force first. Our own patches are made for GPUs. The published ones are left
/// out where things must be quick.
pub(crate) fn groupings<'a>(
    mesh: &'a Mesh,
    adjacency: &MeshAdjacency,
    is_quick: bool,
) -> Result<Vec<Grouped<'a>>, String> {
    let patches = |name, params| patches(name, mesh, adjacency, &params);
    let ours = FusionParams { cost: CostModel::GPU, ..FusionParams::DEFAULT };
    let edges = Content::without_patches(mesh, adjacency, FILTER);
    let mut groupings = vec![
        Grouped { name: BRUTE_FORCE, content: edges, judge: None },
        patches(OURS, ours)?,
        patches(TWO_LEVELS, FusionParams { levels: Levels::Two, ..ours })?,
    ];
    if !is_quick {
        groupings.push(patches(TB24, FusionParams::PAPER)?);
    }
    let meshlets = Meshlets::new(mesh, adjacency, FILTER, &Default::default());
    let edges = meshlets.edge_ids().iter().map(|&edge| ContentEdge::new(adjacency, edge));
    let groups = meshlets.bounds().zip(meshlets.edge_counts());
    let content = Content::with_groups(mesh.positions(), edges, groups);
    groupings.push(Grouped { name: MESHLETS, content, judge: Some(Box::new(meshlets)) });
    Ok(groupings)
}

/// Patches made anew.
pub(crate) fn patches<'a>(
    name: &'static str,
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    params: &FusionParams,
) -> Result<Grouped<'a>, String> {
    let set = fused(mesh, adjacency, FILTER, params)?;
    let content = Content::new(&[&set]);
    Ok(Grouped { name, content, judge: Some(Box::new(set)) })
}
