// What brute force cannot be faster than: reads the planes of all edges for each instance, and tests
// nothing. A workgroup takes as many as one of brute_force.wgsl does.

@group(0) @binding(0) var<storage, read> planes: array<EdgePlanes>;
@group(0) @binding(1) var<storage, read_write> never_written: vec4f;

@compute @workgroup_size(WIDTH)
fn read_planes(
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
) {
    let number = workgroup.x + workgroup.y * workgroups.x;
    let edge_count = arrayLength(&planes);
    let blocks = (edge_count + EDGES_PER_WORKGROUP - 1u) / EDGES_PER_WORKGROUP;
    let first = (number % blocks) * EDGES_PER_WORKGROUP;
    let end = min(first + EDGES_PER_WORKGROUP, edge_count);
    var sum = vec4f();
    for (var edge = first + lane; edge < end; edge += WIDTH) {
        sum += planes[edge].left + planes[edge].right;
    }
    // No sum of so few planes comes near, but a compiler does not know.
    if sum.x > 1e30 {
        never_written = sum;
    }
}
