//! Contour edges of many instances of meshes, found and drawn in one pass by Vulkan's task and mesh shaders, with
//! [`ash`].
//!
//! A task shader tests a patch in each lane and lists those that may hold a contour edge; it launches as many mesh
//! workgroups as their edges fill, and none if there are none. A mesh shader tests an edge in each lane, and emits
//! the contour edges and nothing else. There is no list of contour edges in memory, no counter to wait for, and no
//! indirect draw. This is the second pipeline of Tsiapkolis and Bénard (CGF 2024, §4.4), without what made it
//! slow: mesh workgroups for culled patches, and primitives for edges that are no contours.
//!
//! - **Complete.** The edges that `drypoint-wgpu` finds: those of the exact definition,
//!   [`drypoint_mesh::contour_edges`], but for edges with a face so close to edge-on that f32 cannot tell its side
//!   ([`EdgePlanes::doubt`](drypoint_shaders::EdgePlanes::doubt)).
//! - **Counted.** [`FoundByMesh::statistics`] tells how many mesh workgroups were launched and how many of them
//!   were idle; [`Queries`] ask the device itself.
//! - **Safe.** Whoever has a Vulkan device, a command buffer and rendering of their own says so in `unsafe` calls,
//!   [`Device::from_raw`], [`Commands::from_raw`], [`Commands::in_rendering`] and [`Recorded::assume_executed`], which
//!   state what they rely on. All else is checked: what
//!   commands use lives until they have executed ([`Recorded`]), and what they download can be read only then
//!   ([`Executed`]).
//! - **No panics.** No driver, no mesh shaders, no memory, a lost device: an [`Error`].
//!
//! | | for |
//! |---|---|
//! | [`Gpu`] | a device and a queue, for programs without one |
//! | [`Device`], [`Commands`], [`Rendering`] | the caller's device and command buffer |
//! | [`Model`] | a mesh and its patches, or a rigged one's rigid parts |
//! | [`MeshPass`], [`MeshContours`] | task and mesh shaders, and what they find and draw of one model |
//! | [`Extractor`], [`Contours`], [`LinePass`] | the same in two passes, by compute shaders and an indirect draw |
//! | [`Canvas`], [`Surface`] | strokes of either, hidden by surfaces |
//! | [`Offscreen`], [`Picture`] | lines and strokes that no window shows |
//! | [`Queries`], [`Timer`] | invocations, primitives and time, as the device counts them |
//!
//! In a frame: [`MeshContours::prepare`] and [`MeshPass::prepare`]; then rendering, of [`Offscreen::render`] or begun by
//! the caller and taken by [`Commands::in_rendering`], and in it [`MeshPass::record`]; then, if anything is to be read,
//! [`MeshContours::download`]. With a command buffer of one's own, [`Commands::from_raw`] comes first and
//! [`Commands::finish`] last; what that gives is kept until a fence tells that the commands have executed, and its
//! [`Recorded::assume_executed`] is what downloads are read with. Input lies in the command buffer, so that any number
//! of frames may be under way.
//!
//! Vulkan 1.3 with `VK_EXT_mesh_shader` and dynamic rendering is needed, and subgroup operations in task and
//! mesh shaders: see [`RequiredFeatures`]. Shaders are the WGSL of `drypoint-shaders`, compiled to SPIR-V by naga
//! when a pipeline is made.
//!
//! A device of `wgpu` on Vulkan will do, if it was opened with these features (`open_with_callback` of
//! wgpu-hal's adapter): its handles go to [`Device::from_raw`], and that of one of its command encoders, in
//! which nothing else is recorded, to [`Commands::from_raw`]. The test `beside_wgpu` shows how.
//!
//! ```no_run
//! use drypoint_ash::{Capacity, Gpu, MeshContours, MeshOptions, MeshPass, Method, Model, Placement};
//! use drypoint_fusion::{FusionParams, fuse};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use std::ops::ControlFlow;
//!
//! # fn main() -> Result<(), drypoint_ash::Error> {
//! let mesh = shapes::torus_knot(20_000);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let go_on = |_| ControlFlow::Continue(());
//! let patches = fuse(&mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &go_on).unwrap();
//!
//! let gpu = Gpu::request()?;
//! // Draws nothing, and writes segments to a buffer.
//! let pass = MeshPass::new(gpu.device(), &MeshOptions::default())?;
//! let placement = Placement::at_origin(Viewpoint::at(glam::DVec3::new(0.0, 2.0, 9.0)));
//! let (found, executed) = gpu.run(|commands| {
//!     let model = Model::new(commands, &[&patches])?;
//!     let capacity = Capacity { placements: 1, segments: 10_000 };
//!     let mut contours = MeshContours::new(&pass, &model, capacity)?;
//!     contours.prepare(commands, &[placement], Method::Patches)?;
//!     pass.extract(commands, &contours)?;
//!     contours.download(commands)
//! })?;
//! println!("{} contour edges", found.segments(&executed)?.len());
//! # Ok(())
//! # }
//! ```
#![allow(unsafe_code, reason = "handles of Vulkan are raw; each block says what it relies on")]

mod barrier;
mod binding;
mod canvas;
mod commands;
mod contours;
mod depth_pass;
mod device;
mod error;
mod execution;
mod extractor;
mod gpu;
mod input;
mod instance;
mod layouts;
mod line_pass;
mod look;
mod memory;
mod mesh_contours;
mod mesh_pass;
mod model;
mod offscreen;
mod picture;
mod pipeline;
mod queries;
mod rendering;
mod shader;

pub use canvas::{Canvas, Subject};
pub use commands::Commands;
pub use contours::{Capacity, Contours, CountedByCompute, FoundByCompute};
pub use depth_pass::{Found, Surface};
pub use device::{Device, Limits, OptionalFeatures, REQUIRED_EXTENSIONS, RequiredFeatures};
pub use drypoint_shaders::{DepthOrder, LineStyle, Method, Placement, Segment, Statistics, View};
pub use error::Error;
pub use execution::{Executed, Recorded};
pub use extractor::Extractor;
pub use gpu::{Gpu, GpuOptions, Listener};
pub use line_pass::LinePass;
pub use mesh_contours::{FoundByMesh, MeshContours, MeshStatistics};
pub use mesh_pass::{Attached, MeshOptions, MeshOutput, MeshPass};
pub use model::Model;
pub use offscreen::{Offscreen, Pixels};
pub use picture::Picture;
pub use queries::{Counting, Counts, Queries, Timer};
pub use rendering::{Attachments, Rendering};
