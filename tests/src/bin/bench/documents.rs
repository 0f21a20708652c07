//! The documents of the repository that hold measured tables.

use std::fs;
use std::path::{Path, PathBuf};

use drypoint_tests::report::{DOCUMENTS, Report, SUMMARY, blocks, replace_blocks};

use crate::write;

/// Whether this is the repository.
pub(crate) fn find(repository: &Path) -> Result<Vec<PathBuf>, String> {
    let paths: Vec<PathBuf> = DOCUMENTS.iter().map(|document| repository.join(document)).collect();
    match paths.iter().find(|path| !path.is_file()) {
        Some(missing) => Err(format!("--docs: no file {}", missing.display())),
        None => Ok(paths),
    }
}

/// Writes the summary, and the marked tables.
pub(crate) fn update(repository: &Path, report: Report) -> Result<(), String> {
    let report = report.summary();
    let json = serde_json::to_string_pretty(&report).map_err(|error| error.to_string())?;
    let blocks = blocks(&report);
    let mut written = vec![(repository.join(SUMMARY), json + "\n")];
    for path in find(repository)? {
        let fail = |error: String| format!("{}: {error}", path.display());
        let text = fs::read_to_string(&path).map_err(|error| fail(error.to_string()))?;
        let text = replace_blocks(&text, &blocks).map_err(fail)?;
        written.push((path, text));
    }
    written.iter().try_for_each(|(path, text)| write(path, text))
}
