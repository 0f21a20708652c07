// What a dispatch, or a draw of mesh shaders, has to do.

// What one of them has to do. Twin of src/layout.rs, Work.
struct Work {
    // Edges for brute force; patches, or super-patches, to begin with.
    first_item: u32,
    item_count: u32,
    items_per_workgroup: u32,
    first_instance: u32,
    instance_count: u32,
    // Parts of an instance, each with a placement of its own.
    part_count: u32,
    // The part that the edges belong to; brute force only.
    part: u32,
    // Segments that fit the output.
    segment_capacity: u32,
    // Where the placements of these parts begin.
    first_placement: u32,
    // Instances that a frame has room for.
    most_instances: u32,
    // Workgroups along x. Not asked of the pipeline: one driver gives mesh shaders a wrong number there.
    row: u32,
}

@group(1) @binding(0) var<uniform> work: Work;

// Workgroups are numbered through, row by row: there may be more than one dimension holds.
fn workgroup_number(workgroup: vec3u) -> u32 {
    return workgroup.x + workgroup.y * work.row;
}

fn blocks_per_instance() -> u32 {
    return (work.item_count + work.items_per_workgroup - 1u) / work.items_per_workgroup;
}

fn placement_of(instance: u32, part: u32) -> u32 {
    return work.first_placement + instance * work.part_count + part;
}
