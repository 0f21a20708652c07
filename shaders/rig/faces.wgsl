// Decides on which side of each face beside a loose edge the viewpoint is, once for all edges of the face, so
// that contours close.

// A face that bends: its vertices, and the carrier that turns it over if it mirrors.
// Twin of src/rig/layout.rs, BendingFace.
struct BendingFace {
    corners: vec3u,
    carrier: u32,
}

// A face of a rigid part, beside a loose edge. Twin of src/rig/layout.rs, PartFace.
struct PartFace {
    // In the frame of the part, bit for bit as edges of the part have it.
    plane: vec4f,
    // Where its part is placed: what an instance has of placements in the classes before that of the part, in
    // that class, and before the part in it.
    placements_before: u32,
    class_placements: u32,
    place: u32,
    carrier: u32,
}

@group(0) @binding(1) var<storage, read> bending_faces: array<BendingFace>;
@group(0) @binding(2) var<storage, read> part_faces: array<PartFace>;

@group(1) @binding(1) var<storage, read> carriers: array<CarrierTransform>;
@group(1) @binding(2) var<storage, read> viewpoints: array<vec4f>;
// Three numbers a vertex.
@group(1) @binding(3) var<storage, read> positions: array<f32>;
@group(1) @binding(4) var<storage, read_write> sides: array<u32>;

@compute @workgroup_size(WIDTH)
fn find_sides(
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
        let face = work.first_item + i;
        let place = instance * rig.face_count + face;
        if face < rig.bending_count {
            sides[place] = side_of_bending_face(bending_faces[face], instance);
        } else {
            sides[place] = side_of_part_face(part_faces[face - rig.bending_count], instance);
        }
    }
}

// Twin of src/rig/twin.rs.
fn side_of_bending_face(face: BendingFace, instance: u32) -> u32 {
    let viewpoint = viewpoints[placement_of(instance, 0u)];
    let a = position(face.corners.x, instance);
    let u = position(face.corners.y, instance) - a;
    let v = position(face.corners.z, instance) - a;
    let height = dot(cross(u, v), viewpoint.xyz - viewpoint.w * a);
    let is_mirrored = mirrored(face.carrier, instance);
    let oriented = select(height, -height, is_mirrored == 1u);
    return side(oriented >= 0.0, oriented <= 0.0, is_mirrored);
}

// It keeps its shape, so its plane is not found anew; and in the space of the part, it is not turned over.
fn side_of_part_face(face: PartFace, instance: u32) -> u32 {
    let placement = face.placements_before * work.most_instances
        + instance * face.class_placements + face.place;
    let viewpoint = viewpoints[placement];
    let is_front = is_front_facing(face.plane, viewpoint);
    return side(is_front, is_front_facing(-face.plane, viewpoint), mirrored(face.carrier, instance));
}

// Whether a face is seen from the front, whether it would be if it were turned over, and whether it is
// mirrored: a bit each.
fn side(is_front: bool, is_front_turned: bool, is_mirrored: u32) -> u32 {
    return u32(is_front) | (u32(is_front_turned) << 1u) | (is_mirrored << 2u);
}

fn mirrored(carrier: u32, instance: u32) -> u32 {
    return carriers[instance * rig.carrier_count + carrier].is_mirrored;
}

fn position(vertex: u32, instance: u32) -> vec3f {
    let place = 3u * (rig.first_vertex + instance * rig.vertex_count + vertex);
    return vec3f(positions[place], positions[place + 1u], positions[place + 2u]);
}
