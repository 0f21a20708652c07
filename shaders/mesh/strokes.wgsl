// Contour edges as strokes, two triangles each.

const VERTICES_PER_EDGE: u32 = 4u;
const PRIMITIVES_PER_EDGE: u32 = 2u;

@group(2) @binding(1) var<uniform> raster: Raster;
@group(2) @binding(2) var depth: texture_depth_2d;

struct StrokeTriangle {
    @builtin(triangle_indices) vertices: vec3u,
    @per_primitive @location(2) @interpolate(flat) edge: u32,
    @per_primitive @location(3) @interpolate(flat) edge_class: u32,
}

struct Output {
    @builtin(vertices) vertices: array<StrokeVertex, 4u * EDGES_PER_WORKGROUP>,
    @builtin(primitives) primitives: array<StrokeTriangle, 2u * EDGES_PER_WORKGROUP>,
    @builtin(vertex_count) vertex_count: u32,
    @builtin(primitive_count) primitive_count: u32,
}

var<workgroup> output: Output;

fn emit_edge(place: u32, edge: u32, placement: u32) {
    let found = ends[edge];
    let segment = Segment(found.from_vertex, found.to_vertex, placement, found.edge);
    let first = 4u * place;
    for (var corner = 0u; corner < 4u; corner++) {
        output.vertices[first + corner] = stroke_corner(segment, corner);
    }
    let corners = vec3u(first, first + 1u, first + 2u);
    output.primitives[2u * place] = StrokeTriangle(corners, found.edge, found.edge_class);
    let others = vec3u(first + 2u, first + 1u, first + 3u);
    output.primitives[2u * place + 1u] = StrokeTriangle(others, found.edge, found.edge_class);
}
