// Draws segments as lines one pixel wide, two vertices each.

@group(0) @binding(0) var<uniform> stroke: Stroke;
@group(1) @binding(0) var<storage, read> segments: array<Segment>;
// Three numbers a vertex.
@group(1) @binding(1) var<storage, read> positions: array<f32>;
@group(1) @binding(2) var<storage, read> transforms: array<Transform>;

@vertex
fn line_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let segment = segments[index / 2u];
    let vertex = select(segment.from_vertex, segment.to_vertex, index % 2u == 1u);
    return position_in_clip(vertex, segment.placement);
}
