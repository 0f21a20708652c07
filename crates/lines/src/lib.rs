//! From the edges of a mesh to a drawing: chains, hidden-line removal, SVG and PNG.
//!
#![cfg_attr(all(feature = "visibility", feature = "svg"), doc = "```")]
#![cfg_attr(not(all(feature = "visibility", feature = "svg")), doc = "```ignore")]
//! use drypoint_lines::{
//!     Camera, Drawing, LineOptions, Occluders, Page, Segments, Style, VisibilityParams, to_svg,
//! };
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, contour_edges, shapes};
//! use glam::DVec3;
//!
//! let mesh = shapes::torus_knot(5000);
//! let adjacency = MeshAdjacency::new(&mesh);
//!
//! // A page, and the nearest view from that direction that just fills it.
//! let page = Page { width: 800, height: 600, margin: 20.0 };
//! let points = mesh.positions().iter().map(|p| p.as_dvec3());
//! let camera = Camera::fit_perspective(points, DVec3::ONE, None, 30.0, page)?;
//!
//! // Which edges to draw: the contours of this view, and sharp creases.
//! let mut contours = Vec::new();
//! contour_edges(&mesh, &adjacency, camera.viewpoint(), EdgeFilter::Convex, &mut contours);
//! let options =
//!     LineOptions { boundary: true, crease_angle: Some(0.5), ..Default::default() };
//! let segments = Segments::new(&mesh, &adjacency, &contours, &options);
//!
//! // What of them is visible. The occluders serve any number of views.
//! let occluders = Occluders::new(&mesh, &adjacency);
//! let drawing = Drawing::new(&occluders, &segments, &camera, &VisibilityParams::default());
//!
//! let svg = to_svg(&drawing, &Style::default(), "torus knot");
//! assert!(svg.contains(r#"<g class="contour""#));
//! # Ok::<(), drypoint_lines::CameraError>(())
//! ```
//!
//! Nothing is read, written or printed here: an SVG is a `String`, a PNG a `Vec<u8>`.
//!
//! # The steps
//!
//! 1. A [`Camera`] is a viewpoint with a lens and a [`Page`]. It is placed by hand, or fitted to
//!    points exactly. Its [`Camera::viewpoint`] is what contours are extracted for.
//! 2. [`Segments`] sorts lines by why they are drawn ([`LineClass`]), each once: edges, and the
//!    [`Intersections`] of surfaces, which are found once for all views.
//! 3. [`chain`] joins them into polylines at equal ends.
//! 4. [`Occluders`] finds what is in front of a point, [`Drawing`] walks every chain at steps of a
//!    pixel and finds the ends of its visible [`Run`]s by bisection. All in f64, with exact
//!    predicates where the surface is near: a line never hides behind its own faces, and there is
//!    no offset to choose.
//! 5. Where lines are to be told apart, [`Drawing::label`] says which part and which material each
//!    belongs to; where faces are, [`tinted_areas`] finds what of them is visible.
//! 6. [`to_svg`] and [`to_png`] ink areas and runs in a [`Style`].
//!
//! The same input gives the same output, to the byte.
//!
//! # Which contours to pass
//!
//! Concave contour edges of a closed mesh are always hidden, and [`EdgeFilter::Convex`] saves them.
//! Where a surface is seen from behind, because it is open, inside out, or its faces disagree, what
//! is concave from the front is convex from behind: pass the contours of [`EdgeFilter::All`] there,
//! or lines go missing. [`filter_for_drawing`] chooses.
//!
//! # Features
//!
//! All are on by default. Without `visibility` there is [`Drawing::through_glass`].
//!
//! - `visibility`: [`Occluders`], [`Drawing::new`], [`Intersections::new`], [`tinted_areas`] (crates
//!   `foldhash`, `obvhs`, `rayon` and `robust`).
//! - `svg`: [`to_svg`] (crate `svg`).
//! - `png`: [`to_png`] (crate `tiny-skia`).
//!
//! [`EdgeFilter::Convex`]: drypoint_mesh::EdgeFilter::Convex
//! [`EdgeFilter::All`]: drypoint_mesh::EdgeFilter::All

#[cfg(feature = "visibility")]
mod areas;
mod camera;
mod camera_error;
mod chain;
mod class;
mod color;
mod disjoint;
mod drawing;
mod face_names;
mod filter;
mod fit;
#[cfg(feature = "visibility")]
mod hierarchy;
mod intersections;
mod labels;
#[cfg(feature = "visibility")]
mod occluders;
mod page;
#[cfg(feature = "png")]
mod png;
#[cfg(feature = "visibility")]
mod rings;
mod segments;
mod specks;
#[cfg(feature = "svg")]
mod svg;
mod trace;

#[cfg(feature = "visibility")]
pub use areas::tinted_areas;
pub use camera::Camera;
pub use camera_error::CameraError;
pub use chain::{Chain, chain};
pub use class::{LineClass, LineOptions};
pub use color::Color;
pub use drawing::{Area, Drawing, HiddenLines, Layer, Style, Tint};
pub use face_names::FaceNames;
pub use filter::filter_for_drawing;
pub use intersections::Intersections;
pub use labels::Label;
#[cfg(feature = "visibility")]
pub use occluders::Occluders;
pub use page::Page;
#[cfg(feature = "png")]
pub use png::{PngError, to_png};
pub use segments::{Segment, Segments};
#[cfg(feature = "svg")]
pub use svg::to_svg;
pub use trace::{Run, VisibilityParams};
