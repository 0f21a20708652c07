// What extraction gives, for all that goes on with it.

// A contour edge as seen from one placement. Twin of src/layout.rs, Segment.
struct Segment {
    from_vertex: u32,
    to_vertex: u32,
    placement: u32,
    edge: u32,
}

// What draws the segments, or calls something else for each. Twin of src/layout.rs, Arguments.
struct Arguments {
    // Vertices, instances, first vertex and first instance: of a list of lines, two vertices each,
    line_list: vec4u,
    // and of a strip of four vertices for each segment.
    quads: vec4u,
    // Workgroups of SEGMENTS_PER_WORKGROUP lanes, a lane for each segment, in rows. The fourth is the
    // number of segments.
    workgroups: vec4u,
}

// Rows of an affine map from the space of a part to that of the scene. Twin of src/layout.rs, Transform.
struct Transform {
    x: vec4f,
    y: vec4f,
    z: vec4f,
}

// Twins of src/layout.rs.
const SEGMENTS_PER_WORKGROUP: u32 = 64u;
const ROW: u32 = 32768u;

fn transformed(transform: Transform, position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(transform.x, p), dot(transform.y, p), dot(transform.z, p));
}
