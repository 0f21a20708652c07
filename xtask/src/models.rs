//! The folder of real meshes, named by the environment variable `DRYPOINT_MODELS`, and
//! `cargo xtask models`, which says what can be in it.

mod catalogue;
mod check;
mod command;
#[cfg(test)]
mod download_tests;
mod fetch;
mod get;

pub(crate) use command::run;

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

const VARIABLE: &str = "DRYPOINT_MODELS";

/// What the readers of `drypoint-mesh` read.
const EXTENSIONS: [&str; 5] = ["obj", "ply", "stl", "gltf", "glb"];

/// Hands the folder to `command` as an absolute path, because cargo runs each test in the folder of
/// its package; or says in one line that real meshes are left out.
///
/// # Errors
/// The variable names something that is no folder, or a folder without a mesh: what was asked for
/// would silently not be tested.
pub(crate) fn hand_to(command: &mut Command) -> Result<(), String> {
    match folder(env::var_os(VARIABLE).as_deref())? {
        Some((folder, count)) => {
            println!("{VARIABLE}: {count} meshes in {}", folder.display());
            command.env(VARIABLE, folder);
        }
        None => println!(
            "{VARIABLE} is not set: real meshes are skipped. To include them, set it to a folder of \
             .{} files; `cargo xtask models` knows some",
            EXTENSIONS.join(", .")
        ),
    }
    Ok(())
}

/// The folder as an absolute path and the number of meshes in it, or `None` if none is named.
fn folder(value: Option<&OsStr>) -> Result<Option<(PathBuf, usize)>, String> {
    let Some(value) = value.filter(|value| !value.is_empty()) else { return Ok(None) };
    let named = PathBuf::from(value);
    let wrong = |what: &str| format!("{VARIABLE}={}: {what}", named.display());
    let absolute = fs::canonicalize(&named).map_err(|e| wrong(&e.to_string()))?;
    let count = meshes_in(&absolute).map_err(|e| wrong(&e.to_string()))?.len();
    if count == 0 {
        return Err(wrong(&format!("no .{} file in this folder", EXTENSIONS.join(", ."))));
    }
    Ok(Some((absolute, count)))
}

/// What the variable names, whether it exists or not.
fn named_folder() -> Option<PathBuf> {
    env::var_os(VARIABLE).filter(|value| !value.is_empty()).map(PathBuf::from)
}

fn meshes_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let is_mesh = |path: &PathBuf| {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        extension.is_some_and(|e| EXTENSIONS.contains(&e.as_str()))
    };
    Ok(fs::read_dir(folder)?.flatten().map(|entry| entry.path()).filter(is_mesh).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_folder_is_fine_and_a_wrong_one_is_not() {
        assert_eq!(folder(None), Ok(None));
        assert_eq!(folder(Some(OsStr::new(""))), Ok(None));

        let temporary = tempfile::tempdir().expect("a temporary folder");
        let path = temporary.path().canonicalize().expect("it exists");
        let missing = path.join("missing");
        assert!(folder(Some(missing.as_os_str())).is_err());
        assert!(folder(Some(path.as_os_str())).is_err_and(|e| e.contains("no .obj")));

        fs::write(path.join("cube.OBJ"), "").expect("it can be written");
        assert_eq!(folder(Some(path.as_os_str())), Ok(Some((path.clone(), 1))));
        assert!(folder(Some(path.join("cube.OBJ").as_os_str())).is_err());
    }
}
