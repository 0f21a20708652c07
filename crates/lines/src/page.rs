//! What a view is drawn on.

use crate::CameraError;

/// Most pixels of a side.
const MAX_SIDE: u32 = 65_535;

/// The paper, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Page {
    /// 1 to 65,535.
    pub width: u32,
    /// 1 to 65,535.
    pub height: u32,
    /// Kept free at each side when a view is fitted to a mesh; lines are clipped at the border of
    /// the page, not at the margin. At least 0 and below half the shorter side.
    pub margin: f64,
}

impl Page {
    pub(crate) fn check(&self) -> Result<(), CameraError> {
        let Self { width, height, margin } = *self;
        if ![width, height].iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(CameraError::Page { width, height });
        }
        if !(margin >= 0.0 && 2.0 * margin < f64::from(width.min(height))) {
            return Err(CameraError::Margin { margin, width, height });
        }
        Ok(())
    }

    /// Half the width and half the height within the margin.
    pub(crate) fn half_inside(&self) -> [f64; 2] {
        self.sides().map(|side| 0.5 * side - self.margin)
    }

    pub(crate) fn sides(&self) -> [f64; 2] {
        [self.width, self.height].map(f64::from)
    }
}
