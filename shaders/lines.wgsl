// Draws segments as strokes, a strip of four vertices each.

@group(0) @binding(0) var<uniform> stroke: Stroke;
@group(1) @binding(0) var<uniform> raster: Raster;
@group(1) @binding(1) var depth: texture_depth_2d;
@group(2) @binding(0) var<storage, read> segments: array<Segment>;
// Three numbers a vertex.
@group(2) @binding(1) var<storage, read> positions: array<f32>;
@group(2) @binding(2) var<storage, read> transforms: array<Transform>;

@vertex
fn stroke_vertex(
    @builtin(vertex_index) corner: u32,
    @builtin(instance_index) index: u32,
) -> StrokeVertex {
    return stroke_corner(segments[index], corner);
}
