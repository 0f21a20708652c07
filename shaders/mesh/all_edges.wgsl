// Brute force, without a task shader: edges of all instances are numbered through, an edge a lane in each round.

@mesh(output) @workgroup_size(MESH_WIDTH)
fn all_edges(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) {
    let number = workgroup_number(workgroup);
    begin_emitting(lane);
    for (var first = 0u; first < EDGES_PER_WORKGROUP; first += MESH_WIDTH) {
        let item = number * EDGES_PER_WORKGROUP + first + lane.index;
        let edge = work.first_item + item % work.item_count;
        let instance = work.first_instance + item / work.item_count;
        let placement = placement_of(instance, work.part);
        var is_hit = false;
        if item < work.item_count * work.instance_count {
            is_hit = is_contour(planes[edge], viewpoints[placement]);
        }
        emit(is_hit, edge, placement, lane);
    }
    end_emitting(lane);
}
