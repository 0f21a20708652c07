// The two tests, without bindings: for any pipeline, and for a browser.
//
// A viewpoint is homogeneous, w = 1 or less for a point and 0 for a direction, in the frame of what is
// tested (twin: src/frame.rs).

// Twin of crates/bounds/src/double_cone.rs, DoubleCone.
struct DoubleCone {
    center: vec3f,
    apex_distance: f32,
    axis: vec3f,
    tan_squared: f32,
}

// Planes of the two faces of an edge: unit normal, and minus its product with a point of the face.
// Zero where a face has no area: such a face is always seen from the front.
// Twin of src/edge.rs, EdgePlanes.
struct EdgePlanes {
    left: vec4f,
    right: vec4f,
}

// The least clearance that is culled; its square must not be lost to underflow.
// Twin of crates/bounds/src/double_cone.rs.
const MIN_CLEARANCE: f32 = 0x1p-47;

// Whether one plane may face the viewpoint and another face away: `false` is certain.
// Twin of DoubleCone::may_hold_contour_towards. Tsiapkolis and Bénard, CGF 2024, eq. 1, as two cones.
fn may_hold_contour(bound: DoubleCone, viewpoint: vec4f) -> bool {
    let to_viewpoint = viewpoint.xyz - viewpoint.w * bound.center;
    let height = dot(bound.axis, to_viewpoint);
    // As a vector: a difference of squares is noise near the axis.
    let across = to_viewpoint - height * bound.axis;
    let clearance = abs(height) - viewpoint.w * bound.apex_distance;
    let is_culled = clearance > MIN_CLEARANCE
        && clearance * clearance > bound.tan_squared * dot(across, across);
    return !is_culled;
}

// Whether the viewpoint is on the normal's side of a plane, or in the plane.
// The same operations for each plane: all edges of a face must agree, or contours do not close.
fn is_front_facing(plane: vec4f, viewpoint: vec4f) -> bool {
    let height = fma(plane.x, viewpoint.x, fma(plane.y, viewpoint.y, fma(plane.z, viewpoint.z, plane.w * viewpoint.w)));
    return height >= 0.0;
}

// Whether one face of an edge is seen from the front and the other from behind.
fn is_contour(planes: EdgePlanes, viewpoint: vec4f) -> bool {
    return is_front_facing(planes.left, viewpoint) != is_front_facing(planes.right, viewpoint);
}
