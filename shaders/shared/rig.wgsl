// What shaders of a rig share: a model whose vertices are carried by joints and other spaces that move.

// Twin of src/rig/layout.rs, RigCounts.
struct RigCounts {
    // Where vertices that are posed begin among the positions, after those of the rigid parts' shapes.
    first_vertex: u32,
    // Of these, for each instance.
    vertex_count: u32,
    // Faces that bend; those of rigid parts that loose edges need follow.
    bending_count: u32,
    face_count: u32,
    carrier_count: u32,
    morph_count: u32,
}

// Rows of an affine map from the frame of a carrier to that of the pose. Twin of src/rig/layout.rs,
// CarrierTransform.
struct CarrierTransform {
    x: vec4f,
    y: vec4f,
    z: vec4f,
    // 1 if the carrier mirrors: the corners of its faces run the other way.
    is_mirrored: u32,
}

@group(0) @binding(0) var<uniform> rig: RigCounts;
