//! What a program that was built without GPU code says.

use drypoint_cpu::Statistics;
use drypoint_fusion::PatchSet;
use drypoint_lines::Style;
use drypoint_mesh::{EdgeId, Viewpoint};

use crate::draw::Scene;
use crate::gpu::Api;

pub(crate) fn draw(
    api: Api,
    _: &Scene<'_>,
    _: Option<&PatchSet>,
    _: &Style,
) -> Result<Vec<u8>, String> {
    Err(api.refusal())
}

pub(crate) fn extract(
    api: Api,
    _: &PatchSet,
    _: Viewpoint,
    _: &mut Vec<EdgeId>,
) -> Result<Statistics, String> {
    Err(api.refusal())
}
