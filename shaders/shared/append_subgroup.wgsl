// Appends contour edges to the segments: one atomic operation for each subgroup that has any.

struct Lane {
    @builtin(local_invocation_index) index: u32,
    @builtin(subgroup_invocation_id) in_subgroup: u32,
}

fn begin_appending(lane: Lane) {}

// By all lanes of the workgroup at once, those without a contour edge too.
fn append(is_hit: bool, edge: u32, placement: u32, lane: Lane) {
    let hit_count = subgroupAdd(u32(is_hit));
    let place = subgroupExclusiveAdd(u32(is_hit));
    var first = 0u;
    // One of the active lanes.
    let is_elected = lane.in_subgroup == subgroupBroadcastFirst(lane.in_subgroup);
    if is_elected && hit_count > 0u {
        first = counters.first_segment + atomicAdd(&counters.segments, hit_count);
    }
    first = subgroupBroadcastFirst(first);
    if is_hit {
        write_segment(first + place, edge, placement);
    }
}

fn end_appending(lane: Lane) {}
