// From patches that are not culled to their edges: all lanes share the edges of all survivors evenly,
// however many each has.

@group(0) @binding(2) var<storage, read> patches: array<Group>;

// Each lane's patch, if it survives: the end of its edges among those of all survivors ...
var<workgroup> edge_ends: array<u32, WIDTH>;
// ... and what leads from a place there to the edge. Wraps around.
var<workgroup> edge_offsets: array<u32, WIDTH>;
var<workgroup> edge_placements: array<u32, WIDTH>;
var<workgroup> edge_total: u32;
var<workgroup> patches_tested: atomic<u32>;
var<workgroup> patches_accepted: atomic<u32>;

// A patch that a lane has tested. `count` is 0 if it is culled, or if the lane has none.
struct Survivor {
    first: u32,
    count: u32,
    placement: u32,
}

// By all lanes, first of all.
fn begin_patches(lane: Lane) {
    if lane.index == 0u {
        atomicStore(&patches_tested, 0u);
        atomicStore(&patches_accepted, 0u);
    }
    begin_appending(lane);
    workgroupBarrier();
}

fn test_patch(index: u32, instance: u32) -> Survivor {
    let group = patches[index];
    let placement = placement_of(instance, group.part);
    atomicAdd(&patches_tested, group.weight);
    if !may_hold_contour(group.bound, viewpoints[placement]) {
        return Survivor(0u, 0u, 0u);
    }
    atomicAdd(&patches_accepted, group.weight);
    return Survivor(group.first, group.count, placement);
}

// Tests the edges of the survivors of all lanes. By all lanes at once.
fn test_edges(survivor: Survivor, lane: Lane) {
    // A running sum (Hillis and Steele, Data Parallel Algorithms, CACM 1986).
    edge_ends[lane.index] = survivor.count;
    for (var step = 1u; step < WIDTH; step *= 2u) {
        workgroupBarrier();
        var before = 0u;
        if lane.index >= step {
            before = edge_ends[lane.index - step];
        }
        workgroupBarrier();
        edge_ends[lane.index] += before;
    }
    let end = edge_ends[lane.index];
    edge_offsets[lane.index] = survivor.first - (end - survivor.count);
    edge_placements[lane.index] = survivor.placement;
    if lane.index == WIDTH - 1u {
        edge_total = end;
        atomicAdd(&counters.edges_tested, end);
    }
    let total = workgroupUniformLoad(&edge_total);
    for (var first = 0u; first < total; first += WIDTH) {
        let place = first + lane.index;
        var edge = 0u;
        var placement = 0u;
        var is_hit = false;
        if place < total {
            let owner = owner_of(place);
            edge = edge_offsets[owner] + place;
            placement = edge_placements[owner];
            is_hit = is_contour(planes[edge], viewpoints[placement]);
        }
        append(is_hit, edge, placement, lane);
    }
    workgroupBarrier();
}

// The first lane whose edges end after `place`.
fn owner_of(place: u32) -> u32 {
    var owner = 0u;
    for (var step = WIDTH / 2u; step > 0u; step /= 2u) {
        if edge_ends[owner + step - 1u] <= place {
            owner += step;
        }
    }
    return owner;
}

// By all lanes, last of all.
fn end_patches(lane: Lane) {
    end_appending(lane);
    workgroupBarrier();
    if lane.index == 0u {
        atomicAdd(&counters.patches_tested, atomicLoad(&patches_tested));
        atomicAdd(&counters.patches_accepted, atomicLoad(&patches_accepted));
    }
}
