// Tests loose edges, those beside a face that bends and those between rigid parts, by the sides of their faces.

// Twin of src/rig/layout.rs, LooseEdge.
struct LooseEdge {
    left_face: u32,
    right_face: u32,
    // Counted from the first vertex that is posed.
    from_vertex: u32,
    to_vertex: u32,
    // Its id in the rig.
    edge: u32,
    // 1 where the right face is wound the other way.
    is_right_turned: u32,
}

@group(0) @binding(1) var<storage, read> loose_edges: array<LooseEdge>;

@group(1) @binding(2) var<storage, read> sides: array<u32>;
@group(1) @binding(3) var<storage, read_write> segments: array<Segment>;

fn write_segment(index: u32, edge: u32, placement: u32) {
    if index < work.segment_capacity {
        let found = loose_edges[edge];
        let instance = placement - work.first_placement;
        let first_vertex = rig.first_vertex + instance * rig.vertex_count;
        segments[index] = Segment(
            first_vertex + found.from_vertex,
            first_vertex + found.to_vertex,
            placement,
            found.edge,
        );
    }
}

// Twin of src/rig/layout.rs, LooseEdge::is_contour: what is read turned over is by the edge's own winding, and
// where one of its faces is mirrored and the other not.
fn is_loose_contour(edge: LooseEdge, left: u32, right: u32) -> bool {
    let is_turned = edge.is_right_turned ^ ((left ^ right) >> 2u);
    return (left & 1u) != ((right >> is_turned) & 1u);
}

@compute @workgroup_size(WIDTH)
fn test_loose_edges(lane: Lane, @builtin(workgroup_id) workgroup: vec3u) {
    let number = workgroup_number(workgroup);
    let blocks = blocks_per_instance();
    if number >= blocks * work.instance_count {
        return;
    }
    begin_appending(lane);
    let instance = work.first_instance + number / blocks;
    let first_side = instance * rig.face_count;
    let first = (number % blocks) * work.items_per_workgroup;
    let end = min(first + work.items_per_workgroup, work.item_count);
    for (var i = first; i < end; i += WIDTH) {
        let index = work.first_item + i + lane.index;
        var is_hit = false;
        if i + lane.index < end {
            let edge = loose_edges[index];
            let left = sides[first_side + edge.left_face];
            is_hit = is_loose_contour(edge, left, sides[first_side + edge.right_face]);
        }
        append(is_hit, index, placement_of(instance, 0u), lane);
    }
    end_appending(lane);
    if lane.index == 0u {
        atomicAdd(&counters.edges_tested, end - first);
    }
}
