//! What was measured already, so that a run that is cut off goes on where it was.

use std::cell::Cell;
use std::fs;
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::{Options, machine, write};

/// A folder of measurements, each a file.
#[derive(Debug)]
pub(crate) struct Kept {
    folder: PathBuf,
    program: String,
    is_fresh: bool,
    progress: ProgressBar,
    /// How many measurements are of an earlier run.
    reused: Cell<u32>,
}

/// What was measured, and of what by which program: anything else is measured anew.
#[derive(Serialize, Deserialize)]
struct Measured<T> {
    key: String,
    value: T,
}

impl Kept {
    /// In the report's folder, which is made.
    pub(crate) fn new(options: &Options) -> Result<Self, String> {
        let folder = options.output.join("parts");
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let progress = ProgressBar::new_spinner();
        let style =
            ProgressStyle::with_template("{spinner} {elapsed_precise} {pos} measured: {msg}");
        progress.set_style(style.map_err(|error| error.to_string())?);
        progress.enable_steady_tick(std::time::Duration::from_millis(200));
        let program = machine::program()?;
        Ok(Self { folder, program, is_fresh: options.fresh, progress, reused: Cell::new(0) })
    }

    /// Ends the progress, and says what was not measured now.
    pub(crate) fn finish(&self) {
        self.progress.finish_and_clear();
        if self.reused.get() > 0 {
            eprintln!(
                "{} measurements are of an earlier run, kept in {}; --fresh measures them anew",
                self.reused.get(),
                self.folder.display()
            );
        }
    }

    /// What is kept under `name` for the same `key`; else what `measure` gives, which is then kept.
    pub(crate) fn or_measure<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        key: &str,
        measure: impl FnOnce() -> Result<T, String>,
    ) -> Result<T, String> {
        self.progress.set_message(name.to_owned());
        if self.progress.is_hidden() {
            eprintln!("{name}");
        }
        let key = format!("{} {key}", self.program);
        let path = self.folder.join(format!("{}.json", file_name(name)));
        // A file that cannot be read is as good as none.
        let known = fs::read_to_string(&path).ok();
        let known = known.and_then(|text| serde_json::from_str::<Measured<T>>(&text).ok());
        let value = match known.filter(|known| known.key == key && !self.is_fresh) {
            Some(known) => {
                self.reused.set(self.reused.get() + 1);
                known.value
            }
            None => {
                let measured = Measured { key, value: measure()? };
                let text = serde_json::to_string(&measured).map_err(|error| error.to_string())?;
                write(&path, &text)?;
                measured.value
            }
        };
        self.progress.inc(1);
        Ok(value)
    }
}

/// Letters and digits as they are, and a line for what is between.
fn file_name(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[test]
    fn what_is_kept_is_not_measured_again() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("report");
        let kept = |more: &[&str]| {
            let arguments = ["bench", "--output", output.to_str().unwrap()];
            Kept::new(&Options::parse_from(arguments.iter().chain(more))).unwrap()
        };
        let check = |kept: &Kept, key: &str, value: u32, expected: u32| {
            assert_eq!(kept.or_measure("a mesh, times", key, || Ok(value)), Ok(expected));
        };
        check(&kept(&[]), "7", 1, 1);
        check(&kept(&[]), "7", 2, 1);
        check(&kept(&[]), "8", 3, 3);
        check(&kept(&["--fresh"]), "8", 4, 4);
        let failed = kept(&[]).or_measure::<u32>("other", "8", || Err("no".to_owned()));
        assert_eq!(failed, Err("no".to_owned()));
        fs::write(output.join("parts/a-mesh-times.json"), "{\"key\"").unwrap();
        check(&kept(&[]), "8", 5, 5);
    }
}
