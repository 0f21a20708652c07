// Draws the triangles of one part, as often as it is placed, into a depth texture.

// Twin of src/layout.rs, Part.
struct Part {
    part: u32,
    part_count: u32,
    first_placement: u32,
}

@group(0) @binding(0) var<uniform> scene_to_clip: mat4x4f;
@group(1) @binding(0) var<uniform> part: Part;
@group(1) @binding(1) var<storage, read> transforms: array<Transform>;

@vertex
fn place_vertex(
    @location(0) position: vec3f,
    @builtin(instance_index) instance: u32,
) -> @builtin(position) vec4f {
    let transform = transforms[part.first_placement + instance * part.part_count + part.part];
    return scene_to_clip * vec4f(transformed(transform, position), 1.0);
}
