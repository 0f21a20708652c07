//! A drawing as PNG.

use glam::DVec2;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, StrokeDash, Transform,
};

use crate::{Area, Color, Drawing, Style};

/// Most pixels of a picture: 1 GiB of memory.
const MAX_PIXELS: u64 = 1 << 28;

/// `drawing` as the bytes of a PNG file, anti-aliased, one pixel per pixel of the page, on white
/// unless the style says otherwise.
///
/// # Errors
/// A page of more than 2²⁸ pixels, or no memory for it.
pub fn to_png(drawing: &Drawing, style: &Style) -> Result<Vec<u8>, PngError> {
    let (width, height) = (drawing.page.width, drawing.page.height);
    let too_large = PngError::TooLarge { width, height };
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(too_large);
    }
    let mut pixmap = Pixmap::new(width, height).ok_or(too_large)?;
    pixmap.fill(painted(style.background.unwrap_or(Color::WHITE)));
    drawing.areas.iter().for_each(|area| fill(&mut pixmap, area));
    let mut paint = Paint { anti_alias: true, ..Default::default() };
    paint.set_color(painted(style.color));
    for (_, visible, runs) in drawing.inked(style) {
        let dashes = style.dashes(visible);
        let stroke = Stroke {
            width: narrow(style.width_of(visible)),
            // Round caps would fill the gaps.
            line_cap: if dashes.is_some() { LineCap::Butt } else { LineCap::Round },
            line_join: LineJoin::Round,
            dash: dashes.and_then(|lengths| StrokeDash::new(lengths.map(narrow).into(), 0.0)),
            ..Default::default()
        };
        // One stroke for all, so that lines that are not opaque do not add up where they cross.
        let mut builder = PathBuilder::new();
        runs.into_iter().for_each(|run| push(&mut builder, &run.points, run.closed));
        if let Some(path) = builder.finish() {
            pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
        }
    }
    pixmap.encode_png().map_err(|error| PngError::Encoding { reason: error.to_string() })
}

/// Fills an area and outlines it in its own color.
fn fill(pixmap: &mut Pixmap, area: &Area) {
    let mut builder = PathBuilder::new();
    area.rings.iter().for_each(|ring| push(&mut builder, ring, true));
    let Some(path) = builder.finish() else { return };
    let mut paint = Paint { anti_alias: true, ..Default::default() };
    paint.set_color(painted(area.tint.color));
    let stroke = Stroke {
        width: narrow(area.tint.outline()),
        line_join: LineJoin::Round,
        ..Default::default()
    };
    pixmap.fill_path(&path, &paint, FillRule::Winding, Transform::identity(), None);
    pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
}

fn push(builder: &mut PathBuilder, points: &[DVec2], closed: bool) {
    for (i, point) in points.iter().enumerate() {
        let (x, y) = (narrow(point.x), narrow(point.y));
        if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    if closed {
        builder.close();
    }
}

fn painted(color: Color) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(color.red, color.green, color.blue, color.alpha)
}

/// Pages have at most 65,535 pixels a side, of which f32 keeps 1/256.
fn narrow(x: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounds")]
    let narrow = x as f32;
    narrow
}

/// Why there is no PNG.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PngError {
    /// More pixels than fit.
    #[error("a PNG of {width} x {height} pixels is larger than the 268435456 pixels that fit")]
    TooLarge {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The encoder failed.
    #[error("cannot encode the PNG: {reason}")]
    Encoding {
        /// What it said.
        reason: String,
    },
}
