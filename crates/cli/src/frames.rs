//! `draw --frames`: pictures of a model that moves, or that the view goes around.

use std::borrow::Cow;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use clap::{Args, ValueEnum};
use drypoint_fusion::{PatchSet, mesh_hash};
use drypoint_lines::{Camera, Style};
use drypoint_mesh::rig::Pose;
use drypoint_mesh::{Aabb, Mesh};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::Serialize;
use xxhash_rust::xxh3::Xxh3;

use crate::animation;
use crate::args::{DrawArgs, number};
use crate::draw::{self, Format, Scene, Surface};
use crate::folder::{Folder, Manifest};
use crate::gpu;
use crate::output::{print_json, tell};
use crate::progress::Stage;
use crate::show::Shown;
use crate::source::{Source, stem};
use crate::view::{self, Points};

/// Frames a second, unless the user says otherwise.
const FPS: f64 = 30.0;

/// Most frames of one film: an hour of an animation.
const MOST_FRAMES: usize = 108_000;

/// Which frames to draw, and where.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Frames")]
pub(crate) struct FrameArgs {
    /// Draw many pictures, DIR/frame-0000.svg and so on: --animation from its begin to its end, the
    /// turn of --turntable, or both. Frames that are there already are kept if the same command drew
    /// them, so that what was cut off goes on
    #[arg(long, value_name = "DIR", visible_alias = "animation-frames", conflicts_with = "output")]
    pub(crate) frames: Option<std::path::PathBuf>,
    /// Frames for each second of the animation [default: 30]
    #[arg(long, value_name = "N", value_parser = number, requires = "animation")]
    #[arg(allow_hyphen_values = true, conflicts_with = "time")]
    pub(crate) fps: Option<f64>,
    /// Go around the model in N frames, to the right, from where the view begins. The animation
    /// plays meanwhile, again and again, or stands still at --time
    #[arg(long, value_name = "N")]
    pub(crate) turntable: Option<usize>,
    /// What the frames are [default: svg; png with --method wgpu or ash]
    #[arg(long, value_enum)]
    pub(crate) format: Option<FrameFormat>,
    /// Draw all frames anew; frames of another command in DIR are removed
    #[arg(long)]
    pub(crate) overwrite: bool,
}

impl FrameArgs {
    /// Refuses what is for frames where none are asked for. `requires` would not, beside an `--output`
    /// that rules frames out.
    pub(crate) fn check_without(&self) -> Result<(), String> {
        let given = [
            ("--fps", self.fps.is_some()),
            ("--turntable", self.turntable.is_some()),
            ("--format", self.format.is_some()),
            ("--overwrite", self.overwrite),
        ];
        let first = given.into_iter().find(|(_, is_given)| *is_given);
        first.map_or(Ok(()), |(option, _)| Err(format!("{option}: is for --frames DIR")))
    }
}

/// The kind of file that a frame is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FrameFormat {
    Svg,
    Png,
}

/// What was done, in the shape that scripts read.
#[derive(Debug, Serialize)]
struct Report {
    frames: usize,
    drawn: usize,
    kept: usize,
    /// Of those drawn.
    blank: usize,
}

/// One picture.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    /// Index of its pose.
    pose: usize,
    /// Degrees by which the view has gone around the model.
    turn: f64,
}

/// What a film shows when.
#[derive(Debug)]
struct Plan {
    /// Empty for a model that cannot move.
    poses: Vec<Pose>,
    frames: Vec<Frame>,
}

