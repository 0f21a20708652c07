//! A picture of strokes that no window shows.

use drypoint_shaders::{DepthOrder, View};

use crate::Error;
use crate::canvas::{Canvas, Subject};
use crate::commands::Commands;
use crate::mesh_pass::MeshPass;
use crate::offscreen::{Offscreen, Pixels};

/// Lines on a background, off screen: 9 bytes a pixel, and 4 more to read them.
#[derive(Debug)]
pub struct Picture {
    offscreen: Offscreen,
    canvas: Canvas,
}

impl Picture {
    /// Of width and height in pixels. Depths run as `order` says.
    ///
    /// # Errors
    /// [`Error::PictureSize`] if the device allows no image of that size, or if it has not enough memory.
    pub fn new(commands: &mut Commands, size: [u32; 2], order: DepthOrder) -> Result<Self, Error> {
        let canvas = Canvas::new(commands, size, order, Offscreen::FORMAT)?;
        Ok(Self { offscreen: Offscreen::new(commands, size)?, canvas })
    }

    /// To make [`MeshContours`](crate::MeshContours) with that are drawn here.
    pub fn mesh_pass(&self) -> &MeshPass {
        self.canvas.mesh_pass()
    }

    /// Draws `subjects` in place of what was drawn before, and a copy of that.
    ///
    /// # Errors
    /// As [`Canvas::cover`], or if there is not enough memory for the copy.
    pub fn draw(
        &self,
        commands: &mut Commands,
        view: &View,
        subjects: &[Subject<'_>],
    ) -> Result<Pixels, Error> {
        self.canvas.cover(commands, view, subjects)?;
        self.canvas.ink(&mut self.offscreen.render(commands, view.background_times_alpha())?)?;
        self.offscreen.download(commands)
    }
}
