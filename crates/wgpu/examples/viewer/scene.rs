//! What is drawn of the field: contours, surfaces that hide them, patches in colors.

use std::error::Error;
use std::rc::Rc;
use std::time::Duration;

use drypoint_wgpu::{
    Capacity, Contours, Extractor, Lines, Method, Model, Statistics, Surface, Timer,
};
use glam::DVec3;

use crate::colored::ColoredPatches;
use crate::field::Field;
use crate::target::Target;

pub(crate) struct Scene {
    pub(crate) method: Method,
    pub(crate) shows_patches: bool,
    pub(crate) colored: ColoredPatches,
    pub(crate) surface: Surface,
    pub(crate) lines: Lines,
    pub(crate) contours: Contours,
    field: Rc<Field>,
    extractor: Extractor,
    timer: Option<Timer>,
    statistics: Statistics,
    time: Option<Duration>,
}

impl Scene {
    pub(crate) fn new(target: &Target, field: &Rc<Field>) -> Result<Self, Box<dyn Error>> {
        let extractor = Extractor::new(&target.device)?;
        let Field { mesh, patches, .. } = &**field;
        let model = Model::new(&extractor, &[patches])?;
        let segments = field.segment_capacity()?;
        let capacity = Capacity { placements: field.instances(), segments };
        let contours = Contours::new(&extractor, &model, capacity)?;
        Ok(Self {
            method: Method::Patches,
            shows_patches: false,
            colored: ColoredPatches::new(target, mesh, patches, &contours),
            surface: Surface::new(&target.depth_pass, &contours, &[mesh])?,
            lines: Lines::new(&target.line_pass, &contours)?,
            contours,
            field: Rc::clone(field),
            extractor,
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
        self.contours.prepare(encoder, &self.field.placements(eye), self.method)?;
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
    pub(crate) fn look_back(&mut self, target: &Target) -> Result<(), drypoint_wgpu::Error> {
        let Some(statistics) = self.contours.newest_statistics() else { return Ok(()) };
        self.statistics = statistics;
        if let Some(needed) = statistics.overflow() {
            let segments = u32::try_from(needed + needed / 4).unwrap_or(u32::MAX);
            let capacity = Capacity { segments, ..self.contours.capacity() };
            self.contours = Contours::new(&self.extractor, self.contours.model(), capacity)?;
            self.surface = Surface::new(&target.depth_pass, &self.contours, &[&self.field.mesh])?;
            self.lines = Lines::new(&target.line_pass, &self.contours)?;
            self.colored.follow(&target.device, &self.contours);
        }
        Ok(())
    }

    /// For the title.
    pub(crate) fn summary(&self) -> String {
        let summary = self.field.summary(&self.statistics, self.method);
        let time = self.time.map_or("untimed".to_owned(), |time| format!("in {time:.2?}"));
        format!("{summary} {time}")
    }
}
