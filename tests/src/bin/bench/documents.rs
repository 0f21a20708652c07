//! The documents of the repository that hold measured tables.

use std::fs;
use std::path::{Path, PathBuf};

use drypoint_tests::report::{DOCUMENTS, Report, SUMMARY, blocks, marks, replace_blocks};

use crate::{Options, Section, name, read, write};

/// Whether this is the repository, and a run on `files` can fill in all of its tables.
pub(crate) fn check(repository: &Path, options: &Options, files: &[PathBuf]) -> Result<(), String> {
    let documents = documents(repository)?;
    let [has_gpu, has_vulkan] = gpu_alone(options);
    let has_readers = options.only == [Section::Readers];
    if options.quick || !(options.only.is_empty() || has_gpu || has_vulkan || has_readers) {
        let sections = "no --only but readers, vulkan, or gpu and gpu-calibration, both of them";
        return Err(format!("--docs takes a whole run: no --quick, and {sections}"));
    }
    let meshes: Vec<String> = files.iter().map(|path| name(path)).collect();
    for (path, text) in &documents {
        let is_filled = |mark: &str| {
            let is_of = |mesh: &String| {
                mark.strip_prefix(&mesh[..]).is_some_and(|table| table.starts_with('-'))
            };
            // The rest stays as it is.
            let is_measured =
                has_gpu && mark.contains("-gpu") || has_vulkan && mark.ends_with("-vulkan");
            let is_kept = has_readers || (has_gpu || has_vulkan) && !is_measured;
            is_kept || !mark.contains('-') || meshes.iter().any(is_of)
        };
        if let Some(mark) = marks(text).find(|mark| !is_filled(mark)) {
            return Err(format!(
                "--docs: no mesh is given for the mark {mark:?} of {}",
                path.display()
            ));
        }
    }
    Ok(())
}

/// Whether nothing is asked for but what is measured on a GPU: with wgpu, in Vulkan, or both.
fn gpu_alone(options: &Options) -> [bool; 2] {
    let kinds = [&[Section::Gpu, Section::GpuCalibration][..], &[Section::Vulkan]];
    let is_of_any = |section: &Section| kinds.iter().any(|kind| kind.contains(section));
    let is_asked = |section: &Section| options.only.contains(section);
    let is_whole = |kind: &&[Section]| kind.iter().all(is_asked) || !kind.iter().any(is_asked);
    let is_alone = options.only.iter().all(is_of_any) && kinds.iter().all(is_whole);
    kinds.map(|kind| is_alone && kind.iter().any(is_asked))
}

/// Writes the summary, and the marked tables. What was measured on a GPU comes from another machine than
/// the rest where only one of both was measured now, and the other is kept.
pub(crate) fn update(repository: &Path, report: Report) -> Result<(), String> {
    let kept = read(&repository.join(SUMMARY));
    if report.is_of_readers_alone() {
        return write_all(repository, &Report { reading: report.reading, ..kept? });
    }
    let reading = kept.as_ref().ok().and_then(|kept| kept.reading.clone());
    let report = Report { reading: report.reading.clone().or(reading), ..report };
    let report = match (report.is_on_gpu_alone(), kept) {
        (true, kept) => kept?.with_gpu_of(&report),
        // What was measured now comes last.
        (false, Ok(kept)) => report.clone().with_gpu_of(&kept).with_gpu_of(&report),
        (false, Err(_)) => report,
    };
    write_all(repository, &report.summary())
}

/// Writes a summary, and the marked tables of all documents.
fn write_all(repository: &Path, report: &Report) -> Result<(), String> {
    let json = serde_json::to_string_pretty(report).map_err(|error| error.to_string())?;
    let blocks = blocks(report);
    let mut written = vec![(repository.join(SUMMARY), json + "\n")];
    for (path, text) in documents(repository)? {
        let text =
            replace_blocks(&text, &blocks).map_err(|why| format!("{}: {why}", path.display()))?;
        written.push((path, text));
    }
    written.iter().try_for_each(|(path, text)| write(path, text))
}

fn documents(repository: &Path) -> Result<Vec<(PathBuf, String)>, String> {
    let read = |document: &&str| {
        let path = repository.join(document);
        let text = fs::read_to_string(&path);
        let text = text.map_err(|error| format!("--docs: {}: {error}", path.display()))?;
        Ok((path, text))
    };
    DOCUMENTS.iter().map(read).collect()
}
