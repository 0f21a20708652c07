//! By `drypoint-ash`: mesh shaders find the contours while they draw them.

use drypoint_ash::{
    Capacity, Error, Gpu, MeshContours, MeshOptions, MeshPass, Model, Picture, Subject, Surface,
};
use drypoint_fusion::PatchSet;
use drypoint_shaders::{Content, DepthOrder, LineStyle, Method, Placement, Segment, Statistics};
use glam::Mat4;

use super::frame::{Frame, with_room};

/// All contour edges of `patches`, and what was tested.
pub(super) fn extract(
    patches: &PatchSet,
    placement: &Placement,
) -> Result<(Vec<Segment>, Statistics), Error> {
    let gpu = Gpu::request()?;
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default())?;
    let upload = |commands: &mut _| Model::upload(commands, &Content::new(&[patches]));
    let (model, _) = gpu.run(upload)?;
    let ((found, executed), statistics) = with_room(|segments| {
        let capacity = Capacity { placements: 1, segments };
        let mut contours = MeshContours::new(&pass, &model, capacity)?;
        let (found, executed) = gpu.run(|commands| {
            contours.prepare(commands, &[*placement], Method::Patches)?;
            pass.prepare(commands, Mat4::IDENTITY, &LineStyle::default())?;
            pass.extract(commands, &contours)?;
            contours.download(commands)
        })?;
        let statistics = found.statistics(&executed)?.found;
        Ok(((found, executed), statistics))
    })?;
    Ok((found.segments(&executed)?, statistics))
}

/// Red, green, blue and alpha of each pixel.
pub(super) fn draw(frame: &Frame<'_>) -> Result<Vec<u8>, Error> {
    let gpu = Gpu::request()?;
    let (pixels, executed) = gpu.run(|commands| {
        let picture = Picture::new(commands, frame.size, DepthOrder::Reversed)?;
        let model = Model::upload(commands, &frame.content())?;
        // What is drawn at once takes no room.
        let capacity = Capacity { placements: 1, segments: 0 };
        let mut contours = MeshContours::new(picture.mesh_pass(), &model, capacity)?;
        let surface = Surface::new(commands, &contours, &[frame.mesh])?;
        let placements = [frame.placement];
        contours.prepare(commands, &placements, frame.method())?;
        let subject = Subject { contours: (&contours).into(), surface: &surface };
        picture.draw(commands, &frame.view, &[subject])
    })?;
    pixels.read(&executed)
}
