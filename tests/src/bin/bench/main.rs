//! `cargo xtask bench`: what extractors cost and gain, as one report. Runs alone, too.
#![allow(clippy::print_stdout, reason = "the report is what this program is for")]

mod calibrate;
mod contenders;
mod decompositions;
mod documents;
mod drawing;
mod floor;
mod gpu;
mod kept;
mod machine;
mod measure;
mod readers;
mod vulkan;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum, value_parser};
use drypoint_mesh::{io, shapes};
use drypoint_tests::models;
use drypoint_tests::report::{Report, blocks, page};

use crate::kept::Kept;

/// Compares every extractor with the definition, then counts and times it, on mesh files, or on those
/// of the folder that DRYPOINT_MODELS names, or on built-in shapes. Writes report.html, which needs no
/// other file, and report.json. A run that was cut off goes on where it was.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask bench", version)]
struct Options {
    /// Folder for the report, and for what is kept of a run that is cut off
    #[arg(short, long, value_name = "FOLDER", default_value = "drypoint-report")]
    output: PathBuf,
    /// Small meshes, few rounds and cheap methods: within three minutes
    #[arg(long)]
    quick: bool,
    /// Interleaved rounds of what is timed [default: 7, and 2 with --quick]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1000))]
    rounds: Option<u32>,
    /// Only these, in the report; may be given several times
    #[arg(long, value_name = "SECTION", value_enum)]
    only: Vec<Section>,
    /// Measure anew what an earlier run has kept
    #[arg(long)]
    fresh: bool,
    /// Also write what was measured to docs/measurements.json of this repository, and into the
    /// marked tables of its documents, all of whose meshes must be given. With --only gpu and --only
    /// gpu-calibration, with --only vulkan or with --only readers, or for the report of such a run, the
    /// rest stays as it is
    #[arg(long, value_name = "REPOSITORY")]
    docs: Option<PathBuf>,
    /// Measure nothing: make the page and the tables from a report.json, or from the repository's
    /// docs/measurements.json, which has few plots
    #[arg(long, value_name = "REPORT", conflicts_with_all = ["quick", "rounds", "only", "fresh", "files"])]
    from: Option<PathBuf>,
    /// Mesh files; those that are not found here are looked for in the folder of DRYPOINT_MODELS
    #[arg(value_name = "MESH FILE")]
    files: Vec<PathBuf>,
}

/// A part of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Section {
    /// The published method, by the size of its groups
    Partitions,
    /// Patches, meshlets and hierarchies: what each tests
    Decompositions,
    /// What the cost model is made of
    Calibration,
    /// Times of a view
    Times,
    /// A drawing, stage by stage
    Drawing,
    /// Extraction on a GPU, and frames
    Gpu,
    /// What the cost model is made of on a GPU, by the width of workgroups
    GpuCalibration,
    /// Frames in Vulkan, by task and mesh shaders and by compute shaders
    Vulkan,
    /// Reading files, beside other readers
    Readers,
}

impl Options {
    fn rounds(&self) -> u32 {
        self.rounds.unwrap_or(if self.quick { 2 } else { 7 })
    }

    fn wants(&self, section: Section) -> bool {
        self.only.is_empty() || self.only.contains(&section)
    }
}

/// Models of a quick run, of those that there are.
const QUICK_MODELS: [&str; 2] = ["spot", "stanford-bunny"];

/// Faces of the built-in shapes that stand in where there is no model.
const SHAPE_FACES: usize = 20_000;

fn main() -> ExitCode {
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("bench: {why}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    if let Some(path) = &options.from {
        return finish(options, &read(path)?);
    }
    let files = files(options)?;
    if let Some(repository) = &options.docs {
        // Now, and not after all has been measured.
        documents::check(repository, options, &files)?;
    }
    let kept = Kept::new(options)?;
    let devices = Devices { gpu: gpu::device(options)?, vulkan: vulkan::device(options)? };
    let mut meshes = Vec::new();
    // Readers need no mesh but in files.
    let is_of_readers_alone = options.only == [Section::Readers];
    for path in files.iter().filter(|_| !is_of_readers_alone) {
        let model = io::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
        meshes.push(measure::mesh(&name(path), &model.mesh, options, (&kept, &devices))?);
    }
    if files.is_empty() && !is_of_readers_alone {
        for name in ["bumpy-sphere", "torus-knot", "cad-part"] {
            let mesh = shapes::by_name(name, SHAPE_FACES).ok_or(format!("no shape {name}"))?;
            meshes.push(measure::mesh(name, &mesh, options, (&kept, &devices))?);
        }
    }
    let reading = readers::measure(&kept, options, &files)?;
    kept.finish();
    let run = machine::run(options);
    let gpu = devices.gpu.map(|gpu| gpu::run(&gpu, run.clone()));
    let vulkan = devices.vulkan.map(|gpu| vulkan::run(&gpu, run.clone()));
    finish(options, &Report { machine: machine::machine(), run, meshes, gpu, vulkan, reading })
}

/// GPUs that are wanted and there.
struct Devices {
    gpu: Option<drypoint_wgpu::Gpu>,
    vulkan: Option<drypoint_ash::Gpu>,
}

/// A report of an earlier run.
fn read(path: &Path) -> Result<Report, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: no report: {error}", path.display()))
}

/// Mesh files to measure; none for the built-in shapes.
fn files(options: &Options) -> Result<Vec<PathBuf>, String> {
    let files = if options.files.is_empty() {
        let mut files = models::files()?;
        files.retain(|path| !options.quick || QUICK_MODELS.contains(&&*name(path)));
        if options.quick && files.is_empty() {
            eprintln!("bench: neither of {} is there: built-in shapes", QUICK_MODELS.join(" and "));
        }
        files
    } else {
        let folder = std::env::var_os(models::VARIABLE).map(PathBuf::from).unwrap_or_default();
        let find = |file: &PathBuf| {
            let model = folder.join(file);
            if !file.exists() && model.is_file() { model } else { file.clone() }
        };
        options.files.iter().map(find).collect()
    };
    let mut names: Vec<String> = files.iter().map(|path| name(path)).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(format!("two meshes have the name {}", pair[0])),
        None => Ok(files),
    }
}

/// Of a mesh in the report.
fn name(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Writes the report, each file whole or not at all.
fn finish(options: &Options, report: &Report) -> Result<(), String> {
    let fail = |error: std::io::Error| format!("{}: {error}", options.output.display());
    fs::create_dir_all(&options.output).map_err(fail)?;
    let html = page(report)?;
    let json = serde_json::to_string(report).map_err(|error| error.to_string())?;
    write(&options.output.join("report.json"), &json)?;
    let path = options.output.join("report.html");
    write(&path, &html)?;
    if let Some(repository) = &options.docs {
        documents::update(repository, report.clone())?;
    }
    for (name, block) in blocks(report) {
        println!("{name}\n\n{block}");
    }
    println!("{}", path.display());
    Ok(())
}

/// By way of a second file, so that nothing is ever half-written.
fn write(path: &Path, text: &str) -> Result<(), String> {
    let fail = |error: std::io::Error| format!("{}: {error}", path.display());
    let part = path.with_extension("part");
    fs::write(&part, text).map_err(fail)?;
    fs::rename(&part, path).map_err(fail)
}
