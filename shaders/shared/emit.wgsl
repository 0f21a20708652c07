// Emits the contour edges of a mesh workgroup, and nothing else.

// Segments of all draws so far.
@group(1) @binding(4) var<storage, read_write> segment_count: atomic<u32>;

@group(2) @binding(0) var<uniform> stroke: Stroke;
// Three numbers a vertex.
@group(3) @binding(0) var<storage, read> positions: array<f32>;
@group(3) @binding(1) var<storage, read> transforms: array<Transform>;

var<workgroup> hits: atomic<u32>;
var<workgroup> first_segment: u32;

// By all lanes of the workgroup, those without a contour edge too.
fn emit(is_hit: bool, edge: u32, placement: u32, lane: Lane) {
    if lane.index == 0u {
        atomicStore(&hits, 0u);
    }
    workgroupBarrier();
    let before = subgroupExclusiveAdd(u32(is_hit));
    let hit_count = subgroupAdd(u32(is_hit));
    var base = 0u;
    if lane.in_subgroup == 0u && hit_count > 0u {
        base = atomicAdd(&hits, hit_count);
    }
    let place = subgroupBroadcastFirst(base) + before;
    workgroupBarrier();
    let total = atomicLoad(&hits);
    if lane.index == 0u {
        output.vertex_count = VERTICES_PER_EDGE * total;
        output.primitive_count = PRIMITIVES_PER_EDGE * total;
        if total > 0u {
            atomicAdd(&counters.segments, total);
            if RECORDS {
                first_segment = atomicAdd(&segment_count, total);
            }
        } else {
            atomicAdd(&counters.idle_mesh_workgroups, 1u);
        }
    }
    if is_hit {
        emit_edge(place, edge, placement);
    }
    if RECORDS {
        workgroupBarrier();
        if is_hit {
            write_segment(first_segment + place, edge, placement);
        }
    }
}
