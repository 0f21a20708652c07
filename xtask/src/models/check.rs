//! Whether a file is the one that the catalogue describes.

use super::catalogue::Mesh;
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

#[derive(Debug, PartialEq)]
pub(crate) enum State {
    Missing,
    Present,
    /// Something else has its name, in words.
    Differs(String),
    /// It cannot be told, in words.
    Unreadable(String),
}

/// Reads the whole file, if its size is right.
pub(crate) fn state(mesh: &Mesh, path: &Path) -> State {
    match fs::metadata(path) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => return State::Missing,
        Err(e) => return State::Unreadable(e.to_string()),
        Ok(found) if !found.is_file() => return State::Differs("it is no file".to_owned()),
        Ok(_) => {}
    }
    match differs(path, mesh.size, mesh.sha256) {
        Ok(None) => State::Present,
        Ok(Some(how)) => State::Differs(how),
        Err(e) => State::Unreadable(e.to_string()),
    }
}

/// How the file differs from one of this size and hash, in words.
pub(crate) fn differs(path: &Path, size: u64, sha256: &str) -> io::Result<Option<String>> {
    let found = fs::metadata(path)?.len();
    if found != size {
        return Ok(Some(format!("it has {found} bytes, not {size}")));
    }
    let found = hash(path)?;
    Ok((found != sha256).then(|| format!("its SHA-256 is {found}, not {sha256}")))
}

fn hash(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hex(&hasher.finalize())),
            length => hasher.update(&buffer[..length]),
        }
    }
}

pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
