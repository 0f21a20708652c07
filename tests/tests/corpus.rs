//! What fuzzing left behind: every file of `fuzz/corpus` and what was once a finding, without a
//! fuzzer.

use std::path::Path;

use drypoint_tests::hostile::{CHECKS, Check};
use rayon::prelude::*;

/// Runs `check` on every file of the corpus of that name, and tells which one it was.
fn replay(name: &str, check: Check) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(name);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 10, "{} files are no corpus", files.len());
    files.par_iter().for_each(|file| {
        let bytes = std::fs::read(file).unwrap();
        let result = std::panic::catch_unwind(|| check(&bytes));
        assert!(result.is_ok(), "{}", file.display());
    });
}

macro_rules! replay {
    ($($name:ident),*) => {$(
        #[test]
        fn $name() {
            let name = stringify!($name);
            let (_, check) = CHECKS.iter().find(|(known, _)| *known == name).expect("it is a check");
            replay(name, *check);
        }
    )*};
}

replay!(extract, gltf, obj, patch_file, ply, stl);
