//! `drypoint draw`: from a model to a picture.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use drypoint_lines::{
    Camera, Color, Drawing, HiddenLines, Layer, LineOptions, Occluders, Segments, Style,
    VisibilityParams, filter_for_drawing, to_png, to_svg,
};
use drypoint_mesh::{MeshAdjacency, contour_edges};
use serde::Serialize;

use crate::args::{Class, DrawArgs, Hidden, LineArgs};
use crate::output::{Output, print_json, tell};
use crate::progress::Stage;
use crate::source::{self, Source};
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
    let path = match &args.output {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.svg", source::stem(&args.model))),
    };
    if args.json && path == Path::new("-") {
        return Err("--json: standard output takes the picture or the JSON, not both".to_owned());
    }
    // A place that cannot be written is told before the work, not after.
    let (format, output) = (format_of(&path)?, Output::open(&path)?);
    let source = Source::load(&args.model)?;
    let camera = view::camera(&args.view, source.mesh())?;
    let adjacency = source.adjacency();
    if adjacency.report().degenerate == adjacency.report().faces {
        return Err(format!("{}: no face has any area, so there is nothing to see", source.name));
    }
    let drawing = trace(&source, &adjacency, &camera, (&args.lines, &options));
    if drawing.layers.iter().all(|layer| layer.visible_length() == 0.0) {
        tell(&format!("drypoint: no line of {} is visible on the page", source.name));
    }
    let picture = match format {
        Format::Svg => to_svg(&drawing, &style, &source.stem).into_bytes(),
        Format::Png => {
            let _stage = Stage::new("rasterising");
            to_png(&drawing, &style).map_err(|error| error.to_string())?
        }
    };
    // First what may fail, so that no picture is left behind by a run that did.
    if args.json {
        print_json(&drawn(&drawing))?;
    }
    output.write(&picture)?;
    if args.output.is_none() {
        tell(&format!("drypoint: wrote {}", path.display()));
    }
    Ok(())
}

/// Finds the lines and what hides them.
fn trace(
    source: &Source,
    adjacency: &MeshAdjacency,
    camera: &Camera,
    (args, options): (&LineArgs, &LineOptions),
) -> Drawing {
    let mesh = source.mesh();
    let mut contours = Vec::new();
    if args.lines.contains(&Class::Contour) {
        let filter = filter_for_drawing(mesh, adjacency, camera.viewpoint());
        contour_edges(mesh, adjacency, camera.viewpoint(), filter, &mut contours);
    }
    let segments = Segments::new(mesh, adjacency, &contours, options);
    let occluders = {
        let _stage = Stage::new("sorting faces");
        Occluders::new(mesh, adjacency)
    };
    let _stage = Stage::new("finding what is visible");
    let params = VisibilityParams { drop_specks: args.specks, ..Default::default() };
    let mut drawing = Drawing::new(&occluders, &segments, camera, &params);
    drawing.layers.retain(|layer| args.lines.iter().any(|&class| layer.class == class.into()));
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
    if !(0.05..=1000.0).contains(&args.width) {
        return Err(format!("--width: {} is not within 0.05 and 1000 pixels", args.width));
    }
    if args.specks < 0.0 {
        return Err(format!("--specks: {} is below 0", args.specks));
    }
    let background = match args.background.as_deref() {
        None => None,
        Some("none") => Some(Color { red: 0, green: 0, blue: 0, alpha: 0 }),
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
