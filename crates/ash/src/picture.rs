//! A picture that no window shows.

use ash::vk;
use drypoint_shaders::{DepthOrder, View, divide_by_alpha};

use crate::Error;
use crate::canvas::{Canvas, Subject};
use crate::commands::{Commands, Download, Executed, Use};
use crate::memory::Image;
use crate::mesh_pass::MeshPass;
use crate::rendering::Targets;

/// Lines on a background, off screen: 9 bytes a pixel, and 4 more to read them.
#[derive(Debug)]
pub struct Picture {
    size: [u32; 2],
    color: Image,
    canvas: Canvas,
}

/// What a [`Picture`] showed when the commands executed.
#[derive(Debug)]
pub struct Pixels {
    download: Download,
}

const COLOR: vk::Format = vk::Format::R8G8B8A8_UNORM;

impl Picture {
    /// Of width and height in pixels. Depths run as `order` says.
    ///
    /// # Errors
    /// [`Error::PictureSize`] if the device allows no image of that size, or if it has not enough memory.
    pub fn new(commands: &mut Commands, size: [u32; 2], order: DepthOrder) -> Result<Self, Error> {
        let canvas = Canvas::new(commands, size, order, COLOR)?;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let color = Image::new(commands.device(), "a picture", size, (COLOR, usage))?;
        Ok(Self { size, color, canvas })
    }

    /// To make [`MeshContours`](crate::MeshContours) with that are drawn here.
    pub fn mesh_pass(&self) -> &MeshPass {
        self.canvas.mesh_pass()
    }

    /// Draws `subjects` in place of what was drawn before, and a copy of that.
    ///
    /// # Errors
    /// If something is of another device, or there is not enough memory for the copy.
    pub fn draw(
        &self,
        commands: &mut Commands,
        view: &View,
        subjects: &[Subject<'_>],
    ) -> Result<Pixels, Error> {
        self.canvas.cover(commands, view, subjects)?;
        let to_draw = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let to_copy = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let undefined = vk::ImageLayout::UNDEFINED;
        commands.transition(&self.color, (Use::COPIED_FROM, undefined), (Use::DRAWN_TO, to_draw));
        let color = Some((&self.color, COLOR, view.background_times_alpha()));
        let targets = Targets { color, depth: None, size: self.size };
        self.canvas.ink(&mut commands.render(&targets))?;
        commands.transition(&self.color, (Use::DRAWN_TO, to_draw), (Use::COPIED_FROM, to_copy));
        Ok(Pixels { download: commands.download_image("a picture", &self.color)? })
    }
}

impl Pixels {
    /// Red, green, blue and alpha of each pixel, a byte each, row by row from the top, not multiplied by alpha.
    ///
    /// # Errors
    /// If it was drawn by other commands than those that have executed.
    pub fn read(&self, executed: &Executed) -> Result<Vec<u8>, Error> {
        let mut pixels = self.download.read(executed)?.to_vec();
        pixels.as_chunks_mut().0.iter_mut().for_each(divide_by_alpha);
        Ok(pixels)
    }
}
