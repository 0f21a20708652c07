//! `drypoint draw`: from a model to a picture.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use drypoint_cpu::extract_patches;
use drypoint_fusion::PatchSet;
use drypoint_lines::{
    Camera, Color, Drawing, HiddenLines, Layer, LineClass, Occluders, Segments, Style,
    VisibilityParams, filter_for_drawing, to_png, to_svg,
};
use drypoint_mesh::{EdgeFilter, EdgeId, MeshAdjacency, contour_edges};
use serde::Serialize;

use crate::args::{DrawArgs, Show};
use crate::frames;
use crate::gpu::{self, Api};
use crate::lines::{self, Drawn, Hidden, Lengths, LineArgs, Lines};
use crate::memory;
use crate::output::{Output, print_json, tell};
use crate::patches;
use crate::progress::Stage;
use crate::show::{self, Shown};
use crate::source::{self, Source};
use crate::view;

/// Pixels below which a visible piece of line is a speck, unless the user says otherwise.
const SPECKS: f64 = 6.0;

/// What is on the page, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Report {
    #[serde(flatten)]
    lines: BTreeMap<&'static str, Drawn>,
    #[serde(skip_serializing_if = "Option::is_none")]
    parts: Option<Lengths>,
    #[serde(skip_serializing_if = "Option::is_none")]
    materials: Option<Lengths>,
    #[serde(skip_serializing_if = "Option::is_none")]
    patches: Option<show::Counts>,
}

/// The kind of file that a picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Svg,
    Png,
}

impl Format {
    /// How the names of its files end.
    pub(crate) fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }

    /// Refuses a picture of so many pixels that does not fit in memory.
    pub(crate) fn check_room(self, size: [u32; 2]) -> Result<(), String> {
        match self {
            Self::Svg => Ok(()),
            Self::Png => memory::check_picture(size),
        }
    }
}

pub(crate) fn run(args: &DrawArgs) -> Result<(), String> {
    if let Some(folder) = &args.frames.frames {
        return frames::run(args, folder);
    }
    args.frames.check_without()?;
    let style = style(&args.lines)?;
    args.lines.check()?;
    let shown = shown(args)?;
    if let Some(api) = args.method.api() {
        return run_on_gpu(api, args, &style);
    }
    let path = match &args.output {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.svg", source::stem(&args.model))),
    };
    if args.json && path == Path::new("-") {
        return Err("--json: standard output takes the picture or the JSON, not both".to_owned());
    }
    // A place that cannot be written is told before the work, not after.
    let (format, output) = (format_of(&path)?, Output::open(&path)?);
    format.check_room(args.view.size)?;
    let (source, loaded) = load(args)?;
    let camera = view::camera(&args.view, source.mesh())?;
    let adjacency = visible_adjacency(&source)?;
    let patches = match loaded {
        None if shown.is_some() => Some(build(args, &source, &adjacency)?),
        Some(patches) => Some(chosen(args, patches)?),
        None => None,
    };
    let scene = Scene { source: &source, adjacency: &adjacency, camera: &camera };
    let surface = {
        let _stage = Stage::new("sorting faces");
        Surface::new(&source, &adjacency, &args.lines)
    };
    let drawing = {
        let _stage = Stage::new("finding what is visible");
        scene.draw(&surface, (patches.as_ref(), shown), &args.lines)
    };
    tell_if_blank(&drawing, &source.name);
    let picture = {
        let _stage = Stage::new("inking");
        ink(&drawing, (&style, format), &source::stem(&args.model))?
    };
    // First what may fail, so that no picture is left behind by a run that did.
    if args.json {
        let patches = patches.as_ref().filter(|_| shown.is_some());
        let patches = patches.map(|patches| show::counts(patches, camera.viewpoint()));
        let lengths = surface.lines.names_owners(&source).then(|| lines::lengths(&drawing));
        let [parts, materials] = lengths.map_or([None, None], |lengths| lengths.map(Some));
        print_json(&Report { lines: lines::drawn(&drawing), parts, materials, patches })?;
    }
    output.write(&picture)?;
    if args.output.is_none() {
        tell(&format!("drypoint: wrote {}", path.display()));
    }
    Ok(())
}

