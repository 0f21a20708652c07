// From segments to where they are: both ends, in the space of the scene.

// Twin of src/layout.rs, PlacedSegment.
struct PlacedSegment {
    from_position: vec3f,
    placement: u32,
    to_position: vec3f,
    edge: u32,
}

@group(0) @binding(0) var<storage, read> segments: array<Segment>;
@group(0) @binding(1) var<storage, read> arguments: Arguments;
// Three numbers a vertex.
@group(0) @binding(2) var<storage, read> positions: array<f32>;
@group(0) @binding(3) var<storage, read> transforms: array<Transform>;
@group(0) @binding(4) var<storage, read_write> placed_segments: array<PlacedSegment>;

fn position(vertex: u32) -> vec3f {
    return vec3f(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

@compute @workgroup_size(SEGMENTS_PER_WORKGROUP)
fn place_segments(
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
) {
    let index = (workgroup.x + workgroup.y * workgroups.x) * SEGMENTS_PER_WORKGROUP + lane;
    if index < arguments.workgroups.w {
        let segment = segments[index];
        let transform = transforms[segment.placement];
        placed_segments[index] = PlacedSegment(
            transformed(transform, position(segment.from_vertex)),
            segment.placement,
            transformed(transform, position(segment.to_vertex)),
            segment.edge,
        );
    }
}
