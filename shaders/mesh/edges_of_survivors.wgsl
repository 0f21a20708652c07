// Tests some edges of the survivors that the task workgroup has listed, an edge a lane in each round.

@mesh(output) @payload(payload) @workgroup_size(MESH_WIDTH)
fn edges_of_survivors(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) {
    begin_emitting(lane);
    for (var first = 0u; first < EDGES_PER_WORKGROUP; first += MESH_WIDTH) {
        let place = workgroup.x * EDGES_PER_WORKGROUP + first + lane.index;
        var edge = 0u;
        var placement = 0u;
        var is_hit = false;
        if place < payload.edge_count {
            let survivor = survivor_of(place);
            edge = payload.edge_offsets[survivor] + place;
            placement = payload.placements[survivor];
            is_hit = is_contour(planes[edge], viewpoints[placement]);
        }
        emit(is_hit, edge, placement, lane);
    }
    end_emitting(lane);
}

// The first survivor whose edges end after `place`, one of them.
fn survivor_of(place: u32) -> u32 {
    var low = 0u;
    var high = payload.survivor_count - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if payload.edge_ends[middle] <= place {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}
