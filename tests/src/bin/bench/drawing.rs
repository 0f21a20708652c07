//! One drawing, stage by stage.

use std::hint::black_box;
use std::time::Instant;

use drypoint_lines::{
    Camera, Drawing, LineOptions, Occluders, Page, Segments, Style, VisibilityParams,
    filter_for_drawing, to_svg,
};
use drypoint_mesh::{Mesh, MeshAdjacency, contour_edges};
use glam::DVec3;

/// Seconds of each stage, as `drypoint draw` goes through them.
pub(crate) fn measure(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
) -> Result<Vec<(String, f64)>, String> {
    let page = Page { width: 1000, height: 1000, margin: 40.0 };
    let points = mesh.positions().iter().map(|p| p.as_dvec3());
    let camera = Camera::fit_perspective(points, DVec3::ONE, None, 30.0, page)
        .map_err(|error| error.to_string())?;
    let mut lap = Instant::now();
    let mut seconds = || std::mem::replace(&mut lap, Instant::now()).elapsed().as_secs_f64();
    let mut contours = Vec::new();
    let filter = filter_for_drawing(mesh, adjacency, camera.viewpoint());
    contour_edges(mesh, adjacency, camera.viewpoint(), filter, &mut contours);
    let options = LineOptions { boundary: true, ..Default::default() };
    let segments = Segments::new(mesh, adjacency, &contours, &options);
    let extracted = seconds();
    let occluders = Occluders::new(mesh, adjacency);
    let sorted = seconds();
    let drawing = Drawing::new(&occluders, &segments, &camera, &VisibilityParams::default());
    let traced = seconds();
    black_box(to_svg(&drawing, &Style::default(), "bench"));
    let stages = [
        ("edges", extracted),
        ("tree of faces", sorted),
        ("visibility", traced),
        ("SVG", seconds()),
    ];
    Ok(stages.map(|(stage, seconds)| (stage.to_owned(), seconds)).to_vec())
}
