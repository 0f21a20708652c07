// Tests patches, then the edges of those that may hold a contour edge: a workgroup takes some patches of
// one instance. Tsiapkolis and Bénard (CGF 2024, §4.3) write survivors to memory and test edges in a
// second dispatch; here survivors stay in the workgroup.

@compute @workgroup_size(WIDTH)
fn patches_and_edges(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) {
    let number = workgroup_number(workgroup);
    let blocks = blocks_per_instance();
    if number >= blocks * work.instance_count {
        return;
    }
    begin_patches(lane);
    let instance = work.first_instance + number / blocks;
    let first = (number % blocks) * work.items_per_workgroup;
    let end = min(first + work.items_per_workgroup, work.item_count);
    // Once, but where the work was cut for wider workgroups.
    for (var i = first; i < end; i += WIDTH) {
        if i + lane.index < end {
            test_patch(work.first_item + i + lane.index, instance);
        }
        test_edges(lane);
    }
    end_patches(lane);
}
