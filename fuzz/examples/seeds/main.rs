//! Writes what fuzzing starts from, into a folder for each target: small files of each kind.

mod files;
mod patches;

use std::path::{Path, PathBuf};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("usage: seeds FOLDER")?);
    for (target, seeds) in [
        ("extract", files::soups()),
        ("gltf", files::gltf()),
        ("obj", files::obj()),
        ("patch_file", patches::all()?),
        ("ply", files::ply()),
        ("stl", files::stl()),
    ] {
        write(&folder.join(target), seeds)?;
    }
    Ok(())
}

fn write(folder: &Path, seeds: Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)?;
    for (name, bytes) in seeds {
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}
