// Tests super-patches, then the patches of those that may hold a contour edge: a workgroup takes a block of
// super-patches whose patches all fit the payload.

@group(0) @binding(3) var<storage, read> super_patches: array<Group>;
// Where the super-patches of each block begin, and where the last one ends.
@group(0) @binding(4) var<storage, read> blocks: array<u32>;

// Super-patches that survive, in any order: the end of each one's patches among those of all, and what leads
// from a place there to the patch. Wraps around.
var<workgroup> patch_ends: array<u32, SLOTS>;
var<workgroup> patch_offsets: array<u32, SLOTS>;
// Patches of the survivors so far, times 256, and the number of these.
var<workgroup> groups_taken: atomic<u32>;
var<workgroup> patch_total: u32;
var<workgroup> super_patches_tested: atomic<u32>;
var<workgroup> super_patches_accepted: atomic<u32>;

@task @payload(payload) @workgroup_size(TASK_WIDTH)
fn cull_super_patches(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) -> @builtin(mesh_task_size) vec3u {
    let number = workgroup_number(workgroup);
    let instance = work.first_instance + number / work.item_count;
    let is_work = number < work.item_count * work.instance_count;
    if lane.index == 0u {
        atomicStore(&groups_taken, 0u);
        atomicStore(&super_patches_tested, 0u);
        atomicStore(&super_patches_accepted, 0u);
    }
    begin_tasks(lane);
    if is_work {
        let block = work.first_item + number % work.item_count;
        for (var i = blocks[block] + lane.index; i < blocks[block + 1u]; i += TASK_WIDTH) {
            test_super_patch(i, instance);
        }
    }
    workgroupBarrier();
    if lane.index == 0u {
        patch_total = atomicLoad(&groups_taken) / 256u;
    }
    let total = workgroupUniformLoad(&patch_total);
    for (var first = 0u; first < total; first += TASK_WIDTH) {
        let place = first + lane.index;
        var patch_index = 0u;
        if place < total {
            patch_index = patch_offsets[super_patch_of(place)] + place;
        }
        test_patch(place < total, patch_index, instance, lane);
    }
    if lane.index == 0u {
        atomicAdd(&counters.super_patches_tested, atomicLoad(&super_patches_tested));
        atomicAdd(&counters.super_patches_accepted, atomicLoad(&super_patches_accepted));
    }
    return launch(lane);
}

fn test_super_patch(index: u32, instance: u32) {
    let group = super_patches[index];
    atomicAdd(&super_patches_tested, group.weight);
    if may_hold_contour(group.bound, viewpoints[placement_of(instance, group.part)]) {
        let before = atomicAdd(&groups_taken, 256u * group.count + 1u);
        patch_ends[before % 256u] = before / 256u + group.count;
        patch_offsets[before % 256u] = group.first - before / 256u;
        atomicAdd(&super_patches_accepted, group.weight);
    }
}

// The first super-patch that survives whose patches end after `place`, one of them.
fn super_patch_of(place: u32) -> u32 {
    var low = 0u;
    var high = atomicLoad(&groups_taken) % 256u - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if patch_ends[middle] <= place {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}