/// Draws with a GPU, which has its own way of finding what is visible.
fn run_on_gpu(api: Api, args: &DrawArgs, style: &Style) -> Result<(), String> {
    api.check_feature()?;
    api.check_options(args)?;
    let path = match &args.output {
        Some(path) => path.clone(),
        None => PathBuf::from(format!("{}.png", source::stem(&args.model))),
    };
    if format_of(&path)? != Format::Png {
        return Err(format!("{}: --method {api} draws .png alone", path.display()));
    }
    let output = Output::open(&path)?;
    Format::Png.check_room(args.view.size)?;
    let (source, patches) = load(args)?;
    let camera = view::camera(&args.view, source.mesh())?;
    let adjacency = visible_adjacency(&source)?;
    let patches = patches.map(|patches| chosen(args, patches)).transpose()?;
    let picture = {
        let _stage = Stage::new("drawing");
        let scene = Scene { source: &source, adjacency: &adjacency, camera: &camera };
        gpu::draw(api, &scene, patches.as_ref(), style)?
    };
    output.write(&picture)?;
    if args.output.is_none() {
        tell(&format!("drypoint: wrote {}", path.display()));
    }
    Ok(())
}

/// The model in the pose that is asked for, and its patches if it comes with some. Those are of the mesh
/// as it was read, any other that can move is drawn through its rig.
fn load(args: &DrawArgs) -> Result<(Source, Option<PatchSet>), String> {
    let (source, patches) =
        Source::load_with_patches(&args.model, args.mesh.as_deref(), args.read, args.work())?;
    if patches.is_some() {
        args.animation.check_patches(&args.model)?;
        return Ok((source, patches));
    }
    Ok((source.in_pose(&args.animation)?, None))
}

/// The edges of a mesh of which something can be seen.
fn visible_adjacency(source: &Source) -> Result<MeshAdjacency, String> {
    let adjacency = source.adjacency();
    if adjacency.report().degenerate == adjacency.report().faces {
        return Err(format!("{}: no face has any area, so there is nothing to see", source.name));
    }
    Ok(adjacency)
}

/// What of the decomposition is asked for; options that would change nothing are refused.
pub(crate) fn shown(args: &DrawArgs) -> Result<Option<Shown>, String> {
    let shown = match args.show {
        Show::Lines => None,
        Show::Patches => Some(Shown::Patches),
        Show::Survivors => Some(Shown::Survivors),
    };
    let edges = args.edges.map(|_| "--edges");
    if let Some(option) = args.fusion.first_given().or(edges).filter(|_| shown.is_none()) {
        return Err(format!("{option}: is for --show patches and --show survivors"));
    }
    if shown.is_some() {
        // What contradicts itself is told before the mesh is read.
        args.fusion.params()?;
    }
    Ok(shown)
}

/// Builds patches to show.
pub(crate) fn build(
    args: &DrawArgs,
    source: &Source,
    adjacency: &MeshAdjacency,
) -> Result<PatchSet, String> {
    let filter = args.edges.map_or(EdgeFilter::Convex, Into::into);
    patches::build(source, adjacency, filter, &args.fusion)
}

/// The patches of a file, if no option asks for others.
pub(crate) fn chosen(args: &DrawArgs, patches: PatchSet) -> Result<PatchSet, String> {
    match args.fusion.first_given() {
        Some(option) => {
            Err(format!("{option}: the patches of {} are built already", args.model.display()))
        }
        None => source::holding(patches, args.edges, &args.model),
    }
}

/// What of a surface is the same from wherever it is looked at.
pub(crate) struct Surface<'a> {
    lines: Lines,
    occluders: Occluders<'a>,
}

impl<'a> Surface<'a> {
    /// Finds it, without progress: maybe one of many.
    pub(crate) fn new(source: &'a Source, adjacency: &'a MeshAdjacency, args: &LineArgs) -> Self {
        let lines = Lines::new(source, adjacency, args);
        Self { lines, occluders: Occluders::new(source.mesh(), adjacency) }
    }
}

