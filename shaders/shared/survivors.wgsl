// From patches that are not culled to their edges: all lanes share the edges of all survivors evenly,
// however many each has.

@group(0) @binding(2) var<storage, read> patches: array<Group>;

// Patches that survive, in any order: the end of each one's edges among those of all ...
var<workgroup> edge_ends: array<u32, WIDTH>;
// ... and what leads from a place there to the edge. Wraps around.
var<workgroup> edge_offsets: array<u32, WIDTH>;
var<workgroup> edge_placements: array<u32, WIDTH>;
// Edges of the survivors so far, times 512, and the number of these: one atomic operation for both, so that their
// edges follow one another in the order of the survivors. At most 256 lanes, each with 256 edges.
var<workgroup> taken: atomic<u32>;
var<workgroup> all_taken: u32;
var<workgroup> patches_tested: atomic<u32>;
var<workgroup> patches_accepted: atomic<u32>;

// By all lanes, first of all.
fn begin_patches(lane: Lane) {
    if lane.index == 0u {
        atomicStore(&taken, 0u);
        atomicStore(&patches_tested, 0u);
        atomicStore(&patches_accepted, 0u);
    }
    begin_appending(lane);
}

// Tests a patch, and lists it if it survives. By no more than all lanes, once before each `test_edges`.
fn test_patch(index: u32, instance: u32) {
    let group = patches[index];
    let placement = placement_of(instance, group.part);
    atomicAdd(&patches_tested, group.weight);
    if may_hold_contour(group.bound, viewpoints[placement]) {
        atomicAdd(&patches_accepted, group.weight);
        let before = atomicAdd(&taken, 512u * group.count + 1u);
        let survivor = before % 512u;
        edge_ends[survivor] = before / 512u + group.count;
        edge_offsets[survivor] = group.first - before / 512u;
        edge_placements[survivor] = placement;
    }
}

// Tests the edges of the survivors that are listed, and begins a new list. By all lanes at once.
fn test_edges(lane: Lane) {
    workgroupBarrier();
    if lane.index == 0u {
        all_taken = atomicLoad(&taken);
        atomicStore(&taken, 0u);
        atomicAdd(&counters.edges_tested, all_taken / 512u);
    }
    let all = workgroupUniformLoad(&all_taken);
    for (var first = 0u; first < all / 512u; first += WIDTH) {
        let place = first + lane.index;
        var edge = 0u;
        var placement = 0u;
        var is_hit = false;
        if place < all / 512u {
            let survivor = survivor_of(place, all % 512u);
            edge = edge_offsets[survivor] + place;
            placement = edge_placements[survivor];
            is_hit = is_contour(planes[edge], viewpoints[placement]);
        }
        append(is_hit, edge, placement, lane);
    }
    workgroupBarrier();
}

// The first of `count` survivors whose edges end after `place`.
fn survivor_of(place: u32, count: u32) -> u32 {
    var low = 0u;
    var high = count - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if edge_ends[middle] <= place {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
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
