// Draws segments as strokes, some pixels wide and round at both ends: how much of each pixel they cover.
// Strokes that overlap are to be blended by the larger coverage, so that a chain of segments covers what
// one line with round joins would.
//
// A pixel asks whether the point of the spine next to it is visible, not whether it is so itself: the
// surface that a contour belongs to lies beside it, and would cover half of the stroke.

// Twin of src/layout.rs, Raster.
struct Raster {
    // In pixels.
    size: vec2f,
    // 1 where farther is larger, -1 where it is smaller.
    depth_sign: f32,
    // Between two values of the depth texture.
    depth_step: f32,
}

// Pixels over which the edge of a stroke fades, half of it on either side.
const FEATHER: f32 = 1.0;

// Depths of the spine and of the surface are rounded, by some units of 2^-24.
const DEPTH_SLACK: f32 = 1e-6;

// Pixels within which something behind the spine makes it visible, and beyond which it does not.
const NEAR: f32 = 1.12;
const FAR: f32 = 1.5;

struct StrokeVertex {
    @builtin(position) position: vec4f,
    // Both ends of the spine: pixels, y down, and depth, which is linear on the screen.
    @location(0) @interpolate(flat) from_end: vec3f,
    @location(1) @interpolate(flat) to_end: vec3f,
}

// What of a segment can be seen on the screen, as fractions of it; nothing if they are in reverse order.
fn visible_range(from_clip: vec4f, to_clip: vec4f, margin: vec2f) -> vec2f {
    var range = vec2f(0.0, 1.0);
    for (var plane = 0u; plane < 6u; plane++) {
        let axis = plane / 2u;
        // Of x and y from -w to w and some pixels more, of z from 0 to w.
        var low = vec2f(-1.0) * vec2f(from_clip.w, to_clip.w);
        var high = -low;
        if axis < 2u {
            low *= margin[axis];
            high *= margin[axis];
        } else {
            low = vec2f(0.0);
        }
        let value = vec2f(from_clip[axis], to_clip[axis]);
        let inside = select(value - low, high - value, plane % 2u == 1u);
        if inside.x < 0.0 && inside.y < 0.0 {
            return vec2f(1.0, 0.0);
        }
        let crossing = inside.x / (inside.x - inside.y);
        if inside.x < 0.0 {
            range.x = max(range.x, crossing);
        } else if inside.y < 0.0 {
            range.y = min(range.y, crossing);
        }
    }
    return range;
}

fn on_screen(clip: vec4f) -> vec3f {
    let ndc = clip.xyz / clip.w;
    return vec3f((0.5 + vec2f(0.5, -0.5) * ndc.xy) * raster.size, ndc.z);
}

// One of the four corners of a segment's stroke: 0 and 1 at its beginning, 2 and 3 at its end.
fn stroke_corner(segment: Segment, corner: u32) -> StrokeVertex {
    let from_clip = position_in_clip(segment.from_vertex, segment.placement);
    let to_clip = position_in_clip(segment.to_vertex, segment.placement);
    let reach = stroke.half_width + FEATHER;
    let range = visible_range(from_clip, to_clip, 1.0 + 2.0 * reach / raster.size);
    if range.x >= range.y {
        // Beyond the far plane, as its other corners.
        return StrokeVertex(vec4f(0.0, 0.0, 2.0, 1.0), vec3f(0.0), vec3f(0.0));
    }
    let from_end = on_screen(mix(from_clip, to_clip, range.x));
    let to_end = on_screen(mix(from_clip, to_clip, range.y));
    let along = to_end.xy - from_end.xy;
    let length = length(along);
    let direction = select(vec2f(1.0, 0.0), along / length, length > 1e-6);
    let is_end = corner >= 2u;
    let side = select(-reach, reach, corner % 2u == 1u);
    let pixel = select(from_end.xy - reach * direction, to_end.xy + reach * direction, is_end)
        + side * vec2f(-direction.y, direction.x);
    let ndc = vec2f(2.0, -2.0) * (pixel / raster.size - 0.5);
    return StrokeVertex(vec4f(ndc, 0.5, 1.0), from_end, to_end);
}

// How much a point of a spine can be seen, from 0 to 1.
//
// Beside a contour one sees past the surface that it belongs to. So if nothing else is in the way, then of
// the pixels around the point one is not nearer than it; whichever way the spine runs, the center of such
// a pixel is within √5/2, just below NEAR. If the point is hidden, they lie beyond the border of what hides
// it: within a pixel or so of that border it fades.
fn visibility(point: vec3f) -> f32 {
    let slack = DEPTH_SLACK * abs(point.z) + raster.depth_step;
    var nearest = FAR;
    for (var i = 0u; i < 9u; i++) {
        let offset = vec2f(vec2u(i % 3u, i / 3u)) - 1.0;
        let pixel = clamp(floor(point.xy) + offset, vec2f(0.0), raster.size - 1.0);
        let surface = textureLoad(depth, vec2i(pixel), 0);
        if raster.depth_sign * (point.z - surface) <= slack {
            nearest = min(nearest, distance(floor(point.xy) + offset + 0.5, point.xy));
        }
    }
    return (FAR - nearest) / (FAR - NEAR);
}

@fragment
fn stroke_coverage(vertex: StrokeVertex) -> @location(0) f32 {
    let along = vertex.to_end.xy - vertex.from_end.xy;
    let from_start = vertex.position.xy - vertex.from_end.xy;
    let fraction = dot(from_start, along) / max(dot(along, along), 1e-12);
    let point = mix(vertex.from_end, vertex.to_end, clamp(fraction, 0.0, 1.0));
    let distance = distance(vertex.position.xy, point.xy);
    // Of a line thinner than a pixel, no pixel is covered wholly.
    let most = min(2.0 * stroke.half_width / FEATHER, 1.0);
    let coverage = clamp((stroke.half_width - distance) / FEATHER + 0.5, 0.0, most);
    return coverage * saturate(visibility(point));
}
