//! A field of instances of one model.

use std::error::Error;
use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use drypoint_shaders::{Method, Placement, Statistics};
use glam::{DAffine3, DMat3, DVec3};

pub(crate) struct Field {
    pub(crate) mesh: Mesh,
    pub(crate) patches: PatchSet,
    to_scene: Vec<DAffine3>,
}

/// From instance to instance; each is 2 across.
const SPACING: f64 = 2.6;

/// Instances in a row.
fn side(instances: u32) -> u32 {
    let root = instances.isqrt();
    if root * root < instances { root + 1 } else { root }
}

/// Of a field of so many instances.
pub(crate) fn radius(instances: u32) -> f64 {
    0.7 * SPACING * f64::from(side(instances))
}

impl Field {
    /// Instances in rows, scaled to 2 across and turned this way and that.
    pub(crate) fn new(mesh: Mesh, instances: u32) -> Result<Self, Box<dyn Error>> {
        let adjacency = MeshAdjacency::new(&mesh);
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse(&mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &go_on)?;
        let bounds = mesh.bounds();
        let center = bounds.map_or(DVec3::ZERO, |bounds| bounds.center());
        let unit = bounds.map_or(1.0, |bounds| bounds.half_longest_side());
        let scale = if unit > 0.0 { 1.0 / unit } else { 1.0 };
        let side = side(instances);
        let middle = f64::from(side - 1) / 2.0;
        let place = |index: u32| {
            let [column, row] = [index % side, index / side].map(f64::from);
            let turned = DMat3::from_rotation_y(f64::from(index) * 2.4) * scale;
            let at = DVec3::new(column - middle, 0.0, row - middle) * SPACING;
            DAffine3::from_mat3_translation(turned, at) * DAffine3::from_translation(-center)
        };
        Ok(Self { to_scene: (0..instances).map(place).collect(), mesh, patches })
    }

    pub(crate) fn instances(&self) -> u32 {
        u32::try_from(self.to_scene.len()).unwrap_or(u32::MAX)
    }

    /// Of all instances together.
    pub(crate) fn edge_count(&self) -> u64 {
        (self.patches.wings().len() * self.to_scene.len()) as u64
    }

    /// Room for contour edges that is enough from most viewpoints.
    pub(crate) fn segment_capacity(&self) -> Result<u32, Box<dyn Error>> {
        Ok(u32::try_from(self.edge_count() / 16)?.max(1 << 10))
    }

    /// All instances, seen from `eye`.
    pub(crate) fn placements(&self, eye: DVec3) -> Vec<Placement> {
        let viewpoint = Viewpoint::at(eye);
        self.to_scene.iter().map(|&to_scene| Placement { to_scene, viewpoint }).collect()
    }

    /// For the title: what was found and tested.
    pub(crate) fn summary(&self, statistics: &Statistics, method: Method) -> String {
        let Statistics { segments, edges_tested, patches_accepted, .. } = statistics;
        let culling = match method {
            Method::BruteForce => "culling off".to_owned(),
            Method::Patches => {
                let all = self.patches.patches().len() * self.to_scene.len();
                format!("culling on: {patches_accepted} of {all} patches left")
            }
        };
        format!(
            "Drypoint: {} instances, {segments} contour edges; {culling}; {edges_tested} of {} edges tested",
            self.to_scene.len(),
            self.edge_count(),
        )
    }
}
