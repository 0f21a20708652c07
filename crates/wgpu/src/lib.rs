//! Contour edges of many instances of meshes, found on a GPU each frame, with [`wgpu`].
//!
//! A [`Model`] is uploaded once. Each frame, [`Contours::prepare`] takes the placement of each instance and
//! [`Extractor::record`] records into a compute pass of the caller's: every patch is tested from every
//! instance's viewpoint, and the edges of those that may hold a contour edge. What comes out stays on the
//! GPU: [`Segment`]s, and indirect arguments that draw them.
//!
//! - **Complete.** The edges of the exact definition, [`drypoint_mesh::contour_edges`], but for those with a
//!   face so close to edge-on that f32 cannot tell its side; the margin is stated
//!   ([`EdgePlanes::doubt`](drypoint_shaders::EdgePlanes::doubt)), and contours of closed meshes close all the same.
//! - **No surprises.** Nothing waits for the GPU but calls that say so. Buffers are made with [`Model`] and
//!   [`Contours`], at sizes that the caller chose. What does not fit is counted and reported
//!   ([`Statistics::overflow`]), and never written. Whatever exceeds a dispatch or a binding is split.
//! - **No panics.** No adapter, no memory, a lost device: an [`Error`].
//!
//! | | for |
//! |---|---|
//! | [`Gpu`] | a device, for programs without one |
//! | [`Extractor`] | pipelines; one for each device |
//! | [`Model`] | a mesh and its patches, or a rigged one's rigid parts |
//! | [`Contours`] | what is found of one model in a frame |
//! | [`RigModel`] | a model that moves: a [`Rig`](drypoint_mesh::rig::Rig) with patches of its rigid parts |
//! | [`RigContours`] | what is found of it in a frame, of many instances, each in a pose of its own |
//! | [`PlacedContours`] | the same as positions in the scene |
//! | [`DepthPass`], [`Surface`] | depths of the triangles that hide lines |
//! | [`LinePass`], [`Lines`], [`LineTarget`] | lines on the caller's picture |
//! | [`Picture`] | both, off screen |
//! | [`Timer`] | GPU time of a pass, a few frames later |
//!
//! Order is free: the same view gives the same set of segments, in any order.
//!
//! # Models that move
//!
//! A [`RigModel`] holds each shape once, however many rigid parts have it, so that an assembly of a thousand
//! screws takes the memory of one. For each instance, [`RigContours::prepare`] takes a
//! [`Pose`](drypoint_mesh::rig::Pose); patches are tested from the viewpoint as each part sees it, and what
//! bends is posed on the GPU: a lane for each vertex beside a loose edge, then one for each face, which decides
//! its side once for all of its edges, then one for each loose edge. All segments of all instances are in one
//! buffer with one set of arguments. [`Surface::of_rig`] draws the depths of the same vertices.
//!
//! What is found is what [`Skin::contour_edges`](drypoint_mesh::rig::Skin::contour_edges) defines, but for edges
//! with a face within the margin ([`RigLayout::doubtful_faces`]), which is wider for faces that bend, since f32
//! poses them: a sliver whose height is some millionths of the model's size may be seen from either side. A part
//! that its carrier flattens to a plane is seen as what it is flattened to; where it is flattened to a line or a
//! point, nothing is found of it, and the definition finds what rounding makes of it.
//!
//! ```no_run
//! use drypoint_fusion::{FusionParams, fuse};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use drypoint_wgpu::{Capacity, Contours, Extractor, Gpu, Method, Model, Placement};
//! use std::ops::ControlFlow;
//!
//! # fn main() -> Result<(), drypoint_wgpu::Error> {
//! let mesh = shapes::torus_knot(20_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let go_on = |_| ControlFlow::Continue(());
//! let patches = fuse(&mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &go_on).unwrap();
//!
//! let gpu = Gpu::request()?;
//! let extractor = Extractor::new(&gpu.device)?;
//! let model = Model::new(&extractor, &[&patches])?;
//! let mut contours = Contours::new(&extractor, &model, Capacity { placements: 1, segments: 10_000 })?;
//!
//! let viewpoint = Viewpoint::at(glam::DVec3::new(0.0, 2.0, 9.0));
//! let mut encoder = gpu.device.create_command_encoder(&Default::default());
//! contours.prepare(&mut encoder, &[Placement::at_origin(viewpoint)], Method::Patches)?;
//! extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
//! gpu.queue.submit([encoder.finish()]);
//! println!("{} contour edges", contours.read_segments(&gpu.queue)?.len());
//! # Ok(())
//! # }
//! ```

mod bindings;
mod contours;
mod depth_pass;
mod device;
mod error;
mod extractor;
mod found;
mod line_pass;
mod model;
mod output;
mod picture;
mod placed;
mod raster;
mod readback;
mod rig_contours;
mod rig_frame;
mod rig_model;
mod rig_pipelines;
mod staging;
mod timer;

pub use contours::{Capacity, Contours};
pub use depth_pass::{DepthPass, Surface};
pub use device::{Gpu, WANTED_FEATURES};
pub use drypoint_shaders::{
    Arguments, DepthOrder, LineStyle, Method, PlacedSegment, Placement, RigInstance, RigLayout,
    Segment, Statistics, View,
};
pub use error::Error;
pub use extractor::{Extractor, ExtractorOptions};
pub use found::Found;
pub use line_pass::{LinePass, LineTarget, Lines};
pub use model::Model;
pub use picture::{Picture, Subject};
pub use placed::PlacedContours;
pub use rig_contours::{RigCapacity, RigContours, RigEdge};
pub use rig_model::RigModel;
pub use timer::Timer;
