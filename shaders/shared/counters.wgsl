// What extraction by compute shaders counts.

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

@group(1) @binding(1) var<storage, read_write> counters: Counters;
