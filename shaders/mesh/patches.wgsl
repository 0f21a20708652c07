// A lane for each patch of each instance.

@task @payload(payload) @workgroup_size(TASK_WIDTH)
fn cull_patches(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) -> @builtin(mesh_task_size) vec3u {
    begin_tasks(lane);
    let item = workgroup_number(workgroup) * TASK_WIDTH + lane.index;
    let patch_index = work.first_item + item % work.item_count;
    let instance = work.first_instance + item / work.item_count;
    test_patch(item < work.item_count * work.instance_count, patch_index, instance, lane);
    return launch(lane);
}
