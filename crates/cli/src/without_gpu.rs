//! What a program that was built without GPU code says.

use drypoint_cpu::Statistics;
use drypoint_fusion::PatchSet;
use drypoint_lines::{Camera, Style};
use drypoint_mesh::{EdgeId, MeshAdjacency, Viewpoint};

use crate::args::DrawArgs;
use crate::source::Source;

const REFUSAL: &str = "--method wgpu: this program was built without the feature wgpu";

pub(crate) fn check(_: &DrawArgs) -> Result<(), String> {
    Err(REFUSAL.to_owned())
}

pub(crate) fn draw(
    _: &Source,
    _: &MeshAdjacency,
    _: Option<&PatchSet>,
    _: &Camera,
    _: &Style,
) -> Result<Vec<u8>, String> {
    Err(REFUSAL.to_owned())
}

pub(crate) fn extract(
    _: &PatchSet,
    _: Viewpoint,
    _: &mut Vec<EdgeId>,
) -> Result<Statistics, String> {
    Err(REFUSAL.to_owned())
}
