// Between dispatches, by one lane: adds up what was counted, makes ready for the next, and writes what
// draws the segments.

// Twin of src/layout.rs, Totals: pairs of a low and a high word.
struct Totals {
    segments: vec2u,
    edges_tested: vec2u,
    patches_tested: vec2u,
    patches_accepted: vec2u,
    super_patches_tested: vec2u,
    super_patches_accepted: vec2u,
}

@group(1) @binding(2) var<storage, read_write> totals: Totals;
@group(1) @binding(3) var<storage, read_write> arguments: Arguments;

fn add(total: vec2u, count: u32) -> vec2u {
    let low = total.x + count;
    return vec2u(low, total.y + select(0u, 1u, low < count));
}

@compute @workgroup_size(1)
fn tally() {
    totals.segments = add(totals.segments, atomicLoad(&counters.segments));
    totals.edges_tested = add(totals.edges_tested, atomicLoad(&counters.edges_tested));
    totals.patches_tested = add(totals.patches_tested, atomicLoad(&counters.patches_tested));
    totals.patches_accepted = add(totals.patches_accepted, atomicLoad(&counters.patches_accepted));
    totals.super_patches_tested =
        add(totals.super_patches_tested, atomicLoad(&counters.super_patches_tested));
    totals.super_patches_accepted =
        add(totals.super_patches_accepted, atomicLoad(&counters.super_patches_accepted));
    var written = work.segment_capacity;
    if totals.segments.y == 0u {
        written = min(totals.segments.x, work.segment_capacity);
    }
    counters.first_segment = written;
    atomicStore(&counters.segments, 0u);
    atomicStore(&counters.edges_tested, 0u);
    atomicStore(&counters.patches_tested, 0u);
    atomicStore(&counters.patches_accepted, 0u);
    atomicStore(&counters.super_patches_tested, 0u);
    atomicStore(&counters.super_patches_accepted, 0u);

    arguments.line_list = vec4u(2u * written, min(written, 1u), 0u, 0u);
    arguments.quads = vec4u(4u, written, 0u, 0u);
    let groups = (written + SEGMENTS_PER_WORKGROUP - 1u) / SEGMENTS_PER_WORKGROUP;
    arguments.workgroups = vec4u(min(groups, ROW), (groups + ROW - 1u) / ROW, min(groups, 1u), written);
}
