// What all extraction shaders read and write, but for the model itself.

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

// Vertices of an edge, and what its id is in the mesh. Twin of src/edge.rs, EdgeEnds.
struct EdgeEnds {
    from_vertex: u32,
    to_vertex: u32,
    edge: u32,
}

@group(0) @binding(0) var<storage, read> planes: array<EdgePlanes>;
@group(0) @binding(1) var<storage, read> ends: array<EdgeEnds>;

@group(1) @binding(0) var<uniform> work: Work;
// The viewpoint of each placement, in the frame of its part.
@group(1) @binding(1) var<storage, read> viewpoints: array<vec4f>;
@group(1) @binding(2) var<storage, read_write> counters: Counters;
@group(1) @binding(3) var<storage, read_write> segments: array<Segment>;

// Workgroups are numbered through, row by row: there may be more than one dimension holds.
fn workgroup_number(workgroup: vec3u, workgroups: vec3u) -> u32 {
    return workgroup.x + workgroup.y * workgroups.x;
}

fn blocks_per_instance() -> u32 {
    return (work.item_count + work.items_per_workgroup - 1u) / work.items_per_workgroup;
}

fn write_segment(index: u32, edge: u32, placement: u32) {
    if index < work.segment_capacity {
        let found = ends[edge];
        segments[index] = Segment(found.from_vertex, found.to_vertex, placement, found.edge);
    }
}
