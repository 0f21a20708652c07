// Emits the contour edges of a mesh workgroup, and nothing else.

// Segments of all draws so far.
@group(1) @binding(4) var<storage, read_write> segment_count: atomic<u32>;

@group(2) @binding(0) var<uniform> stroke: Stroke;
// Three numbers a vertex.
@group(3) @binding(0) var<storage, read> positions: array<f32>;
@group(3) @binding(1) var<storage, read> transforms: array<Transform>;

var<workgroup> hits: atomic<u32>;

// By all lanes of the workgroup, first of all.
fn begin_emitting(lane: Lane) {
    if lane.index == 0u {
        atomicStore(&hits, 0u);
    }
    workgroupBarrier();
}

// By all lanes at once, those without a contour edge too.
fn emit(is_hit: bool, edge: u32, placement: u32, lane: Lane) {
    let before = subgroupExclusiveAdd(u32(is_hit));
    let hit_count = subgroupAdd(u32(is_hit));
    var places = vec2u();
    if is_elected(lane) && hit_count > 0u {
        places.x = atomicAdd(&hits, hit_count);
        if RECORDS {
            places.y = atomicAdd(&segment_count, hit_count);
        }
    }
    places = subgroupBroadcastFirst(places) + before;
    if is_hit {
        emit_edge(places.x, edge, placement);
        if RECORDS {
            write_segment(places.y, edge, placement);
        }
    }
}

// By all lanes, last of all.
fn end_emitting(lane: Lane) {
    workgroupBarrier();
    if lane.index == 0u {
        let total = atomicLoad(&hits);
        output.vertex_count = VERTICES_PER_EDGE * total;
        output.primitive_count = PRIMITIVES_PER_EDGE * total;
        if total > 0u {
            atomicAdd(&counters.segments, total);
        } else {
            atomicAdd(&counters.idle_mesh_workgroups, 1u);
        }
    }
}
