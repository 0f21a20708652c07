//! The folder of a film: numbered frames, and a note of what they are, so that a film that was cut off
//! goes on.

use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::output::Output;

/// The note beside the frames.
const NOTE: &str = "frames.json";

/// What the frames of a folder are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Manifest {
    /// The version that draws them.
    pub(crate) drypoint: String,
    /// Name of the model, without folder and extension.
    pub(crate) model: String,
    pub(crate) frames: usize,
    /// Extension of the frames.
    pub(crate) format: String,
    /// Tells pictures from others: of all that decides what is in them.
    pub(crate) key: String,
}

/// A folder, maybe not there yet.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    /// Digits of a frame's number, and the extension.
    names: (usize, String),
    /// The folder itself, which nobody else may write frames into while it is locked.
    lock: Option<File>,
}

impl Folder {
    /// A folder in which frames may be written, found to be so before the work; nothing is touched.
    pub(crate) fn check(path: &Path) -> Result<Self, String> {
        let refused = |why: &str| Err(format!("{}: cannot write: {why}", path.display()));
        match fs::metadata(path) {
            Ok(there) if there.is_dir() => {
                // A place that cannot be written is told before the work, not after.
                Output::open(&path.join(NOTE))?;
            }
            Ok(_) => return refused("it is no folder"),
            Err(_) => {
                let parent = path.parent().filter(|parent| *parent != Path::new(""));
                if path.file_name().is_none() || parent.is_some_and(|parent| !parent.is_dir()) {
                    return refused("the folder that it is to be in does not exist");
                }
                Output::open(path)?;
            }
        }
        Ok(Self { path: path.to_owned(), names: (0, String::new()), lock: None })
    }

    /// As the user gave it.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Makes the folder one of these frames, and says which of them are there. Other frames are
    /// refused, or with `overwrite` removed, these too.
    pub(crate) fn open(
        &mut self,
        manifest: &Manifest,
        overwrite: bool,
    ) -> Result<Vec<bool>, String> {
        let digits = (manifest.frames - 1).to_string().len().max(4);
        self.names = (digits, manifest.format.clone());
        let note = self.path.join(NOTE);
        if !self.path.is_dir() {
            match fs::create_dir(&self.path) {
                // Somebody else was faster, who may be drawing into it.
                Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                    return Err(self.fail(&error));
                }
                _ => {}
            }
        }
        self.lock()?;
        let noted = fs::read(&note).ok();
        let noted: Option<Manifest> = noted.and_then(|text| serde_json::from_slice(&text).ok());
        if noted.as_ref() == Some(manifest) && !overwrite {
            return Ok((0..manifest.frames).map(|frame| self.is_whole(frame)).collect());
        }
        let others = self.frames().map_err(|error| self.fail(&error))?;
        if !overwrite && (note.exists() || !others.is_empty()) {
            return Err(format!(
                "{}: holds frames of another model, of other options, or of another version; name \
                 another folder, or replace them with --overwrite",
                self.name()
            ));
        }
        for other in others {
            fs::remove_file(other).map_err(|error| self.fail(&error))?;
        }
        let mut text = serde_json::to_string_pretty(manifest).map_err(|error| error.to_string())?;
        text.push('\n');
        Output::File(note).write(text.as_bytes())?;
        Ok(vec![false; manifest.frames])
    }

    /// Keeps others from the folder until this is dropped, or the program ends in whatever way: frames of
    /// two films would be mixed. Systems on which a folder cannot be locked go without.
    fn lock(&mut self) -> Result<(), String> {
        self.lock = File::open(&self.path).ok();
        match self.lock.as_ref().map(File::try_lock) {
            Some(Err(TryLockError::WouldBlock)) => {
                Err(format!("{}: another drypoint is drawing frames into it", self.name()))
            }
            _ => Ok(()),
        }
    }

    /// Writes a frame whole, or leaves what was there.
    pub(crate) fn write(&self, frame: usize, picture: &[u8]) -> Result<(), String> {
        Output::File(self.frame(frame)).write(picture)
    }

    fn frame(&self, frame: usize) -> PathBuf {
        let (digits, extension) = &self.names;
        self.path.join(format!("frame-{frame:0digits$}.{extension}"))
    }

    /// Whether a frame is there and ends as a picture does: others may have copied half of it.
    fn is_whole(&self, frame: usize) -> bool {
        let end: &[u8] = match self.names.1.as_str() {
            "svg" => b"</svg>\n",
            _ => b"IEND\xae\x42\x60\x82",
        };
        let tail = || {
            let mut file = File::open(self.frame(frame))?;
            file.seek(SeekFrom::End(-(end.len() as i64)))?;
            let mut tail = Vec::new();
            file.read_to_end(&mut tail).map(|_| tail)
        };
        tail().is_ok_and(|tail: Vec<u8>| tail == end)
    }

    /// All that is named as a frame.
    fn frames(&self) -> std::io::Result<Vec<PathBuf>> {
        let is_frame = |name: &str| {
            let number = name
                .strip_prefix("frame-")
                .and_then(|rest| rest.strip_suffix(".svg").or_else(|| rest.strip_suffix(".png")));
            number.is_some_and(|n| n.len() >= 4 && n.bytes().all(|digit| digit.is_ascii_digit()))
        };
        let mut found = Vec::new();
        for entry in fs::read_dir(&self.path)? {
            let entry = entry?;
            if entry.file_name().to_str().is_some_and(is_frame) {
                found.push(entry.path());
            }
        }
        Ok(found)
    }

    fn fail(&self, error: &std::io::Error) -> String {
        format!("{}: cannot write: {error}", self.name())
    }
}
