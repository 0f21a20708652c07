//! Downloading what is missing, and saying what to do about the rest.

use super::catalogue::{Download, Mesh};
use super::check::{State, differs, state};
use super::fetch::{Wanted, fetch};
use flate2::read::GzDecoder;
use indicatif::DecimalBytes;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use ureq::Agent;

#[derive(Debug, PartialEq)]
pub(crate) enum Outcome {
    /// The right file was there before.
    WasThere,
    Downloaded,
    /// There is no address; in words.
    ByHand(String),
    /// In words.
    Failed(String),
}

/// Downloads those of `meshes` that `folder` lacks, and says what happens to each.
///
/// # Errors
/// A mesh could not be had. One without an address, or another file of its name, counts only if it
/// `is_named`, because then it was asked for.
pub(crate) fn all(
    agent: &Agent,
    meshes: &[&Mesh],
    folder: &Path,
    is_named: bool,
) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut failed = 0;
    for mesh in meshes {
        match one(agent, mesh, folder) {
            Outcome::WasThere => println!("{}: there already", mesh.name),
            Outcome::Downloaded => println!("{}: downloaded, size and hash are right", mesh.name),
            Outcome::ByHand(what) => {
                eprintln!("{}: {what}", mesh.name);
                failed += u32::from(is_named);
            }
            Outcome::Failed(why) => {
                eprintln!("{}: {why}", mesh.name);
                failed += 1;
            }
        }
    }
    if failed == 0 { Ok(()) } else { Err(format!("{failed} of {} not obtained", meshes.len())) }
}

/// Touches no file that has the mesh's name already.
pub(crate) fn one(agent: &Agent, mesh: &Mesh, folder: &Path) -> Outcome {
    let target = folder.join(mesh.name);
    match state(mesh, &target) {
        State::Present => return Outcome::WasThere,
        State::Differs(how) => {
            let path = target.display();
            return Outcome::ByHand(format!("{path} is left as it is, though {how}"));
        }
        State::Unreadable(why) => return Outcome::Failed(format!("{}: {why}", target.display())),
        State::Missing => {}
    }
    let Some(download) = &mesh.download else {
        return Outcome::ByHand(format!("no address is known; {}", by_hand(mesh, folder)));
    };
    let (url, size) = match download {
        Download::File { url } => (url, mesh.size),
        Download::Member { url, size, .. } => (url, *size),
    };
    println!("{}: {} from {url}\n  terms: {}", mesh.name, DecimalBytes(size), mesh.terms);
    match to_place(agent, mesh, download, folder) {
        Ok(()) => Outcome::Downloaded,
        Err(why) => Outcome::Failed(format!("{why}; {}", by_hand(mesh, folder))),
    }
}

/// What a person can do.
pub(crate) fn by_hand(mesh: &Mesh, folder: &Path) -> String {
    let path = folder.join(mesh.name);
    format!("by hand: from {} get {}, put it at {}", mesh.page, mesh.file, path.display())
}

fn to_place(agent: &Agent, mesh: &Mesh, download: &Download, folder: &Path) -> Result<(), String> {
    let part = folder.join(format!("{}.part", mesh.name));
    let of_file = |e: io::Error| format!("{}: {e}", part.display());
    match *download {
        Download::File { url } => {
            fetch(agent, Wanted { url, size: mesh.size, sha256: mesh.sha256 }, &part)?;
        }
        Download::Member { url, size, sha256, member } => {
            let archive = folder.join(format!("{}.tar.gz.part", mesh.name));
            fetch(agent, Wanted { url, size, sha256 }, &archive)?;
            unpack(&archive, member, &part).map_err(|e| format!("{member} of the archive: {e}"))?;
            fs::remove_file(&archive).map_err(of_file)?;
            if let Some(how) = differs(&part, mesh.size, mesh.sha256).map_err(of_file)? {
                fs::remove_file(&part).map_err(of_file)?;
                return Err(format!("{member} of the archive is another file: {how}"));
            }
        }
    }
    let target = folder.join(mesh.name);
    if target.exists() {
        return Err(format!("{} has appeared meanwhile and is left", target.display()));
    }
    fs::rename(&part, &target).map_err(of_file)
}

fn unpack(archive: &Path, member: &str, to: &Path) -> io::Result<()> {
    let mut archive = tar::Archive::new(GzDecoder::new(File::open(archive)?));
    for entry in archive.entries()? {
        let mut entry = entry?;
        if entry.path()? == Path::new(member) {
            return io::copy(&mut entry, &mut File::create(to)?).map(drop);
        }
    }
    Err(io::Error::from(io::ErrorKind::NotFound))
}
