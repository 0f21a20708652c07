// Segments as lines one pixel wide: two vertices each. Behind positions.wgsl, whose bindings it reads.

@vertex
fn end_of_segment(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let segment = segments[index / 2u];
    let vertex = select(segment.from_vertex, segment.to_vertex, index % 2u == 1u);
    return vec4f(transformed(transforms[segment.placement], position(vertex)), 1.0);
}

@fragment
fn ink() -> @location(0) vec4f {
    return vec4f(0.0, 0.0, 0.0, 1.0);
}