pub(crate) fn run(args: &DrawArgs, folder: &Path) -> Result<(), String> {
    let look = Look::new(args)?;
    let mut folder = Folder::check(folder)?;
    look.format.check_room(args.view.size)?;
    let (source, loaded) =
        Source::load_with_patches(&args.model, args.mesh.as_deref(), args.read, args.work())?;
    if loaded.is_some() {
        args.animation.check_patches(&args.model)?;
    }
    let plan = plan(args, &source, loaded.is_some())?;
    let surfaces = Surfaces { source: &source, poses: &plan.poses };
    let (hashes, center) = surfaces.measure()?;
    let cameras = match args.frames.turntable {
        Some(_) => {
            let turns: Vec<f64> = plan.frames.iter().map(|frame| frame.turn).collect();
            view::turntable(&args.view, center, &turns, |frame| {
                surfaces.mesh(plan.frames[frame].pose)
            })?
        }
        None => {
            let camera = view::camera(&args.view, &All { surfaces: &surfaces, center })?;
            vec![camera; plan.frames.len()]
        }
    };
    let patches = match loaded {
        Some(patches) => Some(draw::chosen(args, patches)?),
        None if look.shown.is_some() => Some(surfaces.patches(args)?),
        None => None,
    };
    let manifest = Manifest {
        drypoint: env!("CARGO_PKG_VERSION").to_owned(),
        model: stem(&args.model),
        frames: plan.frames.len(),
        format: look.format.extension().to_owned(),
        key: key(args, &look, (&source, patches.as_ref()), (&hashes, &cameras)),
    };
    let kept = folder.open(&manifest, args.frames.overwrite)?;
    let film = Film { args, look, surfaces, plan: &plan, cameras, patches, folder, kept };
    film.draw()
}

/// What the frames are to show, in order.
fn plan(args: &DrawArgs, source: &Source, has_patches: bool) -> Result<Plan, String> {
    let animation = args.animation.find(source)?;
    // Patches are those of the mesh as it was read.
    let rig = source.model.rig.as_ref().filter(|_| !has_patches);
    let turns = args.frames.turntable;
    let plays = animation.filter(|_| args.animation.time.is_none());
    let plays = plays.and_then(|animation| Some((rig?, animation)));
    let duration = plays.map_or(0.0, |(rig, animation)| rig.animations()[animation].duration());
    let fps = args.frames.fps.unwrap_or(FPS);
    if !(1e-3..=1e3).contains(&fps) {
        return Err(format!("--fps: {fps} is not within 0.001 and 1000"));
    }
    let count = match (turns, plays) {
        (Some(turns), _) => turns,
        (None, Some(_)) => animation::frames_of(duration, fps),
        (None, None) if animation.is_some() => {
            return Err("--time: is one moment; leave it out, or add --turntable".to_owned());
        }
        (None, None) => {
            return Err("--frames: needs an --animation to play, or --turntable".to_owned());
        }
    };
    if !(1..=MOST_FRAMES).contains(&count) {
        let option = if turns.is_some() { "--turntable" } else { "--fps" };
        return Err(format!("{option}: {count} is no number of frames from 1 to {MOST_FRAMES}"));
    }
    let turn = |frame: usize| turns.map_or(0.0, |turns| 360.0 * frame as f64 / turns as f64);
    let Some((rig, animation)) = plays else {
        let still = if has_patches { None } else { args.animation.pose(source)? };
        let frames = (0..count).map(|frame| Frame { pose: 0, turn: turn(frame) }).collect();
        return Ok(Plan { poses: still.into_iter().collect(), frames });
    };
    let time = |frame: usize| match (frame as f64 / fps, turns) {
        (time, Some(_)) if duration > 0.0 => time.rem_euclid(duration),
        (time, _) => time,
    };
    Ok(Plan {
        poses: (0..count).map(|frame| rig.pose_at(animation, time(frame))).collect(),
        frames: (0..count).map(|frame| Frame { pose: frame, turn: turn(frame) }).collect(),
    })
}

/// How frames look, checked before the model is read.
struct Look {
    style: Style,
    shown: Option<Shown>,
    format: Format,
}

