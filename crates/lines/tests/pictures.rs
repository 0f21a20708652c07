//! What is written: SVG to the letter, PNG to the pixel.
#![cfg(all(feature = "visibility", feature = "svg", feature = "png"))]

use drypoint_lines::{
    Area, Camera, Color, Drawing, HiddenLines, LineOptions, Occluders, Page, PngError, Run,
    Segments, Style, Tint, VisibilityParams, to_png, to_svg,
};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, contour_edges, io, shapes};
use glam::{DVec2, DVec3, Vec3};
use tiny_skia::Pixmap;

const PAGE: Page = Page { width: 100, height: 80, margin: 10.0 };

fn draw(mesh: &Mesh, camera: &Camera) -> Drawing {
    let adjacency = MeshAdjacency::new(mesh);
    let mut contours = Vec::new();
    contour_edges(mesh, &adjacency, camera.viewpoint(), EdgeFilter::Convex, &mut contours);
    let options = LineOptions { boundary: true, crease_angle: Some(0.5), ..Default::default() };
    let segments = Segments::new(mesh, &adjacency, &contours, &options);
    let occluders = Occluders::new(mesh, &adjacency);
    Drawing::new(&occluders, &segments, camera, &VisibilityParams::default())
}

/// Two triangles seen from +Z, 10 pixels a unit, the second one half behind the first.
fn two_triangles() -> Drawing {
    let at = |x, y, z| Vec3::new(x, y, z);
    let positions = vec![
        at(-3.0, -2.0, 1.0),
        at(0.0, -2.0, 1.0),
        at(0.0, 2.0, 1.0),
        at(-1.0, -1.0, 0.0),
        at(1.0, -1.0, 0.0),
        at(0.25, 1.0 / 3.0, 0.0),
    ];
    let mesh = Mesh::new(positions, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
    draw(&mesh, &Camera::orthographic(DVec3::Z, DVec3::ZERO, None, 8.0, PAGE).unwrap())
}

#[test]
fn an_svg_says_what_its_lines_are() {
    let style = Style {
        background: Some(Color::opaque(250, 240, 0)),
        hidden: HiddenLines::Dashed,
        ..Style::default()
    };
    let expected = r##"<svg height="80" viewBox="0 0 100 80" width="100" xmlns="http://www.w3.org/2000/svg">
<title>
a &lt;b&gt; &amp; "c"
</title>
<rect class="background" fill="#faf000" height="80" width="100"/>
<g class="boundary hidden" fill="none" stroke="#000000" stroke-dasharray="6 4.5" stroke-linecap="butt" stroke-linejoin="round" stroke-width="0.75">
<path d="M50 39.33L40 50 50 50" data-edges="5 3"/>
</g>
<g class="boundary" fill="none" stroke="#000000" stroke-linecap="round" stroke-linejoin="round" stroke-width="1.5">
<path d="M20 60L50 60 50 20Z" data-edges="0 1 2"/>
<path d="M50 50L60 50 52.5 36.67 50 39.33" data-edges="3 4 5"/>
</g>
</svg>
"##;
    let found = to_svg(&two_triangles(), &style, "a <b>\u{1} & \"c\"");
    // Whether the writer puts a title on lines of its own is up to it.
    let tidy = |text: &str| text.replace("<title>\n", "<title>").replace("\n</title>", "</title>");
    assert_eq!(tidy(&found), tidy(expected));
}

#[test]
fn hidden_lines_are_drawn_when_asked_for() {
    let with = |hidden| to_svg(&two_triangles(), &Style { hidden, ..Style::default() }, "");
    assert!(!with(HiddenLines::None).contains("hidden"));
    assert!(with(HiddenLines::Solid).contains("class=\"boundary hidden\""));
    assert!(!with(HiddenLines::Solid).contains("dash"));
    let see_through = Color { red: 1, green: 2, blue: 3, alpha: 51 };
    let svg = to_svg(&two_triangles(), &Style { color: see_through, ..Style::default() }, "");
    assert!(svg.contains("opacity=\"0.2\" stroke=\"#010203\""), "{svg}");
}

fn pixels(drawing: &Drawing, style: &Style) -> Pixmap {
    Pixmap::decode_png(&to_png(drawing, style).unwrap()).unwrap()
}

#[track_caller]
fn check_pixel(pixmap: &Pixmap, [x, y]: [u32; 2], expected: [u8; 4]) {
    let found = pixmap.pixel(x, y).unwrap().demultiply();
    let found = [found.red(), found.green(), found.blue(), found.alpha()];
    let apart = found.iter().zip(expected).map(|(f, e)| f.abs_diff(e)).max();
    assert!(apart <= Some(1), "pixel {x}, {y} is {found:?}, not {expected:?}");
}

#[test]
fn a_png_shows_the_same_drawing() {
    let [white, black] = [[255; 4], [0, 0, 0, 255]];
    let thick = Style { width: 3.0, ..Style::default() };
    let picture = pixels(&two_triangles(), &thick);
    assert_eq!((picture.width(), picture.height()), (100, 80));
    check_pixel(&picture, [30, 60], black);
    check_pixel(&picture, [30, 50], white);
    check_pixel(&picture, [55, 50], black);
    check_pixel(&picture, [45, 50], white);
    // Hidden lines are half as wide: 1.5 pixels around y = 50 leave none white, none black.
    let solid = pixels(&two_triangles(), &Style { hidden: HiddenLines::Solid, ..thick });
    check_pixel(&solid, [45, 50], [64, 64, 64, 255]);
    let dashed = pixels(&two_triangles(), &Style { hidden: HiddenLines::Dashed, ..thick });
    let row = |picture: &Pixmap| -> Vec<u8> {
        (41..49).map(|x| picture.pixel(x, 50).unwrap().red()).collect()
    };
    assert!(row(&dashed).contains(&255) && row(&dashed).iter().any(|&red| red < 100));
    let inverse = Style {
        color: Color::WHITE,
        background: Some(Color { red: 0, green: 0, blue: 0, alpha: 0 }),
        ..thick
    };
    let inverse = pixels(&two_triangles(), &inverse);
    check_pixel(&inverse, [30, 60], white);
    check_pixel(&inverse, [30, 50], [0; 4]);
}

#[test]
fn a_picture_of_nothing_is_a_picture() {
    let camera = Camera::fit_perspective([], DVec3::ONE, None, 30.0, PAGE).unwrap();
    let drawing = draw(&shapes::empty(), &camera);
    check_pixel(&pixels(&drawing, &Style::default()), [50, 40], [255; 4]);
    let svg = to_svg(&drawing, &Style::default(), "nothing");
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("<g"));
    let page = Page { width: 65_535, height: 65_535, margin: 0.0 };
    let too_large = PngError::TooLarge { width: 65_535, height: 65_535 };
    assert_eq!(
        to_png(&Drawing { page, layers: vec![], areas: vec![], labels: vec![] }, &Style::default()),
        Err(too_large)
    );
}

