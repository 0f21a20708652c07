//! Options that make no sense.

use crate::bench::{Bench, CORNER};

#[test]
fn bad_options_say_what_is_wrong() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    std::fs::create_dir(bench.path().join("folder")).unwrap();
    for (options, words) in [
        ("--eye 1,2", &["--eye", "three numbers"][..]),
        ("--eye 1,2,nan", &["--eye", "finite"]),
        ("--eye 1,2,3 --target 1,2,3", &["eye", "target"]),
        ("--eye 0.25,9,0.25 --target 0.25,0,0.25 --up 0,1,0", &["up"]),
        ("--fov 180", &["fov"]),
        ("--fov 0", &["fov"]),
        ("--hidden maybe", &["maybe", "dashed"]),
        ("--lines contour,hatching", &["hatching", "boundary"]),
        ("--view above", &["above", "top"]),
        ("--size 0x10", &["--size"]),
        ("--size 800", &["--size"]),
        ("--width -1", &["width"]),
        ("--color burple", &["burple"]),
        ("--margin -5", &["margin"]),
        ("--margin 5000", &["margin"]),
        ("--ortho --height 0", &["height"]),
        ("--height 3", &["--ortho"]),
        ("--crease-angle 270", &["crease-angle"]),
        ("--crease-angle 20", &["--crease-angle", "--lines crease"]),
        ("--fov 40 --ortho", &["--fov", "--ortho"]),
        ("--show faces", &["faces", "survivors"]),
        ("--preset fast", &["--preset", "--show"]),
        ("--edges all", &["--edges", "--show"]),
        ("--show patches --partition 9", &["--partition", "--preset paper"]),
        ("--model corner.obj", &["--model", "corner.obj"]),
        ("--distance 0 --view front", &["distance"]),
        ("--distance 3 --ortho", &["distance", "ortho"]),
        ("--elevation 100", &["elevation", "90"]),
        ("--specks -1", &["specks"]),
        ("--width 0.001", &["width"]),
        ("-o - --json", &["--json"]),
        ("--view front --up 0,0,0", &["--up"]),
        ("--wibble", &["--wibble"]),
        ("-o out.bmp", &["out.bmp", ".svg"]),
        ("-o nowhere/out.svg", &["nowhere/out.svg", "folder"]),
        ("-o folder", &["folder"]),
    ] {
        bench.fail(&format!("draw corner.obj {options}"), words);
    }
    bench.fail("extract corner.obj", &["--eye", "--direction"]);
    bench.fail("patches corner.obj -o corner.obj", &["corner.obj", ".patches"]);
    bench.fail("patches corner.obj -o - --json", &["--json"]);
    bench.fail("draw folder", &["folder"]);
    bench.fail("extract corner.obj --eye 1,2,3 --direction 1,2,3", &["--direction"]);
    bench.fail("extract corner.obj --direction 0,0,0", &["--direction"]);
    let words = ["magic", "brute-force", "patches", "wgpu", "ash"];
    bench.fail("extract corner.obj --eye 1,2,3 --method magic", &words);
    bench.fail("patches corner.obj", &["--output"]);
    bench.fail("patches corner.obj -o nowhere/a.patches", &["nowhere/a.patches"]);
    bench.fail("paint corner.obj", &["paint"]);
}

#[test]
fn a_method_that_was_not_built_in_is_refused() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let methods = [("wgpu", cfg!(feature = "wgpu")), ("ash", cfg!(feature = "ash"))];
    for (method, _) in methods.into_iter().filter(|(_, is_built_in)| !is_built_in) {
        let words = [&format!("--method {method}")[..], &format!("the feature {method}")];
        for args in [
            "draw corner.obj -o a.png",
            "extract corner.obj --eye 1,2,3",
            "extract nothing.obj --eye 1,2,3",
        ] {
            bench.fail(&format!("{args} --method {method}"), &words);
        }
    }
}
