//! A drawing as SVG.

use std::fmt::Write as _;

use glam::DVec2;
use svg::Document;
use svg::node::element::{Group, Path, Rectangle, Title};

use crate::{Area, Color, Drawing, Layer, Run, Style};

/// `drawing` as a text in SVG 1.1, for browsers, Inkscape and plotters, under a `title`.
///
/// One `<g class="contour">` or other name of a [`LineClass`](crate::LineClass) per class, those of
/// hidden lines with the class `hidden` beside it; a class without lines has no group. In it one
/// `<path>` per run, with the edges it runs along in `data-edges`, by id, or with the pairs of faces
/// that cross there in `data-faces`, as `3,17 3,18`. Of a drawing with labels, `data-part` and
/// `data-material` name what it belongs to, unless that has no name. Pixels with two decimals; a run
/// that is shorter is left out.
///
/// Areas lie under the lines in a `<g class="areas">`, one `<path>` each with the name of its tint
/// as its class.
pub fn to_svg(drawing: &Drawing, style: &Style, title: &str) -> String {
    let (width, height) = (drawing.page.width, drawing.page.height);
    let mut document = Document::new()
        .set("width", width)
        .set("height", height)
        .set("viewBox", format!("0 0 {width} {height}"))
        .add(Title::new(without_control_characters(title)));
    if let Some(color) = style.background {
        let page =
            Rectangle::new().set("class", "background").set("width", width).set("height", height);
        document = document.add(painted(page, "fill", color));
    }
    if !drawing.areas.is_empty() {
        let group = Group::new().set("class", "areas").set("stroke-linejoin", "round");
        document = document.add(drawing.areas.iter().map(area).fold(group, Group::add));
    }
    for (layer, visible, runs) in drawing.inked(style) {
        let paths: Vec<Path> = runs.into_iter().filter_map(|run| path(drawing, run)).collect();
        if !paths.is_empty() {
            let group = group(layer, visible, style);
            document = document.add(paths.into_iter().fold(group, Group::add));
        }
    }
    format!("{document}\n")
}

fn group(layer: &Layer, visible: bool, style: &Style) -> Group {
    let name = layer.class.name();
    let group = Group::new()
        .set("class", if visible { name.to_owned() } else { format!("{name} hidden") })
        .set("fill", "none")
        .set("stroke-width", Hundredths::of(style.width_of(visible)).to_string())
        .set("stroke-linejoin", "round");
    let group = painted(group, "stroke", style.color);
    match style.dashes(visible).map(|lengths| lengths.map(Hundredths::of)) {
        None => group.set("stroke-linecap", "round"),
        // Round caps would fill the gaps.
        Some([dash, gap]) => {
            group.set("stroke-linecap", "butt").set("stroke-dasharray", format!("{dash} {gap}"))
        }
    }
}

/// Sets `fill` or `stroke`; opacity is of the whole element, so that lines do not add up where they
/// cross.
fn painted<E>(element: E, what: &str, color: Color) -> E
where
    E: svg::Node,
{
    let mut element = element;
    element.assign(what, Color { alpha: 255, ..color }.to_string());
    if color.alpha < 255 {
        element.assign("opacity", Hundredths::of(f64::from(color.alpha) / 255.0).to_string());
    }
    element
}

/// An area as a path, outlined in its own color.
fn area(area: &Area) -> Path {
    let rings = area.rings.iter().map(|ring| ring.iter().map(rounded).collect::<Vec<_>>());
    let data: String = rings.map(|ring| data(&ring, true)).collect();
    let path = Path::new()
        .set("class", area.tint.name.as_str())
        .set("stroke-width", Hundredths::of(area.tint.outline()).to_string())
        .set("d", data);
    painted(painted(path, "fill", area.tint.color), "stroke", area.tint.color)
}

/// A run as a path; none if all its points round to one.
fn path(drawing: &Drawing, run: &Run) -> Option<Path> {
    let mut points: Vec<[Hundredths; 2]> = run.points.iter().map(rounded).collect();
    points.dedup();
    if run.closed && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 2 {
        return None;
    }
    let mut path = Path::new().set("d", data(&points, run.closed));
    let edges: Vec<_> =
        run.segments.iter().filter_map(|s| s.edge).map(|edge| edge.0.to_string()).collect();
    if edges.is_empty() {
        let pairs: Vec<_> =
            run.segments.iter().map(|s| format!("{},{}", s.faces[0], s.faces[1])).collect();
        path = path.set("data-faces", pairs.join(" "));
    } else {
        path = path.set("data-edges", edges.join(" "));
    }
    if let Some(label) = drawing.label_of(run) {
        for (name, value) in [("data-part", &label.part), ("data-material", &label.material)] {
            let value = without_control_characters(value);
            if !value.is_empty() {
                path = path.set(name, value);
            }
        }
    }
    Some(path)
}

/// A polyline as path data.
fn data(points: &[[Hundredths; 2]], closed: bool) -> String {
    let mut data = String::with_capacity(12 * points.len());
    for (i, [x, y]) in points.iter().enumerate() {
        let before = match i {
            0 => "M",
            1 => "L",
            _ => " ",
        };
        // Writing to a string cannot fail.
        let _ = write!(data, "{before}{x} {y}");
    }
    if closed {
        data.push('Z');
    }
    data
}

fn rounded(point: &DVec2) -> [Hundredths; 2] {
    point.to_array().map(Hundredths::of)
}

/// A number of two decimals at most, written without needless zeros.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Hundredths(i64);

impl Hundredths {
    fn of(x: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "saturates, and pages are smaller")]
        Self((100.0 * x).round() as i64)
    }
}

impl std::fmt::Display for Hundredths {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (sign, size) = (if self.0 < 0 { "-" } else { "" }, self.0.unsigned_abs());
        match (size / 100, size % 100) {
            (whole, 0) => write!(f, "{sign}{whole}"),
            (whole, part) if part % 10 == 0 => write!(f, "{sign}{whole}.{}", part / 10),
            (whole, part) => write!(f, "{sign}{whole}.{part:02}"),
        }
    }
}

/// XML has no way to write most control characters; names of files can hold them.
fn without_control_characters(text: &str) -> String {
    let is_written = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().filter(is_written).collect()
}