#[test]
fn lines_end_at_the_border_of_the_page() {
    let ball = shapes::icosphere(1280);
    let camera = Camera::perspective(DVec3::Z * 3.0, DVec3::X * 0.8, None, 40.0, PAGE).unwrap();
    let drawing = draw(&ball, &camera);
    let runs: Vec<&Run> = drawing.layers.iter().flat_map(|layer| &layer.runs).collect();
    assert!(!runs.is_empty());
    let on_border = |x: f64, side: f64| x.abs() < 1e-9 || (x - side).abs() < 1e-9;
    for run in runs {
        assert!(!run.closed);
        for point in &run.points {
            assert!(point.x > -1e-9 && point.x < 100.0 + 1e-9, "{point}");
            assert!(point.y > -1e-9 && point.y < 80.0 + 1e-9, "{point}");
        }
        for end in [run.points[0], run.points[run.points.len() - 1]] {
            assert!(on_border(end.x, 100.0) || on_border(end.y, 80.0), "{end} is on the page");
        }
    }
}

/// Pours ink into the corner of the page and counts the faces whose middle it reaches: none or few,
/// unless the outline leaks.
fn share_flooded(mesh: &Mesh, towards_viewer: DVec3) -> f64 {
    let page = Page { width: 700, height: 700, margin: 20.0 };
    let points = || mesh.triangles().iter().flatten().map(|&v| mesh.position(v).as_dvec3());
    let camera = Camera::fit_perspective(points(), towards_viewer, None, 30.0, page).unwrap();
    let picture = pixels(&draw(mesh, &camera), &Style { width: 2.0, ..Style::default() });
    let is_paper =
        |x: u32, y: u32| x < 700 && y < 700 && picture.pixel(x, y).is_some_and(|p| p.red() > 128);
    let mut reached = vec![false; 700 * 700];
    let mut next = vec![(0u32, 0u32)];
    while let Some((x, y)) = next.pop() {
        if is_paper(x, y) && !reached[(700 * y + x) as usize] {
            reached[(700 * y + x) as usize] = true;
            let [left, up] = [x, y].map(|i| i.wrapping_sub(1));
            next.extend([(x + 1, y), (left, y), (x, y + 1), (x, up)]);
        }
    }
    let middles = mesh.triangles().iter().map(|t| {
        let sum: DVec3 = t.iter().map(|&v| mesh.position(v).as_dvec3()).sum();
        camera.project(sum / 3.0).unwrap()
    });
    let is_reached = |middle: &DVec2| {
        #[expect(clippy::cast_possible_truncation, reason = "on the page")]
        let [x, y] = [middle.x as usize, middle.y as usize];
        reached[700 * y + x]
    };
    middles.filter(is_reached).count() as f64 / mesh.triangles().len() as f64
}

