// Poses the vertices that loose edges and faces that bend need, a lane for each: linear blend skinning of
// what morph targets displace.

// A carrier's part in a vertex. Twin of src/rig/layout.rs, VertexInfluence.
struct VertexInfluence {
    // In the frame of the carrier.
    position: vec3f,
    weight: f32,
    carrier: u32,
    // What displaces it.
    first_offset: u32,
    offset_end: u32,
    is_last: u32,
}

// What a morph target adds at weight 1, in the frame of a carrier. Twin of src/rig/layout.rs, MorphOffset.
struct MorphOffset {
    by: vec3f,
    morph: u32,
}

@group(0) @binding(1) var<storage, read> first_influences: array<u32>;
@group(0) @binding(2) var<storage, read> influences: array<VertexInfluence>;
@group(0) @binding(3) var<storage, read> offsets: array<MorphOffset>;

@group(1) @binding(1) var<storage, read> carriers: array<CarrierTransform>;
@group(1) @binding(2) var<storage, read> weights: array<f32>;
// Three numbers a vertex.
@group(1) @binding(3) var<storage, read_write> positions: array<f32>;

@compute @workgroup_size(WIDTH)
fn pose_vertices(
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) workgroup: vec3u,
) {
    let number = workgroup_number(workgroup);
    let blocks = blocks_per_instance();
    let first = (number % blocks) * work.items_per_workgroup;
    let end = min(first + work.items_per_workgroup, work.item_count);
    let instance = work.first_instance + number / blocks;
    if number >= blocks * work.instance_count {
        return;
    }
    // Once, but where the work was cut for wider workgroups.
    for (var i = first + lane; i < end; i += WIDTH) {
        let vertex = work.first_item + i;
        let position = posed(vertex, instance);
        let place = 3u * (rig.first_vertex + instance * rig.vertex_count + vertex);
        positions[place] = position.x;
        positions[place + 1u] = position.y;
        positions[place + 2u] = position.z;
    }
}

// Where a vertex is, in the frame of the pose. Twin of src/rig/twin.rs.
fn posed(vertex: u32, instance: u32) -> vec3f {
    var sum = vec3f(0.0);
    var i = first_influences[vertex];
    loop {
        let influence = influences[i];
        var moved = influence.position;
        for (var o = influence.first_offset; o < influence.offset_end; o++) {
            let offset = offsets[o];
            moved += weights[instance * rig.morph_count + offset.morph] * offset.by;
        }
        let carrier = carriers[instance * rig.carrier_count + influence.carrier];
        let p = vec4f(moved, 1.0);
        sum += influence.weight * vec3f(dot(carrier.x, p), dot(carrier.y, p), dot(carrier.z, p));
        if influence.is_last == 1u {
            break;
        }
        i++;
    }
    return sum;
}
