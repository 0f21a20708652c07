// From patches that are not culled to mesh workgroups: a task workgroup lists its survivors in the payload
// and launches as many mesh workgroups as their edges fill. These share the edges of all survivors evenly,
// so that small patches come together in one workgroup and none is launched for nothing.
//
// Tsiapkolis and Bénard (CGF 2024, §4.4) launch a mesh workgroup for each patch.

// Survivors of a task workgroup, for its mesh workgroups.
struct Payload {
    survivor_count: u32,
    edge_count: u32,
    // The end of each survivor's edges among those of all ...
    edge_ends: array<u32, SLOTS>,
    // ... and what leads from a place there to the edge. Wraps around.
    edge_offsets: array<u32, SLOTS>,
    placements: array<u32, SLOTS>,
}

@group(0) @binding(2) var<storage, read> patches: array<Group>;

var<task_payload> payload: Payload;

// Edges of the survivors so far, times 256, and the number of these: one atomic operation for both, so that
// their edges follow one another in the order of the payload.
var<workgroup> taken: atomic<u32>;
var<workgroup> patches_tested: atomic<u32>;
var<workgroup> patches_accepted: atomic<u32>;

// By all lanes, first of all.
fn begin_tasks(lane: Lane) {
    if lane.index == 0u {
        atomicStore(&taken, 0u);
        atomicStore(&patches_tested, 0u);
        atomicStore(&patches_accepted, 0u);
    }
    workgroupBarrier();
}

// Tests a patch and puts it into the payload if it survives. By all lanes at once, those without a patch too.
fn test_patch(is_patch: bool, index: u32, instance: u32, lane: Lane) {
    var first = 0u;
    var count = 0u;
    var placement = 0u;
    if is_patch {
        let group = patches[index];
        placement = placement_of(instance, group.part);
        first = group.first;
        atomicAdd(&patches_tested, group.weight);
        if may_hold_contour(group.bound, viewpoints[placement]) {
            count = group.count;
            atomicAdd(&patches_accepted, group.weight);
        }
    }
    let share = select(0u, 256u * count + 1u, count > 0u);
    let before = subgroupExclusiveAdd(share);
    let all = subgroupAdd(share);
    var base = 0u;
    if is_elected(lane) && all > 0u {
        base = atomicAdd(&taken, all);
    }
    base = subgroupBroadcastFirst(base) + before;
    if count > 0u {
        let slot = base % 256u;
        let begin = base / 256u;
        payload.edge_ends[slot] = begin + count;
        payload.edge_offsets[slot] = first - begin;
        payload.placements[slot] = placement;
    }
}

// The mesh workgroups that survivors need. By all lanes, last of all.
fn launch(lane: Lane) -> vec3u {
    workgroupBarrier();
    let all = atomicLoad(&taken);
    let edge_count = all / 256u;
    let mesh_workgroups = (edge_count + EDGES_PER_WORKGROUP - 1u) / EDGES_PER_WORKGROUP;
    if lane.index == 0u {
        payload.survivor_count = all % 256u;
        payload.edge_count = edge_count;
        atomicAdd(&counters.patches_tested, atomicLoad(&patches_tested));
        if mesh_workgroups > 0u {
            atomicAdd(&counters.patches_accepted, atomicLoad(&patches_accepted));
            atomicAdd(&counters.groups_accepted, all % 256u);
            atomicAdd(&counters.edges_tested, edge_count);
            atomicAdd(&counters.mesh_workgroups, mesh_workgroups);
        }
    }
    return vec3u(mesh_workgroups, 1u, 1u);
}