impl Look {
    fn new(args: &DrawArgs) -> Result<Self, String> {
        let style = draw::style(&args.lines)?;
        args.lines.check()?;
        let shown = draw::shown(args)?;
        let plays = args.animation.animation.is_some() && args.animation.time.is_none();
        if shown.is_some() && plays {
            return Err("--show: patches are those of one pose; give its --time".to_owned());
        }
        let format = match (args.frames.format, args.method.api()) {
            (Some(FrameFormat::Svg), Some(api)) => {
                return Err(format!("--format: --method {api} draws png alone"));
            }
            (Some(FrameFormat::Svg), None) | (None, None) => Format::Svg,
            (Some(FrameFormat::Png), _) | (None, Some(_)) => Format::Png,
        };
        if let Some(api) = args.method.api() {
            api.check_feature()?;
            api.check_options(args)?;
        }
        Ok(Self { style, shown, format })
    }
}

/// A number that tells these pictures from others: of all that decides what is in them.
fn key(
    args: &DrawArgs,
    look: &Look,
    (source, patches): (&Source, Option<&PatchSet>),
    (hashes, cameras): (&[u64], &[Camera]),
) -> String {
    let mut hash = Xxh3::new();
    let options = (&args.method, &args.lines, args.show, args.edges, &args.fusion, look.format);
    let names = (&source.model.parts, &source.model.materials, stem(&args.model));
    let version = env!("CARGO_PKG_VERSION");
    hash.update(format!("{:?}", (version, options, names, hashes, cameras)).as_bytes());
    if let Some(patches) = patches {
        hash.update(&patches.to_bytes());
    }
    format!("{:032x}", hash.digest128())
}

/// A model in the poses of a film.
#[derive(Clone, Copy)]
struct Surfaces<'a> {
    source: &'a Source,
    /// Empty for one that cannot move.
    poses: &'a [Pose],
}

impl<'a> Surfaces<'a> {
    /// The model in a pose.
    fn posed(&self, pose: usize) -> Result<Option<Source>, String> {
        self.poses.get(pose).map(|pose| self.source.posed(pose)).transpose()
    }

    /// Its surface; nothing if that cannot be, which [`Self::measure`] refuses.
    fn mesh(&self, pose: usize) -> Cow<'a, Mesh> {
        match self.poses.get(pose).zip(self.source.model.rig.as_ref()) {
            Some((pose, rig)) => Cow::Owned(rig.mesh(pose).unwrap_or_default()),
            None => Cow::Borrowed(self.source.mesh()),
        }
    }

    /// For each pose a number that tells its surface from others, and the middle of the box around
    /// all. What cannot be drawn is told before anything is.
    fn measure(&self) -> Result<(Vec<u64>, DVec3), String> {
        let _stage = Stage::new("measuring");
        let measure = |pose: usize| {
            let posed = self.posed(pose).map_err(|why| format!("{why} (frame {pose})"))?;
            let mesh = posed.as_ref().unwrap_or(self.source).mesh();
            Ok((mesh_hash(mesh), mesh.bounds()))
        };
        let found: Result<Vec<_>, String> =
            (0..self.poses.len().max(1)).into_par_iter().map(measure).collect();
        let (hashes, bounds): (Vec<u64>, Vec<Option<Aabb>>) = found?.into_iter().unzip();
        let all = bounds
            .into_iter()
            .flatten()
            .reduce(|a, b| Aabb { min: a.min.min(b.min), max: a.max.max(b.max) });
        let none = Aabb { min: Vec3::ZERO, max: Vec3::ZERO };
        Ok((hashes, all.unwrap_or(none).center()))
    }

    /// Builds the patches of the only pose.
    fn patches(&self, args: &DrawArgs) -> Result<PatchSet, String> {
        let posed = self.posed(0)?;
        let source = posed.as_ref().unwrap_or(self.source);
        draw::build(args, source, &source.adjacency())
    }
}

/// A model in all poses of a film at once.
struct All<'a> {
    surfaces: &'a Surfaces<'a>,
    center: DVec3,
}

