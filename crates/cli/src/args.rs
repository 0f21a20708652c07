//! The command line, as `--help` shows it.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use drypoint_mesh::{EdgeFilter, shapes};
use glam::DVec3;

use crate::animation::AnimationArgs;
use crate::frames::FrameArgs;
use crate::fusion::FusionArgs;
use crate::lines::LineArgs;
use crate::memory::Work;
use crate::source::ReadArgs;
use crate::view::ViewArgs;

/// Draws the contours of triangle meshes as clean vectors, hidden lines removed
#[derive(Debug, Parser)]
#[command(name = "drypoint", version, after_help = after_help())]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// The built-in shapes, examples, and what the exit status means.
fn after_help() -> String {
    let shapes = shapes::NAMES.join(", ");
    format!("{MODELS} {shapes}.\n\n{EXAMPLES}")
}

const MODELS: &str = "\
MODEL is an OBJ, PLY, STL, glTF or GLB file, or shape:NAME[:TRIANGLES] for a built-in shape, of \
20000 triangles unless told otherwise, where NAME is one of";

const EXAMPLES: &str = "\
Examples:
  drypoint draw                                      a built-in shape, to torus-knot.svg
  drypoint draw bunny.obj -o bunny.svg
  drypoint extract bunny.obj --eye 0,0.1,2 --json
  drypoint info scan.ply

Exit status: 0, or 1 with one line that says what is wrong; 130 after Ctrl-C.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw the visible lines of a model as SVG or PNG
    Draw(Box<DrawArgs>),
    /// Group the edges of a model into patches and save them
    Patches(PatchesArgs),
    /// Find the contour edges seen from a viewpoint
    Extract(ExtractArgs),
    /// Report what a model is made of
    Info(InfoArgs),
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  drypoint draw bunny.obj -o bunny.svg
  drypoint draw part.stl --lines contour,crease --crease-angle 20 --view iso --ortho --up 0,0,1
  drypoint draw robot.glb --lines all -o robot.svg
  drypoint draw hall.obj --eye 0,2,0 --target 10,2,0 --fov 70 -o hall.png --size 1600x900
  drypoint draw bunny.obj --hidden dashed --azimuth 30 --elevation 20 -o - | rsvg-convert > b.png
  drypoint draw bunny.obj --show patches --preset fast -o bunny.png
  drypoint draw bunny.patches --model bunny.obj --show survivors --view front -o bunny.png
  drypoint draw dragon.ply --method wgpu -o dragon.png
  drypoint draw dragon.ply --method ash -o dragon.png
  drypoint draw robot.glb --animation Walking --time 0.5 -o robot.svg
  drypoint draw robot.glb --animation Walking --frames walk --fps 24 --view left
  drypoint draw part.stl --turntable 60 --frames turn --format png --elevation 20

A model that can move is drawn at rest unless an animation poses it. All frames are drawn by one camera \
that holds what moves in all of them, or from one distance where it goes around the model. Beside the \
frames lies frames.json, by which the same command knows them again.

In an SVG each class of lines is a group, and each path says of which edges it is made, or which pairs \
of faces cross there. Of a model with several parts, or with names of materials, it also says of which \
part and which material, and ends where these do: those of the face in front.

With --json prints one object: for each class of lines chains, segments, visible_length and \
hidden_length in pixels; of such a model the pixels of visible line of each class by the names in \
`parts` and in `materials`; and with --show patches or survivors in `patches` the numbers of edges, \
patches, super_patches, survivors and edges_tested from this view. With --frames: frames, drawn, kept \
(they were there) and blank (of those drawn).")]
pub(crate) struct DrawArgs {
    /// Mesh file, `shape:NAME[:TRIANGLES]`, or a .patches file with --model
    #[arg(default_value = "shape:torus-knot:20000")]
    pub(crate) model: PathBuf,
    /// Picture to write, .svg or .png; - for SVG on standard output [default: MODEL's name, .svg, in
    /// this folder; .png with --method wgpu or ash]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// The mesh that a .patches file was built from: its triangles hide lines
    #[arg(long = "model", value_name = "MESH")]
    pub(crate) mesh: Option<PathBuf>,
    /// What draws
    #[arg(long, value_enum, default_value = "cpu")]
    pub(crate) method: DrawMethod,
    /// What to draw
    #[arg(long, value_enum, default_value = "lines")]
    pub(crate) show: Show,
    /// Print what was drawn as JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) animation: AnimationArgs,
    #[command(flatten)]
    pub(crate) frames: FrameArgs,
    #[command(flatten)]
    pub(crate) lines: LineArgs,
    /// With --show: edges to group, those that can be seen as contours, or all [default: convex, or
    /// those of the .patches file]
    #[arg(long, value_enum, help_heading = "Patches")]
    pub(crate) edges: Option<Edges>,
    #[command(flatten)]
    pub(crate) fusion: FusionArgs,
}

impl DrawArgs {
    /// What is to be done with the mesh.
    pub(crate) fn work(&self) -> Work {
        let is_plain = self.method == DrawMethod::Cpu && self.show == Show::Lines;
        if is_plain { Work::Lines } else { Work::Patches }
    }
}

