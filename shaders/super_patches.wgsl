// Tests super-patches, then the patches of those that may hold a contour edge, then their edges.

@group(0) @binding(3) var<storage, read> super_patches: array<Group>;

// As edge_ends and edge_offsets, of patches.
var<workgroup> patch_ends: array<u32, WIDTH>;
var<workgroup> patch_offsets: array<u32, WIDTH>;
var<workgroup> patch_total: u32;
var<workgroup> super_patches_tested: atomic<u32>;
var<workgroup> super_patches_accepted: atomic<u32>;

@compute @workgroup_size(WIDTH)
fn super_patches_to_edges(
    lane: Lane,
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
) {
    let number = workgroup_number(workgroup, workgroups);
    let blocks = blocks_per_instance();
    if number >= blocks * work.instance_count {
        return;
    }
    if lane.index == 0u {
        atomicStore(&super_patches_tested, 0u);
        atomicStore(&super_patches_accepted, 0u);
    }
    begin_patches(lane);
    let instance = work.first_instance + number / blocks;
    let first = (number % blocks) * work.items_per_workgroup;
    let end = min(first + work.items_per_workgroup, work.item_count);
    // Once, but where the work was cut for wider workgroups.
    for (var i = first; i < end; i += WIDTH) {
        find_patches(i + lane.index, end, instance, lane);
        let total = workgroupUniformLoad(&patch_total);
        for (var first_place = 0u; first_place < total; first_place += WIDTH) {
            let place = first_place + lane.index;
            var survivor = Survivor(0u, 0u, 0u);
            if place < total {
                survivor = test_patch(patch_offsets[super_patch_of(place)] + place, instance);
            }
            test_edges(survivor, lane);
        }
    }
    end_patches(lane);
    if lane.index == 0u {
        atomicAdd(&counters.super_patches_tested, atomicLoad(&super_patches_tested));
        atomicAdd(&counters.super_patches_accepted, atomicLoad(&super_patches_accepted));
    }
}

// Lists the patches of the super-patches that survive, of one for each lane.
fn find_patches(place: u32, end: u32, instance: u32, lane: Lane) {
    var first_patch = 0u;
    var count = 0u;
    if place < end {
        let group = super_patches[work.first_item + place];
        atomicAdd(&super_patches_tested, group.weight);
        if may_hold_contour(group.bound, viewpoints[placement_of(instance, group.part)]) {
            first_patch = group.first;
            count = group.count;
            atomicAdd(&super_patches_accepted, group.weight);
        }
    }
    patch_ends[lane.index] = count;
    for (var step = 1u; step < WIDTH; step *= 2u) {
        workgroupBarrier();
        var before = 0u;
        if lane.index >= step {
            before = patch_ends[lane.index - step];
        }
        workgroupBarrier();
        patch_ends[lane.index] += before;
    }
    let patch_end = patch_ends[lane.index];
    patch_offsets[lane.index] = first_patch - (patch_end - count);
    if lane.index == WIDTH - 1u {
        patch_total = patch_end;
    }
}

// The first lane whose patches end after `place`.
fn super_patch_of(place: u32) -> u32 {
    var owner = 0u;
    for (var step = WIDTH / 2u; step > 0u; step /= 2u) {
        if patch_ends[owner + step - 1u] <= place {
            owner += step;
        }
    }
    return owner;
}
