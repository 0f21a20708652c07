// Appends contour edges to the segments: collected in the workgroup, so that one atomic operation in memory makes
// room for many. One for each subgroup that has any takes five to six times as long (docs/experiments.md).

const HIT_CAPACITY: u32 = 4u * WIDTH;

struct Lane {
    @builtin(local_invocation_index) index: u32,
}

var<workgroup> hit_count: atomic<u32>;
var<workgroup> hits: array<vec2u, HIT_CAPACITY>;
var<workgroup> pending: u32;
var<workgroup> first_hit: u32;

// Before the first `append`, by all lanes.
fn begin_appending(lane: Lane) {
    if lane.index == 0u {
        atomicStore(&hit_count, 0u);
    }
    workgroupBarrier();
}

// By all lanes of the workgroup at once, those without a contour edge too.
fn append(is_hit: bool, edge: u32, placement: u32, lane: Lane) {
    if is_hit {
        hits[atomicAdd(&hit_count, 1u)] = vec2u(edge, placement);
    }
    workgroupBarrier();
    if lane.index == 0u {
        pending = atomicLoad(&hit_count);
    }
    if workgroupUniformLoad(&pending) > HIT_CAPACITY - WIDTH {
        flush(lane.index);
    }
}

// After the last `append`, by all lanes.
fn end_appending(lane: Lane) {
    if lane.index == 0u {
        pending = atomicLoad(&hit_count);
    }
    if workgroupUniformLoad(&pending) > 0u {
        flush(lane.index);
    }
}

fn flush(lane: u32) {
    if lane == 0u {
        first_hit = counters.first_segment + atomicAdd(&counters.segments, pending);
    }
    let first = workgroupUniformLoad(&first_hit);
    for (var i = lane; i < pending; i += WIDTH) {
        write_segment(first + i, hits[i].x, hits[i].y);
    }
    workgroupBarrier();
    if lane == 0u {
        atomicStore(&hit_count, 0u);
    }
    workgroupBarrier();
}
