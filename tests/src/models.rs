//! Real meshes, from the folder that `DRYPOINT_MODELS` names.

use std::ffi::OsStr;
use std::path::PathBuf;

use drypoint_mesh::io;

/// The variable that names the folder.
pub const VARIABLE: &str = "DRYPOINT_MODELS";

/// Mesh files of the folder, by name; empty if the variable is unset.
///
/// # Errors
/// If the variable names no folder that can be read, in one sentence: a misspelt path must not look
/// like a pass.
pub fn files() -> Result<Vec<PathBuf>, String> {
    let Some(folder) = std::env::var_os(VARIABLE).filter(|folder| !folder.is_empty()) else {
        return Ok(Vec::new());
    };
    let fail = |why| format!("{VARIABLE}={}: {why}", PathBuf::from(&folder).display());
    let entries = std::fs::read_dir(&folder).map_err(|error| fail(error.to_string()))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|error| fail(error.to_string()))?.path();
        if path
            .extension()
            .and_then(OsStr::to_str)
            .is_some_and(|e| io::Format::of_extension(e).is_some())
        {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(fail("holds no mesh file".to_owned()));
    }
    Ok(files)
}
