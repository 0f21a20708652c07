
@fragment
fn line_color() -> @location(0) vec4f {
    return stroke.color;
}
