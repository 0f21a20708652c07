// Contour edges as lines one pixel wide.

const VERTICES_PER_EDGE: u32 = 2u;
const PRIMITIVES_PER_EDGE: u32 = 1u;

struct LineVertex {
    @builtin(position) position: vec4f,
}

struct Line {
    @builtin(line_indices) vertices: vec2u,
    @per_primitive @location(0) @interpolate(flat) edge: u32,
    @per_primitive @location(1) @interpolate(flat) edge_class: u32,
}

struct Output {
    @builtin(vertices) vertices: array<LineVertex, 2u * EDGES_PER_WORKGROUP>,
    @builtin(primitives) primitives: array<Line, EDGES_PER_WORKGROUP>,
    @builtin(vertex_count) vertex_count: u32,
    @builtin(primitive_count) primitive_count: u32,
}

var<workgroup> output: Output;

fn emit_edge(place: u32, edge: u32, placement: u32) {
    let found = ends[edge];
    output.vertices[2u * place].position = position_in_clip(found.from_vertex, placement);
    output.vertices[2u * place + 1u].position = position_in_clip(found.to_vertex, placement);
    output.primitives[place] = Line(vec2u(2u * place, 2u * place + 1u), found.edge, found.edge_class);
}
