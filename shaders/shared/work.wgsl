// What a dispatch has to do, and what is counted in it.

// What one dispatch has to do. Twin of src/layout.rs, Work.
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
}

// What is counted during one dispatch. Twin of src/layout.rs, Counters.
struct Counters {
    // Where the first segment of this dispatch goes.
    first_segment: u32,
    segments: atomic<u32>,
    edges_tested: atomic<u32>,
    patches_tested: atomic<u32>,
    patches_accepted: atomic<u32>,
    super_patches_tested: atomic<u32>,
    super_patches_accepted: atomic<u32>,
}

@group(1) @binding(0) var<uniform> work: Work;
@group(1) @binding(1) var<storage, read_write> counters: Counters;
