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
}

@group(1) @binding(0) var<uniform> work: Work;

fn placement_of(instance: u32, part: u32) -> u32 {
    return work.first_placement + instance * work.part_count + part;
}
