//! What is drawn of the field: contours, found one way or the other, and the surfaces that hide them.

use std::error::Error;
use std::rc::Rc;
use std::time::Duration;

use drypoint_ash::{
    Attachments, Canvas, Capacity, Commands, Contours, DepthOrder, Extractor, Gpu, LineStyle,
    MeshContours, Method, Model, Subject, Surface, View,
};

use crate::field::Field;
use crate::frames::{Asked, Counted};
use crate::orbit::Orbit;
use crate::swapchain::Image;

/// Where contours are found.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shaders {
    /// While they are drawn.
    Mesh,
    /// Before that.
    Compute,
}

pub(crate) struct Scene {
    shaders: Shaders,
    field: Rc<Field>,
    canvas: Canvas,
    size: [u32; 2],
    extractor: Extractor,
    mesh: (MeshContours, Surface),
    compute: (Contours, Surface),
    /// Of the newest frame that has executed.
    counted: Counted,
}

impl Scene {
    /// To be drawn to such attachments.
    pub(crate) fn new(
        gpu: &Gpu,
        field: &Rc<Field>,
        attachments: &Attachments,
        shaders: Shaders,
    ) -> Result<Self, Box<dyn Error>> {
        let canvas = canvas(gpu, attachments)?;
        let extractor = Extractor::new(gpu.device())?;
        let (model, _) = gpu.run(|commands| Model::new(commands, &[&field.patches]))?;
        // Mesh shaders take no room for segments.
        let capacity = Capacity { placements: field.instances(), segments: 0 };
        let mesh = MeshContours::new(canvas.mesh_pass(), &model, capacity)?;
        let capacity = Capacity { segments: field.segment_capacity()?, ..capacity };
        let compute = Contours::new(&extractor, &model, capacity)?;
        let (surfaces, _) = gpu.run(|commands| {
            let of_mesh = Surface::new(commands, &mesh, &[&field.mesh])?;
            Ok([of_mesh, Surface::new(commands, &compute, &[&field.mesh])?])
        })?;
        let [of_mesh, of_compute] = surfaces;
        Ok(Self {
            shaders,
            field: Rc::clone(field),
            canvas,
            size: attachments.size,
            extractor,
            mesh: (mesh, of_mesh),
            compute: (compute, of_compute),
            counted: Counted::default(),
        })
    }

    /// Takes other attachments, once the device is idle.
    pub(crate) fn resize(
        &mut self,
        gpu: &Gpu,
        attachments: &Attachments,
    ) -> Result<(), drypoint_ash::Error> {
        gpu.run(|commands| self.canvas.resize(commands, attachments.size))?;
        self.size = attachments.size;
        Ok(())
    }

    /// Finds contours by the other shaders from now on.
    pub(crate) fn switch(&mut self) {
        self.shaders = match self.shaders {
            Shaders::Mesh => Shaders::Compute,
            Shaders::Compute => Shaders::Mesh,
        };
    }

    /// Records all of a frame.
    pub(crate) fn draw(
        &mut self,
        commands: &mut Commands,
        image: &Image,
        orbit: &Orbit,
        method: Method,
    ) -> Result<Asked, drypoint_ash::Error> {
        let placements = self.field.placements(orbit.eye());
        let [width, height] = self.size.map(f64::from);
        let lines = LineStyle { width: 1.2, ..LineStyle::default() };
        let scene_to_clip = orbit.scene_to_clip(width / height);
        let view = View { scene_to_clip, background: [1.0; 4], lines };
        let subject = match self.shaders {
            Shaders::Mesh => {
                let (contours, surface) = &mut self.mesh;
                contours.prepare(commands, &placements, method)?;
                Subject { contours: (&*contours).into(), surface }
            }
            Shaders::Compute => {
                let (contours, surface) = &mut self.compute;
                contours.prepare(commands, &placements, method)?;
                self.extractor.record(commands, contours)?;
                Subject { contours: (&*contours).into(), surface }
            }
        };
        self.canvas.cover(commands, &view, &[subject])?;
        image.render(commands, |rendering| self.canvas.ink(rendering))?;
        Ok(match self.shaders {
            Shaders::Mesh => Asked::Mesh(self.mesh.0.download(commands)?),
            Shaders::Compute => Asked::Compute(self.compute.0.download_statistics(commands)?),
        })
    }

    /// Takes what a frame has counted, and makes room if contours did not fit.
    pub(crate) fn look_back(
        &mut self,
        gpu: &Gpu,
        counted: Counted,
    ) -> Result<(), drypoint_ash::Error> {
        self.counted = counted;
        let capacity = self.compute.0.capacity();
        let needed = counted.statistics.segments;
        if counted.workgroups.is_none() && needed > u64::from(capacity.segments) {
            let segments = u32::try_from(needed + needed / 4).unwrap_or(u32::MAX);
            let capacity = Capacity { segments, ..capacity };
            let contours = Contours::new(&self.extractor, self.compute.0.model(), capacity)?;
            let (surface, _) =
                gpu.run(|commands| Surface::new(commands, &contours, &[&self.field.mesh]))?;
            self.compute = (contours, surface);
        }
        Ok(())
    }

    /// For the title.
    pub(crate) fn summary(&self, method: Method) -> String {
        let Counted { statistics, workgroups, seconds } = &self.counted;
        let summary = self.field.summary(statistics, method);
        let shaders = workgroups.map_or("compute shaders".to_owned(), |[launched, idle]| {
            format!("mesh shaders in {launched} workgroups, {idle} of them idle")
        });
        let time = seconds.map_or("untimed".to_owned(), |seconds| {
            format!("{:.2?} on the GPU", Duration::from_secs_f64(seconds))
        });
        format!("{summary} by {shaders}; {time}")
    }
}

fn canvas(gpu: &Gpu, attachments: &Attachments) -> Result<Canvas, drypoint_ash::Error> {
    let Attachments { color, size, .. } = *attachments;
    let format = color.unwrap_or_default();
    let order = DepthOrder::Standard;
    Ok(gpu.run(|commands| Canvas::new(commands, size, order, format))?.0)
}
