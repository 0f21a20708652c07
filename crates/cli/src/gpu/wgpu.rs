//! By `drypoint-wgpu`: compute shaders find the contours, an indirect draw draws them.

use drypoint_fusion::PatchSet;
use drypoint_mesh::EdgeId;
use drypoint_shaders::{Content, DepthOrder, Method, Placement, Segment, Statistics};
use drypoint_wgpu::{
    Capacity, Contours, Error, Extractor, Gpu, Lines, Model, Picture, RigCapacity, RigContours,
    RigInstance, RigModel, Subject, Surface,
};

use super::frame::{Frame, with_room};
use crate::rigged::Posed;

/// All contour edges of `patches`, and what was tested.
pub(super) fn extract(
    patches: &PatchSet,
    placement: &Placement,
) -> Result<(Vec<Segment>, Statistics), Error> {
    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = Model::upload(&extractor, &Content::new(&[patches]))?;
    let (contours, statistics) = find(&gpu, &extractor, &model, (placement, Method::Patches))?;
    Ok((contours.read_segments(&gpu.queue)?, statistics))
}

/// All contour edges of a model that moves, and what was tested.
pub(super) fn extract_rig(
    posed: &Posed<'_>,
    patches: &[PatchSet],
    placement: Placement,
) -> Result<(Vec<EdgeId>, Statistics), Error> {
    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = RigModel::new(&extractor, posed.rig, &posed.skin, patches)?;
    let instance = RigInstance { pose: &posed.pose, placement };
    let (contours, statistics) = with_room(|segments| -> Result<_, Error> {
        let capacity = RigCapacity { instances: 1, segments };
        let mut contours = RigContours::new(&extractor, &model, capacity)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        contours.prepare(&mut encoder, &[instance], Method::Patches)?;
        extractor.record_rig(&mut encoder.begin_compute_pass(&Default::default()), &contours);
        gpu.queue.submit([encoder.finish()]);
        let statistics = contours.read_statistics(&gpu.queue)?;
        Ok((contours, statistics))
    })?;
    let segments = contours.read_segments(&gpu.queue)?;
    let edges = segments.iter().map(|segment| contours.edge(&posed.skin, segment).edge);
    Ok((edges.collect(), statistics))
}

/// Red, green, blue and alpha of each pixel.
pub(super) fn draw(frame: &Frame<'_>) -> Result<Vec<u8>, Error> {
    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = Model::upload(&extractor, &frame.content())?;
    let mut picture = Picture::new(&gpu.device, frame.size, DepthOrder::Reversed)?;
    let (contours, _) = find(&gpu, &extractor, &model, (&frame.placement, frame.method()))?;
    let surface = Surface::new(picture.depth_pass(), &contours, &[frame.mesh])?;
    let lines = Lines::new(picture.line_pass(), &contours)?;
    let subject = Subject { contours: (&contours).into(), surface: &surface, lines: &lines };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    picture.draw(&mut encoder, &frame.view, &[subject])?;
    gpu.queue.submit([encoder.finish()]);
    picture.read(&gpu.queue)
}

fn find(
    gpu: &Gpu,
    extractor: &Extractor,
    model: &Model,
    (placement, method): (&Placement, Method),
) -> Result<(Contours, Statistics), Error> {
    with_room(|segments| {
        let capacity = Capacity { placements: 1, segments };
        let mut contours = Contours::new(extractor, model, capacity)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        contours.prepare(&mut encoder, &[*placement], method)?;
        extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
        gpu.queue.submit([encoder.finish()]);
        let statistics = contours.read_statistics(&gpu.queue)?;
        Ok((contours, statistics))
    })
}
