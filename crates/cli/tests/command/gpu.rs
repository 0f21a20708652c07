//! What holds for `--method wgpu` and `--method ash` alike, compared with what the processor finds.

use std::path::PathBuf;

use drypoint_lines::{
    Camera, Drawing, LineClass, LineOptions, Occluders, Page, Run, Segments, VisibilityParams,
    filter_for_drawing,
};
use drypoint_mesh::{Mesh, MeshAdjacency, contour_edges, io, shapes};
use glam::{DVec2, DVec3};

use crate::bench::{Bench, CORNER};

const SIDE: u32 = 600;

/// Whether the machine says that it has no GPU, not even software.
pub(crate) fn is_without_gpu() -> bool {
    std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1")
}

/// A picture that the program drew.
pub(crate) struct Ink {
    pub(crate) pixels: Vec<u8>,
    width: u32,
}

impl Ink {
    #[track_caller]
    pub(crate) fn draw(bench: &Bench, method: &str, args: &str) -> Self {
        bench.succeed(&format!("draw {args} --method {method} -o out.png"));
        let file = std::fs::File::open(bench.path().join("out.png")).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        assert_eq!(frame.color_type, png::ColorType::Rgba);
        Self { pixels, width: frame.width }
    }

    /// Darkness of a pixel, from 0 to 1.
    fn at(&self, point: DVec2) -> f64 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "on the page")]
        let [x, y] = [point.x, point.y].map(|side| (side as u32).min(self.width - 1));
        let red = self.pixels[4 * (y * self.width + x) as usize];
        1.0 - f64::from(red) / 255.0
    }
}

/// Points of runs, about half a pixel apart.
fn points<'a>(runs: impl Iterator<Item = &'a Run>) -> Vec<DVec2> {
    let mut points = Vec::new();
    for run in runs {
        for ends in run.points.windows(2) {
            let steps = (2.0 * ends[0].distance(ends[1])).ceil();
            let mut step = 0.5;
            while step < steps {
                points.push(ends[0].lerp(ends[1], step / steps));
                step += 1.0;
            }
        }
    }
    points
}

/// How a mesh is looked at.
#[derive(Clone, Copy, Debug)]
enum View {
    /// From outside.
    Perspective,
    /// From so near that a part of the mesh is behind the eye.
    Near,
    Orthographic,
}

/// A camera, and the options that give the program the same one.
fn camera(mesh: &Mesh, view: View) -> (Camera, String) {
    let page = Page { width: SIDE, height: SIDE, margin: 0.0 };
    let bounds = mesh.bounds().unwrap();
    let (target, size) = (bounds.center(), (bounds.max - bounds.min).as_dvec3().length());
    let distance = if matches!(view, View::Near) { 0.15 } else { 1.0 };
    let eye = target + distance * size * DVec3::new(0.8, 0.5, 1.7);
    let list = |point: DVec3| format!("{},{},{}", point.x, point.y, point.z);
    let options = format!("--eye {} --target {} --size {SIDE}x{SIDE}", list(eye), list(target));
    if let View::Orthographic = view {
        let camera = Camera::orthographic(eye - target, target, None, size, page);
        (camera.unwrap(), format!("{options} --ortho --height {size}"))
    } else {
        let camera = Camera::perspective(eye, target, None, 35.0, page);
        (camera.unwrap(), format!("{options} --fov 35"))
    }
}

