// Faces in the colors of their patches, a little darker where they are turned away.

// Rows of an affine map, as drypoint-shaders has it.
struct Transform {
    x: vec4f,
    y: vec4f,
    z: vec4f,
}

struct Shaded {
    @builtin(position) position: vec4f,
    @location(0) in_scene: vec3f,
    @location(1) @interpolate(flat) color: vec4f,
}

@group(0) @binding(0) var<uniform> scene_to_clip: mat4x4f;
@group(0) @binding(1) var<storage, read> transforms: array<Transform>;

@vertex
fn place(
    @location(0) position: vec3f,
    @location(1) color: vec4f,
    @builtin(instance_index) instance: u32,
) -> Shaded {
    let transform = transforms[instance];
    let p = vec4f(position, 1.0);
    let in_scene = vec3f(dot(transform.x, p), dot(transform.y, p), dot(transform.z, p));
    return Shaded(scene_to_clip * vec4f(in_scene, 1.0), in_scene, color);
}

@fragment
fn shade(shaded: Shaded) -> @location(0) vec4f {
    let normal = normalize(cross(dpdx(shaded.in_scene), dpdy(shaded.in_scene)));
    let light = 0.7 + 0.3 * abs(dot(normal, normalize(vec3f(0.4, 0.8, 0.5))));
    return vec4f(shaded.color.rgb * light, 1.0);
}
