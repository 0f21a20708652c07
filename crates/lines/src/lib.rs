//! docs

mod camera;
mod camera_error;
mod chain;
mod color;
mod drawing;
mod fit;
#[cfg(feature = "visibility")]
mod occluders;
mod page;
#[cfg(feature = "png")]
mod png;
mod segments;
mod specks;
#[cfg(feature = "svg")]
mod svg;
mod trace;

pub use camera::Camera;
pub use camera_error::CameraError;
pub use chain::{Chain, chain};
pub use color::Color;
pub use drawing::{Drawing, HiddenLines, Layer, Style};
#[cfg(feature = "visibility")]
pub use occluders::Occluders;
pub use page::Page;
#[cfg(feature = "png")]
pub use png::{PngError, to_png};
pub use segments::{LineClass, LineOptions, Segment, Segments};
#[cfg(feature = "svg")]
pub use svg::to_svg;
pub use trace::{Run, VisibilityParams};