/// Of the contours that the processor finds visible, the share that the picture shows; and of those that it
/// finds hidden, the share that the picture shows more than 2 pixels from any visible one.
#[track_caller]
fn shares(bench: &Bench, method: &str, (model, mesh): (&str, &Mesh), view: View) -> [f64; 2] {
    let (camera, options) = camera(mesh, view);
    let ink = Ink::draw(bench, method, &format!("{model} {options}"));
    let adjacency = MeshAdjacency::new(mesh);
    let mut contours = Vec::new();
    let filter = filter_for_drawing(mesh, &adjacency, camera.viewpoint());
    contour_edges(mesh, &adjacency, camera.viewpoint(), filter, &mut contours);
    let segments = Segments::new(mesh, &adjacency, &contours, &LineOptions::default());
    let params = VisibilityParams { drop_specks: 0.0, ..Default::default() };
    let drawing = Drawing::new(&Occluders::new(mesh, &adjacency), &segments, &camera, &params);
    let runs = &drawing.layers.iter().find(|layer| layer.class == LineClass::Contour).unwrap().runs;
    let [visible, hidden] =
        [true, false].map(|visible| points(runs.iter().filter(|run| run.visible == visible)));
    let is_far = |point: &DVec2| visible.iter().all(|other| point.distance(*other) > 2.0);
    let hidden: Vec<_> = hidden.into_iter().filter(is_far).collect();
    [visible, hidden].map(|points| {
        assert!(points.len() > 100, "{model} has too little of it, {view:?}");
        let shown = points.iter().filter(|point| ink.at(**point) > 0.3).count();
        shown as f64 / points.len() as f64
    })
}

#[track_caller]
fn check(method: &str, model: &str, mesh: &Mesh, views: &[View]) {
    let bench = Bench::new();
    for &view in views {
        let [visible, hidden] = shares(&bench, method, (model, mesh), view);
        assert!(visible > 0.999, "{model}, {view:?}: only {visible} of what is visible is drawn");
        assert!(hidden < 0.002, "{model}, {view:?}: {hidden} of what is hidden is drawn");
    }
}

#[track_caller]
pub(crate) fn what_is_visible_is_drawn_and_nothing_else(method: &str) {
    if is_without_gpu() {
        return;
    }
    const OUTSIDE: &[View] = &[View::Perspective, View::Orthographic];
    for name in ["torus-knot", "bumpy-sphere", "cad-part"] {
        check(method, &format!("shape:{name}"), &shapes::by_name(name, 20_000).unwrap(), OUTSIDE);
    }
    check(method, "shape:torus-knot", &shapes::torus_knot(20_000), &[View::Near]);
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS").map(PathBuf::from) else { return };
    for name in ["spot.obj", "stanford-bunny.obj", "dragon_vrip.ply", "fandisk.obj"] {
        let path = folder.join(name);
        if path.exists() {
            check(method, path.to_str().unwrap(), &io::read(&path).unwrap().mesh, OUTSIDE);
        }
    }
}

#[track_caller]
pub(crate) fn a_picture_has_its_colors_and_its_name(method: &str) {
    if is_without_gpu() {
        return;
    }
    let bench = Bench::new();
    let view = "--view front --ortho --size 90x60";
    bench.succeed(&format!("draw shape:cube --method {method} {view}"));
    assert_eq!(bench.files()[0].0, "cube.png");
    let colors = "--color #00ff0080 --background none --width 3";
    let picture = Ink::draw(&bench, method, &format!("shape:cube {view} {colors}"));
    assert_eq!(picture.pixels.len(), 4 * 90 * 60);
    assert_eq!(picture.pixels[..4], [0; 4], "the corner is empty");
    let mut inked: Vec<_> = picture.pixels.chunks(4).filter(|pixel| pixel[3] > 0).collect();
    inked.sort_unstable();
    inked.dedup();
    assert!(inked.iter().all(|pixel| [pixel[0], pixel[2]] == [0, 0]), "{inked:?}");
    assert_eq!(inked.iter().map(|pixel| pixel[3]).max(), Some(128), "no opacity adds up");
    let red = Ink::draw(&bench, method, &format!("shape:cube {view} --background red"));
    assert_eq!(red.pixels[..4], [255, 0, 0, 255]);
}

