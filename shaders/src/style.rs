//! How a picture looks, for whatever draws it.

use glam::{Mat4, Vec4};

use crate::Stroke;

/// Which way depths run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// From 0 at the near plane to 1 at the far plane, cleared to 1.
    #[default]
    Standard,
    /// From 1 at the near plane to 0 at the far plane or at infinity, cleared to 0: exact far away too, in
    /// a texture of f32.
    Reversed,
}

impl DepthOrder {
    /// What a depth texture is cleared to: farther than all.
    pub const fn cleared(self) -> f32 {
        match self {
            Self::Standard => 1.0,
            Self::Reversed => 0.0,
        }
    }

    /// 1 where farther is larger, -1 where it is smaller.
    pub const fn sign(self) -> f32 {
        match self {
            Self::Standard => 1.0,
            Self::Reversed => -1.0,
        }
    }
}

/// How lines look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineStyle {
    /// In pixels, above 0. Lines thinner than a pixel are drawn paler.
    pub width: f32,
    /// Red, green, blue and alpha from 0 to 1, not multiplied; linear where the target's format is sRGB.
    pub color: [f32; 4],
}

impl Default for LineStyle {
    /// Black, 1.5 pixels wide.
    fn default() -> Self {
        Self { width: 1.5, color: [0.0, 0.0, 0.0, 1.0] }
    }
}

impl LineStyle {
    /// As a shader takes it, with the matrix from the space of the scene to clip space.
    pub fn stroke(&self, scene_to_clip: Mat4) -> Stroke {
        let color = Vec4::from(times_alpha(self.color));
        let half_width = 0.5 * self.width.max(0.0);
        Stroke { scene_to_clip, color, half_width, padding: [0.0; 3] }
    }
}

/// How a scene is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the space of the scene to clip space: x and y from -w to w, y up, and z from 0 to w. Perspective
    /// or orthographic.
    pub scene_to_clip: Mat4,
    /// Red, green, blue and alpha from 0 to 1, not multiplied. As the eye sees them: sRGB.
    pub background: [f32; 4],
    /// As the background.
    pub lines: LineStyle,
}

impl View {
    /// What a picture is cleared to: colors multiplied by their alpha.
    pub fn background_times_alpha(&self) -> [f32; 4] {
        times_alpha(self.background)
    }
}

fn times_alpha([red, green, blue, alpha]: [f32; 4]) -> [f32; 4] {
    [red * alpha, green * alpha, blue * alpha, alpha]
}

/// What a pixel's red, green and blue are when they are not multiplied by its alpha.
pub fn divide_by_alpha(pixel: &mut [u8; 4]) {
    let alpha = u16::from(pixel[3]);
    for color in &mut pixel[..3] {
        let divided = (255 * u16::from(*color) + alpha / 2).checked_div(alpha).unwrap_or(0);
        *color = u8::try_from(divided).unwrap_or(u8::MAX);
    }
}
