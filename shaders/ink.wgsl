// Gives what strokes cover their color.

@group(0) @binding(0) var<uniform> stroke: Stroke;
@group(1) @binding(0) var coverage: texture_2d<f32>;

// One triangle that covers the screen.
@vertex
fn whole_screen(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    let is_far = vec2f(vec2u(corner & 1u, corner >> 1u));
    return vec4f(4.0 * is_far - 1.0, 0.5, 1.0);
}

@fragment
fn ink(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return stroke.color * textureLoad(coverage, vec2i(position.xy), 0).r;
}