#[track_caller]
pub(crate) fn the_same_edges_are_found(method: &str) {
    if is_without_gpu() {
        return;
    }
    let bench = Bench::new();
    let shape = "shape:bumpy-sphere:3000";
    for (view, edges) in [("--eye 1,2,3", "convex"), ("--direction 0.3,0.2,1", "all")] {
        let options = format!("{view} --edges {edges} --json");
        let expected = bench.json(&format!("extract {shape} {options} --method patches"));
        bench.succeed(&format!("patches {shape} -o a.patches --edges {edges}"));
        for model in [shape, "a.patches"] {
            let mut found = bench.json(&format!("extract {model} {options} --method {method}"));
            assert_eq!(found["method"], method);
            found["method"] = expected["method"].clone();
            assert_eq!(found, expected, "{model}");
        }
    }
    let levels = format!("--preset fast --levels 2 --method {method} --json");
    let found = bench.json(&format!("extract {shape} --eye 1,2,3 {levels}"));
    assert!(found["super_patches_tested"].as_u64().unwrap() > 0);
}

#[track_caller]
pub(crate) fn every_shape_has_the_contour_of_brute_force(method: &str) {
    if is_without_gpu() {
        return;
    }
    let bench = Bench::new();
    // One has no faces, which is refused. Of another, whose parts differ in size by powers of ten, f32 tells
    // no sides but those of the largest: within the margin, which other tests know.
    let others = ["empty", "mixed-units"];
    for name in shapes::NAMES.iter().filter(|name| !others.contains(name)) {
        // From a place and a direction where no face is seen edge-on.
        for view in ["--eye 7.3,4.1,9.7", "--direction -0.37,0.83,0.29 --edges all"] {
            let extract = format!("extract shape:{name}:600 {view} --json");
            let expected = bench.json(&extract);
            let found = bench.json(&format!("{extract} --method {method} --preset fast"));
            for key in ["contour", "contour_edges", "edges"] {
                assert_eq!(found[key], expected[key], "{name}, {view}: {key}");
            }
        }
    }
}

#[track_caller]
pub(crate) fn patches_change_nothing_that_is_drawn(method: &str) {
    if is_without_gpu() {
        return;
    }
    let bench = Bench::new();
    let (shape, view) = ("shape:torus-knot:3000", "--view front --size 200x200");
    let whole = Ink::draw(&bench, method, &format!("{shape} {view}"));
    for edges in ["convex", "all"] {
        bench.succeed(&format!("patches {shape} -o knot.patches --edges {edges}"));
        let saved = Ink::draw(&bench, method, &format!("knot.patches --model {shape} {view}"));
        assert!(whole.pixels == saved.pixels, "patches of {edges} edges");
    }
}

#[track_caller]
pub(crate) fn what_it_cannot_do_is_refused(method: &str) {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let named = format!("--method {method}");
    for (options, word) in [
        ("-o a.svg", "a.svg"),
        ("-o -", ".png"),
        ("--lines contour,boundary", "--lines"),
        ("--lines crease", "--lines"),
        ("--hidden dashed", "--hidden"),
        ("--specks 3", "--specks"),
        ("--json", "--json"),
        ("--show patches", "--show"),
    ] {
        bench.fail(&format!("draw corner.obj {named} {options}"), &[word, &named]);
    }
    for (options, words) in [
        ("--preset fast", &["--preset", "--show"][..]),
        ("--width 0", &["--width"]),
        ("--color burple", &["burple"]),
    ] {
        bench.fail(&format!("draw corner.obj {named} {options}"), words);
    }
    bench.fail("draw corner.obj --method opengl", &["opengl", method]);
}

/// With variables of the environment that leave no device, `method` says `message`.
#[track_caller]
pub(crate) fn no_device_is_one_line(method: &str, variables: &[(&str, &str)], message: &str) {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    for args in ["draw corner.obj -o a.png", "extract corner.obj --eye 1,2,3"] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .args(args.split(' ').chain(["--method", method]))
            .envs(variables.iter().copied())
            .current_dir(bench.path())
            .output()
            .unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{errors}");
        assert_eq!(errors.lines().count(), 1, "{errors}");
        assert!(errors.starts_with(&format!("drypoint: {message}")), "{errors}");
    }
    assert_eq!(bench.files().len(), 1, "a picture is left behind");
}
