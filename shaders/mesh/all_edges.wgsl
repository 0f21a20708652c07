// Brute force, without a task shader: a lane for each edge of each instance.

@mesh(output) @workgroup_size(EDGES_PER_WORKGROUP)
fn all_edges(
    lane: Lane,
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
) {
    let item = workgroup_number(workgroup, workgroups) * EDGES_PER_WORKGROUP + lane.index;
    let edge = work.first_item + item % work.item_count;
    let instance = work.first_instance + item / work.item_count;
    let placement = instance * work.part_count + work.part;
    var is_hit = false;
    if item < work.item_count * work.instance_count {
        is_hit = is_contour(planes[edge], viewpoints[placement]);
    }
    emit(is_hit, edge, placement, lane);
}