const DIRECTIONS: [DVec3; 4] = [
    DVec3::ONE,
    DVec3::new(-0.3, 0.2, 1.0),
    DVec3::new(1.0, 0.1, -0.4),
    DVec3::new(0.2, -1.0, 0.3),
];

#[test]
fn outlines_do_not_leak() {
    for shapes::NamedMesh { name, mesh } in shapes::closed() {
        for towards_viewer in DIRECTIONS {
            let share = share_flooded(&mesh, towards_viewer);
            assert!(share < 0.01, "{name} from {towards_viewer}: {share} flooded");
        }
    }
    // So dense that its outline is made of very many short runs.
    let share = share_flooded(&shapes::bumpy_sphere(100_000), DVec3::ONE);
    assert!(share < 0.01, "{share} flooded");
    let mut open = shapes::icosphere(1280).triangles().to_vec();
    open.truncate(1200);
    let leaky = Mesh::new(shapes::icosphere(1280).positions().to_vec(), open).unwrap();
    let adjacency = MeshAdjacency::new(&leaky);
    assert!(adjacency.report().boundary > 0, "the boundary closes the outline");
    assert!(share_flooded(&leaky, DVec3::ONE) < 0.01);
}

#[test]
fn outlines_of_models_do_not_leak() {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS") else { return };
    for name in [
        "stanford-bunny.obj",
        "armadillo.obj",
        "fandisk.obj",
        "spot.obj",
        "cow.obj",
        "suzanne.obj",
        "teapot.obj",
        "dragon_vrip.ply",
    ] {
        let path = std::path::Path::new(&folder).join(name);
        let mesh = io::read(&path).unwrap().mesh;
        for towards_viewer in DIRECTIONS {
            let share = share_flooded(&mesh, towards_viewer);
            assert!(share < 0.01, "{name} from {towards_viewer}: {share} flooded");
        }
    }
}

#[test]
fn areas_lie_under_the_lines() {
    let tint = Tint { name: "land".into(), color: Color::opaque(0, 200, 0), spread: 1.0 };
    let ring = [[20.0, 20.0], [60.0, 20.0], [60.0, 60.0], [20.0, 60.0]];
    let hole = [[30.0, 30.0], [30.0, 50.0], [50.0, 50.0], [50.0, 30.0]];
    let rings = [ring, hole].map(|ring| ring.map(DVec2::from_array).to_vec()).to_vec();
    let drawing = Drawing { areas: vec![Area { tint, rings }], ..two_triangles() };
    let svg = to_svg(&drawing, &Style::default(), "");
    let expected = r##"<g class="areas" stroke-linejoin="round">
<path class="land" d="M20 20L60 20 60 60 20 60ZM30 30L30 50 50 50 50 30Z" fill="#00c800" stroke="#00c800" stroke-width="2"/>
</g>
<g class="boundary""##;
    assert!(svg.contains(expected), "{svg}");
    let png = Pixmap::decode_png(&to_png(&drawing, &Style::default()).unwrap()).unwrap();
    let at = |x, y| png.pixel(x, y).map(|p| [p.red(), p.green(), p.blue()]).unwrap();
    let (land, paper) = ([0, 200, 0], [255; 3]);
    assert_eq!([at(25, 25), at(30, 40), at(40, 40), at(70, 40)], [land, land, paper, paper]);
    let [red, green, blue] = at(49, 50);
    assert!(red == 0 && green < 100 && blue == 0, "a line over the area, whose rim is blended");
}