impl Points for All<'_> {
    fn center(&self) -> DVec3 {
        self.center
    }

    fn points(&self) -> impl Iterator<Item = DVec3> {
        let poses = 0..self.surfaces.poses.len().max(1);
        // One surface in memory at a time.
        poses.flat_map(|pose| view::corners(self.surfaces.mesh(pose)))
    }
}

/// A film about to be drawn.
struct Film<'a> {
    args: &'a DrawArgs,
    look: Look,
    surfaces: Surfaces<'a>,
    plan: &'a Plan,
    cameras: Vec<Camera>,
    patches: Option<PatchSet>,
    folder: Folder,
    /// Which frames are there already.
    kept: Vec<bool>,
}

/// Frames done so far.
struct Tally {
    stage: Stage,
    done: usize,
    blank: usize,
}

impl Film<'_> {
    fn draw(&self) -> Result<(), String> {
        let frames = self.plan.frames.len();
        let kept = self.kept.iter().filter(|&&kept| kept).count();
        let stage = Stage::with_length("drawing frames", frames as u64);
        stage.set(kept as u64);
        let tally = Mutex::new(Tally { stage, done: kept, blank: 0 });
        let poses = 0..self.surfaces.poses.len().max(1);
        poses.into_par_iter().try_for_each(|pose| self.draw_pose(pose, &tally))?;
        let Tally { stage, blank, .. } = tally.into_inner().unwrap_or_else(PoisonError::into_inner);
        drop(stage);
        let folder = self.folder.name();
        if blank > 0 {
            tell(&format!("drypoint: no line is visible in {blank} frames of {folder}"));
        }
        let drawn = frames - kept;
        if self.args.json {
            return print_json(&Report { frames, drawn, kept, blank });
        }
        let there = if kept > 0 { format!(", {kept} were there") } else { String::new() };
        let frames = if drawn == 1 { "frame" } else { "frames" };
        tell(&format!("drypoint: drew {drawn} {frames} in {folder}{there}"));
        Ok(())
    }

    /// Draws the frames that show one pose.
    fn draw_pose(&self, pose: usize, tally: &Mutex<Tally>) -> Result<(), String> {
        let numbers = 0..self.plan.frames.len();
        let is_wanted = |&n: &usize| self.plan.frames[n].pose == pose && !self.kept[n];
        let wanted: Vec<usize> = numbers.filter(is_wanted).collect();
        if wanted.is_empty() {
            return Ok(());
        }
        let posed = self.surfaces.posed(pose)?;
        let source = posed.as_ref().unwrap_or(self.surfaces.source);
        let adjacency = source.adjacency_in_silence();
        let scene =
            |frame: usize| Scene { source, adjacency: &adjacency, camera: &self.cameras[frame] };
        let Look { style, shown, format } = &self.look;
        let patches = self.patches.as_ref();
        if let Some(api) = self.args.method.api() {
            // One after the other: they share one GPU.
            return wanted.iter().try_for_each(|&frame| {
                let picture = gpu::draw(api, &scene(frame), patches, style)?;
                self.write(frame, &picture, false, tally)
            });
        }
        let surface = Surface::new(source, &adjacency, &self.args.lines);
        wanted.par_iter().try_for_each(|&frame| {
            let drawing = scene(frame).draw(&surface, (patches, *shown), &self.args.lines);
            let picture = draw::ink(&drawing, (style, *format), &stem(&self.args.model))?;
            self.write(frame, &picture, draw::is_blank(&drawing), tally)
        })
    }

    /// Writes a frame, one at a time: Ctrl-C removes one file that is not whole.
    fn write(
        &self,
        frame: usize,
        picture: &[u8],
        is_blank: bool,
        tally: &Mutex<Tally>,
    ) -> Result<(), String> {
        let mut tally = tally.lock().unwrap_or_else(PoisonError::into_inner);
        self.folder.write(frame, picture)?;
        tally.done += 1;
        tally.blank += usize::from(is_blank);
        tally.stage.set(tally.done as u64);
        Ok(())
    }
}
