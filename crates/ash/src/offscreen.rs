//! An image that no window shows.

use ash::vk;
use drypoint_shaders::divide_by_alpha;

use crate::Error;
use crate::barrier::Use;
use crate::canvas::check_size;
use crate::commands::Commands;
use crate::execution::{Download, Executed, Fate};
use crate::memory::Image;
use crate::rendering::{Rendering, Targets};

/// A color image to draw to and to read: 4 bytes a pixel.
#[derive(Debug)]
pub struct Offscreen {
    color: Image,
    fate: Fate,
}

/// What an [`Offscreen`] showed when the commands executed.
#[derive(Debug)]
pub struct Pixels {
    download: Download,
}

const TO_DRAW: vk::ImageLayout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
const TO_COPY: vk::ImageLayout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;

impl Offscreen {
    /// Of the color attachment. Colors are as the eye sees them, sRGB, and multiplied by their alpha.
    pub const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

    /// Of width and height in pixels.
    ///
    /// # Errors
    /// [`Error::PictureSize`] if the device allows no image of that size, or if it has not enough memory.
    pub fn new(commands: &mut Commands, size: [u32; 2]) -> Result<Self, Error> {
        let device = commands.device();
        check_size(device, size)?;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let color = Image::new(device, "a picture", size, (Self::FORMAT, usage))?;
        let undefined = (Use::ANYTHING, vk::ImageLayout::UNDEFINED);
        commands.transition(&color, undefined, (Use::DRAWN_TO, TO_DRAW));
        Ok(Self { color, fate: commands.fate().clone() })
    }

    /// Begins rendering to it, in place of what was there, until what is given goes.
    ///
    /// # Errors
    /// If the commands are of another device.
    pub fn render<'a>(
        &self,
        commands: &'a mut Commands,
        background: [f32; 4],
    ) -> Result<Rendering<'a>, Error> {
        commands.check(self.color.device(), "the picture")?;
        commands.transition(
            &self.color,
            (Use::COPIED_FROM.and(Use::DRAWN_TO), vk::ImageLayout::UNDEFINED),
            (Use::DRAWN_TO, TO_DRAW),
        );
        let color = Some((&self.color, Self::FORMAT, background));
        Ok(commands.render(&Targets { color, depth: None, size: self.color.size() }))
    }

    /// Records a copy of what was rendered last; of anything, if nothing was.
    ///
    /// # Errors
    /// If the commands are of another device, or there is not enough memory for the copy.
    pub fn download(&self, commands: &mut Commands) -> Result<Pixels, Error> {
        self.fate.check("the picture")?;
        commands.check(self.color.device(), "the picture")?;
        commands.transition(&self.color, (Use::DRAWN_TO, TO_DRAW), (Use::COPIED_FROM, TO_COPY));
        let download = commands.download_image("a picture", &self.color);
        commands.transition(&self.color, (Use::COPIED_FROM, TO_COPY), (Use::DRAWN_TO, TO_DRAW));
        let download = download?;
        Ok(Pixels { download })
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
