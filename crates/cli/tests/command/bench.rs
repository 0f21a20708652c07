//! Runs the program in a folder of its own.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// A folder of its own for each test, as the working folder of the program.
pub(crate) struct Bench(tempfile::TempDir);

impl Bench {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path().join(name), content).unwrap();
    }

    pub(crate) fn run(&self, args: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .args(args.split_whitespace())
            .current_dir(self.path())
            .output()
            .unwrap()
    }

    #[track_caller]
    pub(crate) fn succeed(&self, args: &str) -> String {
        let output = self.run(args);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "drypoint {args}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    #[track_caller]
    pub(crate) fn json(&self, args: &str) -> Value {
        serde_json::from_str(&self.succeed(args)).unwrap()
    }

    /// Fails with status 1 and one line that holds every one of `words`; the folder is as it was.
    #[track_caller]
    pub(crate) fn fail(&self, args: &str, words: &[&str]) {
        let before = self.files();
        let output = self.run(args);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "drypoint {args}: {errors}");
        assert_eq!(errors.lines().count(), 1, "drypoint {args}: {errors}");
        assert!(output.stdout.is_empty(), "drypoint {args} printed something");
        for word in words {
            assert!(errors.contains(word), "drypoint {args}: no {word:?} in: {errors}");
        }
        assert_eq!(self.files(), before, "drypoint {args} left something behind");
    }

    pub(crate) fn files(&self) -> Vec<(String, Vec<u8>)> {
        let entries = std::fs::read_dir(self.path()).unwrap().map(|entry| entry.unwrap());
        let named = |entry: std::fs::DirEntry| {
            (
                entry.file_name().into_string().unwrap(),
                std::fs::read(entry.path()).unwrap_or_default(),
            )
        };
        let mut files: Vec<_> = entries.map(named).collect();
        files.sort();
        files
    }
}

/// The unit corner: a tetrahedron with its right angle at the origin.
pub(crate) const CORNER: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
