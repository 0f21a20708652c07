//! Colours of ink and paper.

use std::fmt;

/// A colour in sRGB with opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color {
    /// 0 to 255.
    pub red: u8,
    /// 0 to 255.
    pub green: u8,
    /// 0 to 255.
    pub blue: u8,
    /// 255 is opaque, 0 invisible.
    pub alpha: u8,
}

impl Color {
    /// `#000000`.
    pub const BLACK: Self = Self::opaque(0, 0, 0);
    /// `#ffffff`.
    pub const WHITE: Self = Self::opaque(255, 255, 255);

    /// A colour that nothing shines through.
    pub const fn opaque(red: u8, green: u8, blue: u8) -> Self {
        Self { red, green, blue, alpha: 255 }
    }
}

impl fmt::Display for Color {
    /// `#rrggbb`, and two more digits if it is not opaque.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.red, self.green, self.blue)?;
        if self.alpha < 255 { write!(f, "{:02x}", self.alpha) } else { Ok(()) }
    }
}
