// Where vertices are on the screen, by the bindings of whoever draws.

fn position_in_clip(vertex: u32, placement: u32) -> vec4f {
    let position =
        vec3f(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
    return stroke.scene_to_clip * vec4f(transformed(transforms[placement], position), 1.0);
}
