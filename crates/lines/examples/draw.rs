//! Draws a mesh file: `cargo run --release --example draw -- MODEL OUT.svg|OUT.png [key=value …]`.
use drypoint_lines::*;
use drypoint_mesh::*;
use glam::DVec3;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let get = |key: &str| args.iter().find_map(|a| a.strip_prefix(&format!("{key}=")));
    let num = |key: &str, d: f64| get(key).map_or(d, |v| v.parse().unwrap());
    let vec = |key: &str| {
        get(key).map(|v| {
            let c: Vec<f64> = v.split(',').map(|x| x.parse().unwrap()).collect();
            DVec3::new(c[0], c[1], c[2])
        })
    };
    let mut t = Instant::now();
    let mut lap = |what: &str| {
        eprint!("{what} {:.0} ms, ", t.elapsed().as_secs_f64() * 1e3);
        t = Instant::now();
    };
    let mesh = match args[0].strip_prefix("shape:") {
        Some(name) => shapes::by_name(name, num("n", 2000.0) as usize).unwrap(),
        None => io::read(args[0].as_ref()).unwrap().mesh,
    };
    lap("read");
    let adjacency = MeshAdjacency::new(&mesh);
    lap("adjacency");
    let size = num("size", 1000.0) as u32;
    let page = Page { width: size, height: size, margin: 0.04 * f64::from(size) };
    let points = || mesh.triangles().iter().flatten().map(|&v| mesh.position(v).as_dvec3());
    let dir = vec("dir").unwrap_or(DVec3::ONE);
    let camera = match (vec("eye"), vec("target"), get("ortho")) {
        (Some(eye), Some(target), _) => {
            Camera::perspective(eye, target, None, num("fov", 60.0), page)
        }
        (_, _, Some(_)) => Camera::fit_orthographic(points(), dir, None, page),
        _ => Camera::fit_perspective(points(), dir, None, num("fov", 30.0), page),
    }
    .unwrap();
    let filter = if get("all").is_some() { EdgeFilter::All } else { EdgeFilter::Convex };
    let mut contours = Vec::new();
    contour_edges(&mesh, &adjacency, camera.viewpoint(), filter, &mut contours);
    lap("contours");
    let options = LineOptions {
        boundary: get("boundary").is_some(),
        crease_angle: get("crease").map(|v| v.parse::<f64>().unwrap().to_radians()),
    };
    let segments = Segments::new(&mesh, &adjacency, &contours, &options);
    lap("segments");
    let occluders = Occluders::new(&mesh, &adjacency);
    lap("bvh");
    let d = VisibilityParams::default();
    let params = VisibilityParams {
        close_gaps: num("gap", d.close_gaps),
        drop_specks: num("speck", d.drop_specks),
        ..d
    };
    let drawing = match get("glass") {
        None => Drawing::new(&occluders, &segments, &camera, &params),
        _ => Drawing::through_glass(&mesh, &segments, &camera),
    };
    lap("visibility");
    let hidden = match get("hidden") {
        Some("dashed") => HiddenLines::Dashed,
        Some(_) => HiddenLines::Solid,
        None => HiddenLines::None,
    };
    let style = Style { width: num("width", 1.5), hidden, ..Style::default() };
    match args[1].ends_with("png") {
        true => std::fs::write(&args[1], to_png(&drawing, &style).unwrap()).unwrap(),
        _ => std::fs::write(&args[1], to_svg(&drawing, &style, &args[0])).unwrap(),
    }
    lap("write");
    for l in &drawing.layers {
        eprint!(
            "{}: {} chains {} segments {} runs, visible {:.0} hidden {:.0}; ",
            l.class.name(),
            l.chains,
            l.segments,
            l.runs.len(),
            l.visible_length(),
            l.hidden_length()
        );
    }
    eprintln!();
}
