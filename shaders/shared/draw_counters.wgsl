// What mesh shaders and the task shaders before them have in common.

// What is counted during one draw. Twin of src/layout.rs, DrawCounters.
struct DrawCounters {
    segments: atomic<u32>,
    edges_tested: atomic<u32>,
    patches_tested: atomic<u32>,
    patches_accepted: atomic<u32>,
    super_patches_tested: atomic<u32>,
    super_patches_accepted: atomic<u32>,
    // Survivors, further pieces of one and edges that no patch holds among them.
    groups_accepted: atomic<u32>,
    mesh_workgroups: atomic<u32>,
    // Those without a contour edge among their edges.
    idle_mesh_workgroups: atomic<u32>,
}

struct Lane {
    @builtin(local_invocation_index) index: u32,
    @builtin(subgroup_invocation_id) in_subgroup: u32,
}

// One of the active lanes of each subgroup.
fn is_elected(lane: Lane) -> bool {
    return lane.in_subgroup == subgroupBroadcastFirst(lane.in_subgroup);
}

@group(1) @binding(1) var<storage, read_write> counters: DrawCounters;
