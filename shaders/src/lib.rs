//! What a GPU runs and reads to find contour edges: WGSL, the structs in its buffers, and how a
//! [`PatchSet`](drypoint_fusion::PatchSet) becomes these.
//!
//! No GPU API is in sight: `drypoint-wgpu` and others hand this to a device. Each source is complete,
//! valid under the limits of plain WebGPU, and made by concatenating files of this crate, of which
//! `shared/contour.wgsl` holds the tests of patches and edges as pure functions without bindings.
//!
//! - Every struct that a shader reads is here, with the same layout; tests compare both through naga.
//! - Arithmetic is f32, in a [`Frame`] of the mesh's own: whatever its size and wherever it lies. What
//!   that costs in accuracy is a stated margin ([`EdgePlanes::doubt`]).
//!
//! ```
//! use drypoint_fusion::{FusionParams, fuse};
//! use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, shapes};
//! use drypoint_shaders::Content;
//! use std::ops::ControlFlow;
//!
//! let mesh = shapes::icosphere(500);
//! let adjacency = MeshAdjacency::new(&mesh);
//! let go_on = |_| ControlFlow::Continue(());
//! let set = fuse(&mesh, &adjacency, EdgeFilter::All, &FusionParams::FAST, &go_on).unwrap();
//!
//! let content = Content::new(&[&set]);
//! let viewpoint = content.frames[0].viewpoint(Viewpoint::at(glam::DVec3::new(0.0, 2.0, 9.0)));
//! let contours = content.planes.iter().filter(|edge| edge.is_contour(viewpoint)).count();
//! assert!(0 < contours && contours < content.planes.len());
//! ```

mod content;
mod draw_plan;
mod edge;
mod frame;
mod layout;
mod mesh_sources;
mod placement;
mod plan;
mod rig;
mod sources;
mod statistics;
mod style;
mod triangles;

pub use content::{Chunk, Content, ContentEdge, MAX_GROUP, MAX_PIECE};
pub use draw_plan::{Draw, DrawLimits, DrawPlan};
pub use edge::{EdgeEnds, EdgePlanes};
pub use frame::Frame;
pub use layout::{
    Arguments, Counters, DrawCounters, Group, Part, PlacedSegment, ROW, Raster,
    SEGMENTS_PER_WORKGROUP, Segment, Stroke, Totals, Transform, Work,
};
pub use mesh_sources::{BLOCK_PATCHES, Culling, Emitted, MeshShape, mesh_source};
pub use placement::{Placement, place};
pub use plan::{Dispatch, Method, Plan, PlanLimits, Stage};
pub use rig::{
    BendingFace, CarrierTransform, ClassLayout, LooseEdge, MorphOffset, PartFace, PoseError,
    RigContent, RigCounts, RigDispatch, RigInput, RigInstance, RigLayout, RigPlan, RigStep,
    VertexInfluence,
};
pub use sources::{
    BRUTE_FORCE, CONTOUR, DEPTH, INK, LINES, PATCHES, POSITIONS, RIG_EDGES, RIG_FACES,
    RIG_VERTICES, SUPER_PATCHES, TALLY, THIN_LINES, USUAL_WIDTH, WIDTHS, prelude,
};
pub use statistics::Statistics;
pub use style::{DepthOrder, LineStyle, View, divide_by_alpha};
pub use triangles::{TrianglePart, Triangles};
