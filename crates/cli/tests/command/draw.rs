//! `drypoint draw`: what is on the page.

use crate::bench::{Bench, CORNER};

#[test]
fn draw_alone_draws_a_shape() {
    let bench = Bench::new();
    bench.succeed("draw");
    let files = bench.files();
    assert_eq!(files.len(), 1);
    assert_eq!(files[0].0, "torus-knot.svg");
    assert!(String::from_utf8_lossy(&files[0].1).contains("class=\"contour\""));
}

#[test]
fn draw_writes_svg_png_and_statistics() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let drawn =
        bench.json("draw corner.obj -o a.svg --json --lines contour,crease --hidden dashed");
    assert!(drawn["contour"]["visible_length"].as_f64().unwrap() > 100.0);
    bench.succeed("draw corner.obj -o a.png --size 120x80");
    let files = bench.files();
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["a.png", "a.svg", "corner.obj"]);
    assert!(files[0].1.starts_with(b"\x89PNG"));
    let svg = bench.succeed("draw corner.obj -o - --ortho --view front");
    assert!(svg.trim_start().starts_with('<') && svg.contains("<svg"));
}

#[test]
fn faces_without_area_make_no_picture() {
    let bench = Bench::new();
    bench.write("flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 5 5 5\nf 1 2 3\nf 2 3 4\n");
    bench.fail("draw flat.obj -o out.svg", &["flat.obj", "area"]);
    assert_eq!(bench.json("info flat.obj --json")["degenerate"], 2);
    assert_eq!(bench.json("extract flat.obj --eye 1,2,3 --json")["contour_edges"], 0);
}

#[test]
fn well_defined_pictures_from_odd_places() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    // Inside the mesh every face looks away: no contour, a valid picture.
    let inside = bench.json("draw corner.obj -o in.svg --eye 0.1,0.1,0.1 --target 9,9,9 --json");
    assert_eq!(inside["contour"]["segments"], 0);
    // On a vertex, on a face, straight from above without --up.
    for view in ["--eye 0,0,0 --target 1,1,1", "--eye 0.2,0.2,0 --target 1,1,1", "--view top"] {
        bench.succeed(&format!("draw corner.obj -o odd.svg {view}"));
    }
}

/// Length in pixels of the visible lines of a class.
#[track_caller]
fn visible(bench: &Bench, class: &str, args: &str) -> f64 {
    bench.json(&format!("draw {args} --json"))[class]["visible_length"].as_f64().unwrap()
}

#[test]
fn a_target_is_in_the_middle_and_the_model_on_the_page() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    for target in ["0,0,100", "0.5,0.5,-100", "0.5,0.5,0.5"] {
        for ortho in ["", "--ortho"] {
            let args = format!("corner.obj -o a.svg --view front --target {target} {ortho}");
            assert!(visible(&bench, "contour", &args) > 30.0, "{args}");
        }
    }
}

#[test]
fn creases_alone_are_all_there() {
    let bench = Bench::new();
    let creases = bench.json("draw shape:cube -o a.svg --lines crease --json");
    assert_eq!(creases["crease"]["segments"], 12);
    let both = bench.json("draw shape:cube -o a.svg --lines contour,crease --json");
    assert_eq!((&both["contour"]["segments"], &both["crease"]["segments"]), (&6.into(), &6.into()));
}

#[test]
fn a_surface_stored_twice_looks_like_one_stored_once() {
    let bench = Bench::new();
    let once = CORNER.to_owned();
    let faces = CORNER.lines().filter(|line| line.starts_with('f'));
    let turned = |line: &str| {
        let corners: Vec<_> = line.split(' ').collect();
        format!("f {} {} {}\n", corners[3], corners[2], corners[1])
    };
    bench.write("once.obj", &once);
    bench.write(
        "same.obj",
        once.clone() + &faces.clone().map(|f| format!("{f}\n")).collect::<String>(),
    );
    bench.write("both.obj", once + &faces.map(turned).collect::<String>());
    let expected = visible(&bench, "contour", "once.obj -o a.svg --view front");
    for name in ["same.obj", "both.obj"] {
        let found = visible(&bench, "contour", &format!("{name} -o a.svg --view front"));
        assert!((found - expected).abs() < 1e-6, "{name}: {found}, not {expected}");
    }
}

#[test]
fn a_solid_turned_inside_out_is_seen() {
    let bench = Bench::new();
    bench.write("out.obj", CORNER);
    bench.write(
        "in.obj",
        CORNER
            .replace("f 1 3 2", "f 1 2 3")
            .replace("f 1 2 4", "f 1 4 2")
            .replace("f 1 4 3", "f 1 3 4")
            .replace("f 2 3 4", "f 2 4 3"),
    );
    let [out, turned] = ["out.obj", "in.obj"]
        .map(|name| visible(&bench, "contour", &format!("{name} -o a.svg --view front")));
    assert!(turned > 100.0 && (turned - out).abs() < 1e-6, "{turned}, not {out}");
}

#[test]
fn a_blank_page_is_told() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let output = bench.run("draw corner.obj -o a.svg --eye 9,9,9 --target 20,20,20");
    assert!(output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("no line of corner.obj"));
    // There are none to see.
    let output = bench.run("draw corner.obj -o a.svg --lines boundary,intersection");
    assert!(output.status.success());
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("corner.obj has no such line from here"), "{told}");
}
