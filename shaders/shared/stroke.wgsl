// How segments are drawn.

// Twin of src/layout.rs, Stroke.
struct Stroke {
    scene_to_clip: mat4x4f,
    // Multiplied by its alpha.
    color: vec4f,
    // In pixels.
    half_width: f32,
}
