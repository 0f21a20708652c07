//! A field of instances of one model.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Duration;

use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use drypoint_wgpu::{
    Capacity, Contours, Extractor, Lines, Method, Model, Placement, Statistics, Surface, Timer,
};
use glam::{DAffine3, DMat3, DVec3};

use crate::colored::ColoredPatches;
use crate::target::Target;

pub(crate) struct Scene {
    pub(crate) method: Method,
    pub(crate) shows_patches: bool,
    pub(crate) colored: ColoredPatches,
    pub(crate) surface: Surface,
    pub(crate) lines: Lines,
    pub(crate) contours: Contours,
    extractor: Extractor,
    to_scene: Vec<DAffine3>,
    edge_count: u64,
    patch_count: u64,
    timer: Option<Timer>,
    statistics: Statistics,
    time: Option<Duration>,
}

/// From instance to instance; each is 2 across.
const SPACING: f64 = 2.6;

/// Instances in a row.
fn side(instances: u32) -> u32 {
    let root = instances.isqrt();
    if root * root < instances { root + 1 } else { root }
}

/// Of a scene with so many instances.
pub(crate) fn radius(instances: u32) -> f64 {
    0.7 * SPACING * f64::from(side(instances))
}

impl Scene {
    pub(crate) fn new(
        target: &Target,
        mesh: &Mesh,
        instances: u32,
    ) -> Result<Self, Box<dyn Error>> {
        let adjacency = MeshAdjacency::new(mesh);
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse(mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &go_on)?;
        let extractor = Extractor::new(&target.device)?;
        let model = Model::new(&extractor, &[&patches])?;
        let segments = u32::try_from(model.edge_count() * u64::from(instances) / 16)?.max(1 << 10);
        let capacity = Capacity { placements: instances, segments };
        let contours = Contours::new(&extractor, &model, capacity)?;
        Ok(Self {
            method: Method::Patches,
            shows_patches: false,
            colored: ColoredPatches::new(target, mesh, &patches, &contours),
            surface: Surface::new(&target.depth_pass, &contours, &[mesh])?,
            lines: Lines::new(&target.line_pass, &contours)?,
            contours,
            extractor,
            to_scene: field(mesh, instances),
            edge_count: model.edge_count() * u64::from(instances),
            patch_count: patches.patches().len() as u64 * u64::from(instances),
            timer: Timer::new(&target.device, &target.queue).ok(),
            statistics: Statistics::default(),
            time: None,
        })
    }

    /// Records the search for contours, as seen from `eye`.
    pub(crate) fn find_contours(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        eye: DVec3,
    ) -> Result<(), drypoint_wgpu::Error> {
        let viewpoint = Viewpoint::at(eye);
        let placed = |&to_scene: &DAffine3| Placement { to_scene, viewpoint };
        let placements: Vec<_> = self.to_scene.iter().map(placed).collect();
        self.contours.prepare(encoder, &placements, self.method)?;
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("contours"),
                timestamp_writes: self.timer.as_ref().map(Timer::compute_pass),
            });
            self.extractor.record(&mut pass, &self.contours);
        }
        self.contours.request_statistics(encoder);
        if let Some(timer) = &mut self.timer {
            timer.request(encoder);
            self.time = timer.newest().or(self.time);
        }
        Ok(())
    }

    /// Takes what came back of earlier frames, and makes room if contours did not fit.
    pub(crate) fn look_back(
        &mut self,
        target: &Target,
        mesh: &Mesh,
    ) -> Result<(), drypoint_wgpu::Error> {
        let Some(statistics) = self.contours.newest_statistics() else { return Ok(()) };
        self.statistics = statistics;
        if let Some(needed) = statistics.overflow() {
            let segments = u32::try_from(needed + needed / 4).unwrap_or(u32::MAX);
            let capacity = Capacity { segments, ..self.contours.capacity() };
            self.contours = Contours::new(&self.extractor, self.contours.model(), capacity)?;
            self.surface = Surface::new(&target.depth_pass, &self.contours, &[mesh])?;
            self.lines = Lines::new(&target.line_pass, &self.contours)?;
            self.colored.follow(&target.device, &self.contours);
        }
        Ok(())
    }

    /// For the title, with the time from frame to frame.
    pub(crate) fn summary(&self, frame: Duration) -> String {
        let Statistics { segments, edges_tested, patches_accepted, .. } = self.statistics;
        let culling = match self.method {
            Method::BruteForce => "culling off".to_owned(),
            Method::Patches => {
                format!("culling on: {patches_accepted} of {} patches left", self.patch_count)
            }
        };
        let time = self.time.map_or("untimed".to_owned(), |time| format!("{time:.2?}"));
        format!(
            "Drypoint: {} instances, {segments} contour edges; {culling}; {edges_tested} of {} edges \
             tested in {time}; {frame:.1?} a frame",
            self.to_scene.len(),
            self.edge_count,
        )
    }
}

/// Instances in rows, scaled to 2 across and turned this way and that.
fn field(mesh: &Mesh, instances: u32) -> Vec<DAffine3> {
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
    (0..instances).map(place).collect()
}
