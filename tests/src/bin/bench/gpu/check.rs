//! What a GPU finds against the definition.

use drypoint_mesh::{EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges};
use drypoint_shaders::{EdgePlanes, Frame};
use drypoint_tests::judges::Judge;
use drypoint_wgpu::{Placement, Segment};
use rayon::prelude::*;

use super::FILTER;

/// Contour edges from each placement, by the definition.
pub(crate) struct Seen<'a> {
    mesh: &'a Mesh,
    adjacency: &'a MeshAdjacency,
    views: Vec<(Viewpoint, Vec<EdgeId>)>,
}

impl<'a> Seen<'a> {
    /// Placements must not flatten the mesh. On all threads.
    pub(crate) fn new(
        mesh: &'a Mesh,
        adjacency: &'a MeshAdjacency,
        placements: &[Placement],
    ) -> Self {
        let look = |placement: &Placement| {
            let viewpoint = placement.viewpoint_of_part().expect("it is not flattened");
            let mut edges = Vec::new();
            contour_edges(mesh, adjacency, viewpoint, FILTER, &mut edges);
            edges.sort_unstable();
            (viewpoint, edges)
        };
        Self { mesh, adjacency, views: placements.par_iter().map(look).collect() }
    }

    /// Segments that there should be room for: those of the definition and some more, since f32 may take
    /// other edges for contours.
    pub(crate) fn capacity(&self) -> u32 {
        let all: usize = self.views.iter().map(|(_, edges)| edges.len()).sum();
        u32::try_from(all + all / 16 + 1024).unwrap_or(u32::MAX)
    }

    /// How many edges a view tests on the CPU, on average.
    pub(crate) fn edges_tested(&self, judge: &dyn Judge) -> f64 {
        let test = |found: &mut Vec<EdgeId>, (viewpoint, _): &(Viewpoint, _)| {
            judge.extract(*viewpoint, found).edges
        };
        let all: usize = self.views.par_iter().map_init(Vec::new, test).sum();
        all as f64 / self.views.len() as f64
    }

    /// How many edges are found where the definition has none, or the reverse: all of them within the
    /// margin of f32.
    ///
    /// # Errors
    /// An edge that is found twice, with ends that are not its own, or otherwise than f32 may.
    pub(crate) fn compare(&self, found: &[Segment], frame: &Frame) -> Result<usize, String> {
        let mut of_views = vec![Vec::new(); self.views.len()];
        for segment in found {
            let edges = of_views.get_mut(segment.placement as usize);
            edges.ok_or("a segment of no instance")?.push(segment.edge);
            let ends = self.adjacency.wing(segment.edge).ends();
            if [segment.from_vertex, segment.to_vertex] != ends {
                return Err(format!("{segment:?} is between {ends:?}"));
            }
        }
        let differences = of_views.par_iter_mut().enumerate().map(|(view, found)| {
            found.sort_unstable();
            self.differences(view, found, frame)
        });
        differences.try_reduce(|| 0, |a, b| Ok(a + b))
    }

    /// `found` is sorted.
    fn differences(&self, view: usize, found: &[EdgeId], frame: &Frame) -> Result<usize, String> {
        let (viewpoint, expected) = &self.views[view];
        if let Some(pair) = found.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(format!("edge {} is there twice", pair[0].0));
        }
        let only = |these: &[EdgeId], others: &[EdgeId]| -> Vec<EdgeId> {
            let missing = |edge: &&EdgeId| others.binary_search(edge).is_err();
            these.iter().filter(missing).copied().collect()
        };
        let differing = [only(found, expected), only(expected, found)].concat();
        let in_frame = frame.viewpoint(*viewpoint);
        let is_sure = |edge: &&EdgeId| {
            let wing = self.adjacency.wing(**edge);
            let planes = EdgePlanes::in_f64(self.mesh.positions(), &wing, frame);
            !EdgePlanes::is_doubtful(&planes, in_frame)
        };
        let sure = differing.iter().filter(is_sure).count();
        if sure > 0 {
            let xyz = viewpoint.xyz().to_array();
            return Err(format!("{sure} edges differ from the definition, from {xyz:?}"));
        }
        Ok(differing.len())
    }
}
