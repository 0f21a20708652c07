//! Writing files whole or not at all, and stopping cleanly.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::{Builder, NamedTempFile};

use crate::progress::Stage;

/// What a shell reports for a program that Ctrl-C ended: 128 + SIGINT.
const INTERRUPTED: i32 = 130;

/// The half-written file that must go if Ctrl-C comes now.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Makes Ctrl-C remove what is half-written and end the program.
pub(crate) fn stop_cleanly_on_ctrl_c() -> Result<(), String> {
    let stop = || {
        // Holding the lock keeps a file from being renamed into place from here on.
        let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(path) = unfinished.as_deref() {
            // The program ends either way, and there is nobody left to tell.
            let _ = std::fs::remove_file(path);
        }
        // A progress bar may stand in this line of a terminal.
        let clear = if io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
        say(&format!("{clear}drypoint: interrupted"));
        std::process::exit(INTERRUPTED);
    };
    ctrlc::set_handler(stop).map_err(|error| format!("cannot watch for Ctrl-C: {error}"))
}

/// A place to write to, found writable before the work starts.
#[derive(Debug)]
pub(crate) enum Output {
    /// Standard output, asked for as `-`.
    Stdout,
    /// A regular file, new or to be replaced.
    File(PathBuf),
    /// Something that exists and is no regular file: a device, a pipe.
    Stream(PathBuf),
}

impl Output {
    /// Checks that `path` can be written, without touching what is there.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        if path == Path::new("-") {
            return Ok(Self::Stdout);
        }
        let fail = |why: &dyn std::fmt::Display| format!("{}: cannot write: {why}", path.display());
        // Writing through a link replaces what it points to, not the link.
        let path = match path.canonicalize() {
            Ok(existing) => existing,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                if path.is_symlink() {
                    return Err(fail(&"it is a link that leads nowhere"));
                }
                path.to_owned()
            }
            Err(error) => return Err(fail(&plain(&error))),
        };
        match std::fs::metadata(&path) {
            Ok(there) if there.is_dir() => return Err(fail(&"it is a folder")),
            Ok(there) if !there.is_file() => return Ok(Self::Stream(path)),
            Ok(there) if there.permissions().readonly() => {
                return Err(fail(&"the file is read-only"));
            }
            _ => {}
        }
        if path.file_name().is_none() {
            return Err(fail(&"it names no file"));
        }
        temporary_beside(&path).map_err(|error| fail(&plain(&error)))?;
        Ok(Self::File(path))
    }

    /// Writes `bytes` whole, or leaves what was there.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), String> {
        match self {
            Self::Stdout => print(bytes),
            Self::Stream(path) => std::fs::OpenOptions::new()
                .write(true)
                .open(path)
                .and_then(|mut stream| stream.write_all(bytes))
                .map_err(|error| cannot_write(path, &error)),
            Self::File(path) => {
                let _stage = Stage::new(&format!("writing {}", path.display()));
                replace(path, bytes).map_err(|error| cannot_write(path, &error))
            }
        }
    }
}

/// Writes to standard output. A reader that has seen enough and gone away is no error.
pub(crate) fn print(bytes: &[u8]) -> Result<(), String> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("standard output: {}", plain(&error)))
        }
        _ => Ok(()),
    }
}

/// Prints one line to standard error, whatever line breaks a file's name may hold.
pub(crate) fn tell(message: &str) {
    say(&harmless(&message.replace(['\n', '\r'], " ")));
}

/// Where standard error is closed or full there is nobody to tell, and the work goes on.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// A text with control characters spelled out, and those that turn the direction of writing: a name in a
/// file must not clear a terminal, nor show as another one.
pub(crate) fn harmless(text: &str) -> String {
    let turns = |c| matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let mut spelled = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() || turns(c) {
            spelled.extend(c.escape_default());
        } else {
            spelled.push(c);
        }
    }
    spelled
}

/// Prints a line of JSON.
pub(crate) fn print_json(value: &impl serde::Serialize) -> Result<(), String> {
    let mut text = serde_json::to_string(value).map_err(|error| error.to_string())?;
    text.push('\n');
    print(text.as_bytes())
}

fn cannot_write(path: &Path, error: &io::Error) -> String {
    format!("{}: cannot write: {}", path.display(), plain(error))
}

/// The reason alone: errors of `tempfile` repeat the name of a file that the user never saw.
fn plain(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "the folder does not exist".to_owned(),
        kind => io::Error::from(kind).to_string(),
    }
}

/// Writes a file beside `path` and renames it into place.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = {
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        let file = temporary_beside(path)?;
        *unfinished = Some(file.path().to_owned());
        file
    };
    let written = file.write_all(bytes).and_then(|()| file.as_file().sync_all());
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    *unfinished = None;
    written?;
    if let Ok(there) = std::fs::metadata(path) {
        file.as_file().set_permissions(there.permissions())?;
    }
    file.persist(path)?;
    Ok(())
}

/// An empty file in the folder of `path`, removed when dropped.
fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = Builder::new();
    builder.prefix(".drypoint-").suffix(".part");
    // A private temporary file would make a private picture; the user's umask decides instead.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
