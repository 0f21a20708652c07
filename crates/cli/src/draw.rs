//! `drypoint draw`: from a model to a picture.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use drypoint_lines::{
    Camera, Color, Drawing, HiddenLines, Layer, LineOptions, Occluders, Segments, Style,
    VisibilityParams, to_png, to_svg,
};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, contour_edges};
use serde::Serialize;

use crate::args::{Class, DrawArgs, Hidden, LineArgs};
use crate::output::{Output, print_json};
use crate::progress::Stage;
use crate::source::Source;
use crate::view;

/// What is on the page of one class of lines, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Drawn {
    chains: usize,
    segments: usize,
    /// In pixels.
    visible_length: f64,
    /// In pixels.
    hidden_length: f64,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

pub(crate) fn run(args: &DrawArgs) -> Result<(), String> {
    let style = style(&args.lines)?;
    let options = options(&args.lines)?;
    let source;
    let path = match &args.output {
        Some(path) => {
            format_of(path)?;
            // A place that cannot be written is told before the work, not after.
            Output::open(path)?;
            source = Source::load(&args.model)?;
            path.clone()
        }
        None => {
            source = Source::load(&args.model)?;
            PathBuf::from(format!("{}.svg", source.stem))
        }
    };
    let (format, output) = (format_of(&path)?, Output::open(&path)?);
    let camera = view::camera(&args.view, source.mesh())?;
    let adjacency = source.adjacency();
    if adjacency.report().degenerate == adjacency.report().faces {
        return Err(format!("{}: no face has any area, so there is nothing to see", source.name));
    }
    let drawing = trace(&source, &adjacency, &camera, (&args.lines.lines, &options));
    match format {
        Format::Svg => output.write(to_svg(&drawing, &style, &source.stem).as_bytes())?,
        Format::Png => {
            let _stage = Stage::new("rasterising");
            let picture = to_png(&drawing, &style).map_err(|error| error.to_string())?;
            output.write(&picture)?;
        }
    }
    if args.json {
        return print_json(&drawn(&drawing));
    }
    if args.output.is_none() {
        eprintln!("drypoint: wrote {}", path.display());
    }
    Ok(())
}

/// Finds the lines and what hides them.
fn trace(
    source: &Source,
    adjacency: &MeshAdjacency,
    camera: &Camera,
    (classes, options): (&[Class], &LineOptions),
) -> Drawing {
    let mesh = source.mesh();
    let mut contours = Vec::new();
    // Concave ones too: where a surface is open, inside out or seen from within, they can be seen.
    // And wanted or not: what is a contour in this view is not a crease.
    contour_edges(mesh, adjacency, camera.viewpoint(), EdgeFilter::All, &mut contours);
    let segments = Segments::new(mesh, adjacency, &contours, options);
    let occluders = {
        let _stage = Stage::new("sorting faces");
        Occluders::new(mesh, adjacency)
    };
    let _stage = Stage::new("finding what is visible");
    let mut drawing = Drawing::new(&occluders, &segments, camera, &VisibilityParams::default());
    drawing.layers.retain(|layer| classes.iter().any(|&class| layer.class == class.into()));
    drawing
}

fn options(args: &LineArgs) -> Result<LineOptions, String> {
    if !(0.0..=180.0).contains(&args.crease_angle) {
        return Err(format!("--crease-angle: {} is not within 0 and 180", args.crease_angle));
    }
    let crease = args.lines.contains(&Class::Crease);
    Ok(LineOptions {
        boundary: args.lines.contains(&Class::Boundary),
        crease_angle: crease.then(|| args.crease_angle.to_radians()),
    })
}

fn style(args: &LineArgs) -> Result<Style, String> {
    if args.width <= 0.0 || args.width > 1000.0 {
        return Err(format!("--width: {} is not above 0 and at most 1000 pixels", args.width));
    }
    let background = match args.background.as_deref() {
        None | Some("none") => None,
        Some(text) => Some(color("--background", text)?),
    };
    Ok(Style {
        width: args.width,
        color: color("--color", &args.color)?,
        background,
        hidden: match args.hidden {
            Hidden::None => HiddenLines::None,
            Hidden::Dashed => HiddenLines::Dashed,
            Hidden::Solid => HiddenLines::Solid,
        },
    })
}

fn color(option: &str, text: &str) -> Result<Color, String> {
    let [red, green, blue, alpha] = csscolorparser::parse(text)
        .map_err(|_| format!("{option}: '{text}' is no CSS colour, as black, #1a2b3c"))?
        .to_rgba8();
    Ok(Color { red, green, blue, alpha })
}

fn format_of(path: &Path) -> Result<Format, String> {
    match path.extension() {
        _ if path == Path::new("-") => Ok(Format::Svg),
        Some(extension) if extension.eq_ignore_ascii_case("svg") => Ok(Format::Svg),
        Some(extension) if extension.eq_ignore_ascii_case("png") => Ok(Format::Png),
        _ => Err(format!("{}: a picture's name ends in .svg or .png", path.display())),
    }
}

fn drawn(drawing: &Drawing) -> BTreeMap<&'static str, Drawn> {
    let count = |layer: &Layer| Drawn {
        chains: layer.chains,
        segments: layer.segments,
        visible_length: layer.visible_length(),
        hidden_length: layer.hidden_length(),
    };
    drawing.layers.iter().map(|layer| (layer.class.name(), count(layer))).collect()
}
