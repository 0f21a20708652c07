//! `extract --animation`: the contour edges of a model that moves, in one pose.

use std::ops::ControlFlow;

use drypoint_cpu::{RigContours, RigExtractor, Statistics};
use drypoint_fusion::{PatchSet, Progress, fuse_shapes};
use drypoint_mesh::rig::{Pose, Rig, Skin};
use drypoint_mesh::{EdgeFilter, EdgeId, Viewpoint};

use crate::args::{ExtractArgs, Method};
use crate::extract::{Found, found, goes_through_patches};
use crate::gpu::{self, Api};
use crate::progress::Stage;
use crate::source::Source;

/// A model that moves, in a pose.
pub(crate) struct Posed<'a> {
    pub(crate) rig: &'a Rig,
    pub(crate) skin: Skin,
    pub(crate) pose: Pose,
    /// Which edges are looked at.
    filter: EdgeFilter,
}

/// Refuses what poses no models, before one is read.
pub(crate) fn check(args: &ExtractArgs) -> Result<(), String> {
    let is_posed = args.animation.animation.is_some();
    args.method.filter(|_| is_posed).and_then(Method::api).map_or(Ok(()), Api::check_rig)
}

/// Finds the contour edges in the pose that `args` ask for. Ends are the vertices of the file's mesh.
///
/// # Panics
/// If nothing of `source` can move.
pub(crate) fn extract(
    args: &ExtractArgs,
    source: &Source,
    viewpoint: Viewpoint,
) -> Result<Found, String> {
    let rig = source.model.rig.as_ref().expect("a model with animations has a rig");
    let fail = |error| format!("{}: {error}", source.name);
    let pose = args.animation.pose(source)?.unwrap_or_default();
    // A pose at no finite place is refused, whichever way the edges are found.
    rig.mesh(&pose).map_err(fail)?;
    let skin = Skin::new(rig).map_err(fail)?;
    let filter = args.edges.map_or(EdgeFilter::Convex, Into::into);
    let posed = Posed { rig, skin, pose, filter };
    let mut contours = Vec::new();
    let mut sets = Vec::new();
    let (method, statistics) = if args.method.is_some_and(goes_through_patches) {
        sets = posed.fuse(args).map_err(|error| format!("{}: {error}", source.name))?;
        match args.method.and_then(Method::api) {
            Some(api) => {
                (api.name(), gpu::extract_rig(api, &posed, &sets, viewpoint, &mut contours)?)
            }
            None => ("patches", posed.patches(&sets, viewpoint, &mut contours)),
        }
    } else {
        ("brute-force", posed.brute_force(viewpoint, &mut contours))
    };
    let in_file = |vertex: u32| source.model.rig_vertices[vertex as usize];
    let ends = |&edge: &EdgeId| {
        let [a, b] = posed.skin.adjacency().wing(edge).ends().map(in_file);
        [a.min(b), a.max(b)]
    };
    let edges = posed.skin.edges(filter).count();
    let mut found = found(method, edges, statistics, contours.iter().map(ends).collect());
    let of_parts = |count: fn(&PatchSet) -> usize| {
        let sets = posed.skin.parts().iter().filter_map(|part| sets.get(part.shape as usize));
        sets.map(count).sum()
    };
    found.patches = of_parts(|set| set.patches().len());
    found.super_patches = of_parts(|set| set.super_patches().len());
    Ok(found)
}

impl Posed<'_> {
    /// Tests every edge.
    fn brute_force(&self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Statistics {
        self.skin.contour_edges(self.rig, &self.pose, viewpoint, self.filter, contours);
        Statistics {
            edges_tested: self.skin.edges(self.filter).count(),
            contour_edges: contours.len(),
            ..Statistics::default()
        }
    }

    /// Tests the patches of each part from where it sees the viewpoint, and every loose edge.
    fn patches(
        &self,
        sets: &[PatchSet],
        viewpoint: Viewpoint,
        contours: &mut Vec<EdgeId>,
    ) -> Statistics {
        let mut found = RigContours::default();
        let extractor = RigExtractor::new(self.rig, &self.skin, sets);
        let statistics = extractor.edges(&self.pose, viewpoint, &mut found);
        contours.extend(found.edges());
        statistics
    }

    /// Builds the patches of each shape, with progress.
    fn fuse(&self, args: &ExtractArgs) -> Result<Vec<PatchSet>, String> {
        let params = args.fusion.params()?;
        let shapes = self.skin.shapes().iter();
        let edges: usize = shapes.map(|shape| shape.edges(self.filter).count()).sum();
        let stage = Stage::with_length("building patches", edges as u64);
        let progress = |progress: Progress| {
            stage.set(progress.edges_done as u64);
            ControlFlow::Continue(())
        };
        fuse_shapes(&self.skin, self.filter, &params, &progress).map_err(|error| error.to_string())
    }
}