/// What finds the lines and draws them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DrawMethod {
    /// The processor, by exact predicates
    Cpu,
    /// A GPU, in one frame: visible contours alone, as PNG; no --json, --show, --hidden or --specks
    Wgpu,
    /// As wgpu, by mesh shaders: needs a Vulkan 1.3 driver that has them
    Ash,
}

/// What is on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Show {
    /// Lines alone
    Lines,
    /// Lines over the surface, each edge's share of it in the color of its patch
    Patches,
    /// As patches, but only those that may hold a contour edge from here; the rest is grey
    Survivors,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  drypoint patches bunny.obj -o bunny.patches
  drypoint patches hall.obj -o hall.patches --preset best --profile near --levels 2
  drypoint patches bunny.obj -o bunny.patches --preset paper --bound mean --partition 512 --json
  drypoint extract bunny.patches --eye 0,0.1,2 --json

With --json prints one object: edges, patches, super_patches, always_tested (edges in no patch), \
mean_half_angle and max_half_angle in degrees, mean_t in the file's unit, expected_cost in edge \
tests a view, build_seconds, peak_memory in bytes or null, and what was asked for: preset, profile, \
bound, levels, runtime.

Patches of a model that can move are those of its rest pose; `drypoint extract --animation` builds some \
for each of its rigid parts.")]
pub(crate) struct PatchesArgs {
    /// Mesh file, or `shape:NAME[:TRIANGLES]`
    pub(crate) model: PathBuf,
    /// File to write, ending in .patches
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Print what was built as JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
    /// Edges to group: those that can be seen as contours, or all
    #[arg(long, value_enum, default_value = "convex")]
    pub(crate) edges: Edges,
    #[command(flatten)]
    pub(crate) fusion: FusionArgs,
}

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("viewpoint").required(true).args(["eye", "direction"])))]
#[command(after_help = "\
Examples:
  drypoint extract bunny.obj --eye 0,0.1,2
  drypoint extract bunny.obj --direction 0,0,1 --edges all --json
  drypoint extract bunny.patches --eye 0,0.1,2 --json
  drypoint extract robot.glb --animation Walking --time 0.5 --eye 3,2,9 --method patches

Prints a pair of vertices a line, lower index first, sorted; what was tested goes to standard error. \
With --json prints one object: method, edges, patches, patches_tested, patches_accepted, \
super_patches, super_patches_tested, super_patches_accepted, edges_tested, contour_edges, contour. \
Vertices are counted from 0 in the file's own order (OBJ: v \
lines; STL: three a facet; glTF: as `drypoint info --vertices` lists them), and of several vertices \
at one position the first is named. In a pose of an animation vertices are one if they always are: then \
a pair may stand for two edges that part when the model moves, and edges and patches are those of all its \
rigid parts, with the edges between them.")]
pub(crate) struct ExtractArgs {
    /// Mesh file, `shape:NAME[:TRIANGLES]`, or a .patches file
    pub(crate) model: PathBuf,
    /// Where to look from, in the file's own coordinates
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) eye: Option<DVec3>,
    /// Look without perspective: the direction from the model towards the viewer
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) direction: Option<DVec3>,
    /// How to find them [default: patches for a .patches file, else brute-force]
    #[arg(long, value_enum)]
    pub(crate) method: Option<Method>,
    /// Edges to look at: those that can be seen as contours, or all [default: convex, or those of
    /// the .patches file]
    #[arg(long, value_enum)]
    pub(crate) edges: Option<Edges>,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
    #[command(flatten)]
    pub(crate) animation: AnimationArgs,
    #[command(flatten)]
    pub(crate) fusion: FusionArgs,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Of a glTF file with skins, animations, morph targets, or meshes that are placed more than once, it also \
tells animations, instances, rigid_parts, rigid_shapes, and rigid_share: how much of the edges lies \
between faces that move as one, and so can be grouped into patches.")]
pub(crate) struct InfoArgs {
    /// Mesh file, or `shape:NAME[:TRIANGLES]`
    pub(crate) model: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) read: ReadArgs,
    /// List the position of every vertex, in the order that `extract` counts in
    #[arg(long)]
    pub(crate) vertices: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Tests every edge
    BruteForce,
    /// Tests the edges of patches that may hold a contour edge
    Patches,
    /// As patches, on a GPU: in f32, so that an edge may differ where a face is seen edge-on
    Wgpu,
    /// As wgpu, by mesh shaders: needs a Vulkan 1.3 driver that has them
    Ash,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Edges {
    /// Those that a closed solid can show as contours from outside
    Convex,
    /// Every edge, concave and boundary ones too
    All,
}

impl From<Edges> for EdgeFilter {
    fn from(edges: Edges) -> Self {
        match edges {
            Edges::Convex => Self::Convex,
            Edges::All => Self::All,
        }
    }
}

pub(crate) fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err("the number must be finite".to_owned()),
        Err(_) => Err("this is no number".to_owned()),
    }
}

pub(crate) fn vector(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|n| n.abs() <= f64::from(f32::MAX)) => {
            Ok(DVec3::new(x, y, z))
        }
        [_, _, _] => Err(format!("coordinates must be within ±{:e}", f32::MAX)),
        _ => Err(format!("three numbers with commas are wanted, not {}", numbers.len())),
    }
}
