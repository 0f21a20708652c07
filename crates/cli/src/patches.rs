//! `drypoint patches`: build the asset and save it.

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_fusion::{FusionParams, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency};
use serde::Serialize;

use crate::args::{FusionArgs, PatchesArgs, SphereKind};
use crate::output::{Output, print_json};
use crate::progress::Stage;
use crate::source::Source;

/// What was built, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Built {
    edges: usize,
    patches: usize,
    /// In degrees.
    mean_half_angle: f64,
    /// In degrees.
    max_half_angle: f64,
    /// In the file's unit.
    mean_t: f64,
    /// In edge tests a view.
    expected_cost: f64,
    build_seconds: f64,
    /// In bytes; `null` where the system does not tell.
    peak_memory: Option<u64>,
}
