// Tests every edge of one part: a workgroup takes some thousand edges of one instance.

@compute @workgroup_size(WIDTH)
fn brute_force(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) {
    let number = workgroup_number(workgroup);
    let blocks = blocks_per_instance();
    if number >= blocks * work.instance_count {
        return;
    }
    begin_appending(lane);
    let instance = work.first_instance + number / blocks;
    let placement = placement_of(instance, work.part);
    let viewpoint = viewpoints[placement];
    let first = (number % blocks) * work.items_per_workgroup;
    let end = min(first + work.items_per_workgroup, work.item_count);
    for (var i = first; i < end; i += WIDTH) {
        let edge = work.first_item + i + lane.index;
        var is_hit = false;
        if i + lane.index < end {
            is_hit = is_contour(planes[edge], viewpoint);
        }
        append(is_hit, edge, placement, lane);
    }
    end_appending(lane);
    if lane.index == 0u {
        atomicAdd(&counters.edges_tested, end - first);
    }
}
