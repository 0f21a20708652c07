// Tests super-patches, then the patches of those that may hold a contour edge, then their edges.

@group(0) @binding(3) var<storage, read> super_patches: array<Group>;

// As edge_ends, edge_offsets and taken, of patches.
var<workgroup> patch_ends: array<u32, WIDTH>;
var<workgroup> patch_offsets: array<u32, WIDTH>;
var<workgroup> groups_taken: atomic<u32>;
var<workgroup> all_groups: u32;
var<workgroup> super_patches_tested: atomic<u32>;
var<workgroup> super_patches_accepted: atomic<u32>;

@compute @workgroup_size(WIDTH)
fn super_patches_to_edges(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) {
    let number = workgroup_number(workgroup);
    let blocks = blocks_per_instance();
    if number >= blocks * work.instance_count {
        return;
    }
    if lane.index == 0u {
        atomicStore(&groups_taken, 0u);
        atomicStore(&super_patches_tested, 0u);
        atomicStore(&super_patches_accepted, 0u);
    }
    begin_patches(lane);
    let instance = work.first_instance + number / blocks;
    let first = (number % blocks) * work.items_per_workgroup;
    let end = min(first + work.items_per_workgroup, work.item_count);
    // No more than the narrowest workgroup has lanes.
    if lane.index < end - first {
        test_super_patch(work.first_item + first + lane.index, instance);
    }
    workgroupBarrier();
    if lane.index == 0u {
        all_groups = atomicLoad(&groups_taken);
    }
    let all = workgroupUniformLoad(&all_groups);
    for (var first_place = 0u; first_place < all / 512u; first_place += WIDTH) {
        let place = first_place + lane.index;
        if place < all / 512u {
            test_patch(patch_offsets[super_patch_of(place, all % 512u)] + place, instance);
        }
        test_edges(lane);
    }
    end_patches(lane);
    if lane.index == 0u {
        atomicAdd(&counters.super_patches_tested, atomicLoad(&super_patches_tested));
        atomicAdd(&counters.super_patches_accepted, atomicLoad(&super_patches_accepted));
    }
}

fn test_super_patch(index: u32, instance: u32) {
    let group = super_patches[index];
    atomicAdd(&super_patches_tested, group.weight);
    if may_hold_contour(group.bound, viewpoints[placement_of(instance, group.part)]) {
        atomicAdd(&super_patches_accepted, group.weight);
        let before = atomicAdd(&groups_taken, 512u * group.count + 1u);
        patch_ends[before % 512u] = before / 512u + group.count;
        patch_offsets[before % 512u] = group.first - before / 512u;
    }
}

// The first of `count` super-patches whose patches end after `place`.
fn super_patch_of(place: u32, count: u32) -> u32 {
    var low = 0u;
    var high = count - 1u;
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