/// What is drawn, and from where.
pub(crate) struct Scene<'a> {
    pub(crate) source: &'a Source,
    pub(crate) adjacency: &'a MeshAdjacency,
    pub(crate) camera: &'a Camera,
}

impl Scene<'_> {
    /// Finds the lines, what of them is visible, and what of the decomposition.
    pub(crate) fn draw(
        &self,
        surface: &Surface<'_>,
        (patches, shown): (Option<&PatchSet>, Option<Shown>),
        args: &LineArgs,
    ) -> Drawing {
        let Self { adjacency, camera, .. } = *self;
        let mesh = self.source.mesh();
        let wanted = args.holds(LineClass::Contour);
        let contours = if wanted { self.contours(patches) } else { Vec::new() };
        let Surface { lines, occluders } = surface;
        let segments = Segments::new(mesh, adjacency, &contours, &lines.options(args));
        let params =
            VisibilityParams { drop_specks: args.specks.unwrap_or(SPECKS), ..Default::default() };
        let mut drawing = Drawing::new(occluders, &segments, camera, &params);
        lines.finish(&mut drawing, self.source, camera.viewpoint(), args);
        if let (Some(shown), Some(patches)) = (shown, patches) {
            drawing.areas = show::areas(patches, occluders, adjacency, camera, shown);
        }
        drawing
    }

    /// The contour edges that a drawing needs. From the patches where they hold all of those; the
    /// mesh says the same.
    fn contours(&self, patches: Option<&PatchSet>) -> Vec<EdgeId> {
        let (mesh, viewpoint) = (self.source.mesh(), self.camera.viewpoint());
        let filter = filter_for_drawing(mesh, self.adjacency, viewpoint);
        let mut contours = Vec::new();
        match patches.filter(|patches| [EdgeFilter::All, filter].contains(&patches.edge_filter())) {
            Some(patches) => {
                extract_patches(patches, viewpoint, &mut contours);
                contours.retain(|&edge| self.adjacency.keeps(edge, filter));
            }
            None => contour_edges(mesh, self.adjacency, viewpoint, filter, &mut contours),
        }
        contours
    }
}

pub(crate) fn style(args: &LineArgs) -> Result<Style, String> {
    if !(0.05..=1000.0).contains(&args.width) {
        return Err(format!("--width: {} is not within 0.05 and 1000 pixels", args.width));
    }
    if let Some(specks) = args.specks.filter(|&specks| specks < 0.0) {
        return Err(format!("--specks: {specks} is below 0"));
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
        .map_err(|_| format!("{option}: '{text}' is no CSS color, as black, #1a2b3c"))?
        .to_rgba8();
    Ok(Color { red, green, blue, alpha })
}

/// Whether nothing is on the page.
pub(crate) fn is_blank(drawing: &Drawing) -> bool {
    let is_blank = |layer: &Layer| layer.visible_length() == 0.0;
    drawing.layers.iter().all(is_blank) && drawing.areas.is_empty()
}

/// Says that there are no lines, or that none can be seen.
fn tell_if_blank(drawing: &Drawing, name: &str) {
    let has_none = drawing.layers.iter().all(|layer| layer.segments == 0);
    if has_none && drawing.areas.is_empty() {
        tell(&format!("drypoint: {name} has no such line from here"));
    } else if is_blank(drawing) {
        tell(&format!("drypoint: no line of {name} is visible on the page"));
    }
}

/// The picture as a file.
pub(crate) fn ink(
    drawing: &Drawing,
    (style, format): (&Style, Format),
    title: &str,
) -> Result<Vec<u8>, String> {
    match format {
        Format::Svg => Ok(to_svg(drawing, style, title).into_bytes()),
        Format::Png => to_png(drawing, style).map_err(|error| error.to_string()),
    }
}

fn format_of(path: &Path) -> Result<Format, String> {
    match path.extension() {
        _ if path == Path::new("-") => Ok(Format::Svg),
        Some(extension) if extension.eq_ignore_ascii_case("svg") => Ok(Format::Svg),
        Some(extension) if extension.eq_ignore_ascii_case("png") => Ok(Format::Png),
        _ => Err(format!("{}: a picture's name ends in .svg or .png", path.display())),
    }
}
