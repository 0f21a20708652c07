// What all extraction shaders read of a model and a frame, and where they write what they find.

// Vertices of an edge, its id in the mesh, and its class. Twin of src/edge.rs, EdgeEnds.
struct EdgeEnds {
    from_vertex: u32,
    to_vertex: u32,
    edge: u32,
    edge_class: u32,
}

@group(0) @binding(0) var<storage, read> planes: array<EdgePlanes>;
@group(0) @binding(1) var<storage, read> ends: array<EdgeEnds>;

// The viewpoint of each placement, in the frame of its part.
@group(1) @binding(2) var<storage, read> viewpoints: array<vec4f>;
@group(1) @binding(3) var<storage, read_write> segments: array<Segment>;

fn write_segment(index: u32, edge: u32, placement: u32) {
    if index < work.segment_capacity {
        let found = ends[edge];
        segments[index] = Segment(found.from_vertex, found.to_vertex, placement, found.edge);
    }
}
