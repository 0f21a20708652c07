//! The example `mesh_viewer` in a window of a virtual X server, under the validation layers: what it shows, and
//! that it hears keys.

#[path = "../../wgpu/tests/support/screen.rs"]
mod screen;
mod support;

use std::error::Error;
use std::path::Path;

use screen::{C, Counts, ESCAPE, Picture, SIZE, SPACE, Session, V};

/// Mesh workgroups that were launched, and those of them that were idle.
fn workgroups(title: &str) -> Option<[u64; 2]> {
    let (_, workgroups) = title.split_once("mesh shaders in ")?;
    let mut words = workgroups.split_whitespace();
    let [launched, idle] = [words.next()?, words.nth(1)?];
    Some([launched.parse().ok()?, idle.parse().ok()?])
}

/// More contour edges than a viewer makes room for at first: a third of all edges of these, not a sixteenth.
const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn tests_all(title: &str) -> bool {
    let counts = Counts::of(title);
    title.contains("culling off") && counts.tested == counts.edges
}

#[test]
fn the_viewer_shows_the_same_by_mesh_shaders_and_by_compute_shaders() -> Result<(), Box<dyn Error>>
{
    if support::is_without_gpu() {
        return Ok(());
    }
    let (_server, display) = screen::start_server();
    let arguments = ["--instances", "30", "--still", "--validate"];
    let mut viewer = screen::start(&support::example("mesh_viewer"), &arguments, &display)?;
    let session = Session::new(&display)?;

    let is_counted = |title: &str| title.contains("edge") && Counts::of(title).contours > 0;
    let culled = session.wait_for("contours are counted", &is_counted);
    assert!(culled.contains("30 instances") && culled.contains("culling on"), "{culled}");
    assert!(culled.contains("s on the GPU; "), "it is timed: {culled}");
    let [launched, idle] = workgroups(&culled).expect("mesh shaders come first");
    assert!(idle <= launched && launched > 0, "{culled}");
    let culled = Counts::of(&culled);
    assert!(culled.tested < culled.edges / 2, "most are culled: {culled:?}");
    let lines = session.look_for("mesh-viewer-lines", SIZE, &Picture::is_drawing);

    session.focus()?;
    session.press(C)?;
    let all = session.wait_for("without culling all are tested", &tests_all);
    assert_eq!(Counts::of(&all).contours, culled.contours);
    let [more, _] = workgroups(&all).expect("still mesh shaders");
    assert!(more > 2 * launched, "{all}");
    assert!(session.look("mesh-viewer-all", SIZE)? == lines, "culling changes no picture");

    session.press(V)?;
    let is_compute = |title: &str| title.contains("by compute shaders") && tests_all(title);
    let computed = session.wait_for("compute shaders test all", &is_compute);
    assert_eq!(Counts::of(&computed).contours, culled.contours);
    assert!(session.look("mesh-viewer-compute", SIZE)? == lines, "compute shaders draw the same");
    session.press(C)?;
    let is_culled = |title: &str| Counts::of(title).tested == culled.tested;
    let computed = session.wait_for("compute shaders cull", &is_culled);
    assert!(computed.contains("culling on"), "{computed}");
    assert!(session.look("mesh-viewer-culled", SIZE)? == lines, "culling changes no picture");

    let half = SIZE.map(|side| side / 2);
    let corner = session.look("mesh-viewer-corner", half)?;
    session.resize(half)?;
    let is_smaller = |picture: &Picture| *picture != corner && picture.is_drawing();
    session.look_for("mesh-viewer-small", half, &is_smaller);
    session.press(V)?;
    session.wait_for("mesh shaders again", &|title| {
        // Which edges share a workgroup, and so which is idle, may differ from frame to frame.
        workgroups(title).is_some_and(|[again, _]| again == launched)
    });
    session.resize(SIZE)?;
    session.look_for("mesh-viewer-large", SIZE, &|picture| *picture == lines);

    session.press(SPACE)?;
    let has_turned = |picture: &Picture| *picture != lines && picture.is_drawing();
    session.look_for("mesh-viewer-turned", SIZE, &has_turned);
    session.press(ESCAPE)?;
    assert!(viewer.0.wait()?.success(), "the validation layers are silent");
    Ok(())
}

#[test]
fn the_viewer_makes_room_for_what_compute_shaders_find() -> Result<(), Box<dyn Error>> {
    if support::is_without_gpu() {
        return Ok(());
    }
    let model = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mesh-viewer.obj");
    std::fs::write(&model, TETRAHEDRON)?;
    let (_server, display) = screen::start_server();
    let arguments = [
        &*model.to_string_lossy(),
        "--instances",
        "1000",
        "--still",
        "--validate",
        "--compute",
        "--brute-force",
    ];
    let mut viewer = screen::start(&support::example("mesh_viewer"), &arguments, &display)?;
    let session = Session::new(&display)?;
    let is_counted = |title: &str| title.contains("edge") && Counts::of(title).contours > 1 << 10;
    let title = session.wait_for("contours are counted", &is_counted);
    assert!(title.contains("by compute shaders") && tests_all(&title), "{title}");
    session.focus()?;
    session.press(V)?;
    session.wait_for("mesh shaders", &|title| workgroups(title).is_some());
    let meshed = session.look_for("mesh-viewer-meshed", SIZE, &Picture::is_drawing);
    session.press(V)?;
    session.wait_for("compute shaders", &|title| title.contains("by compute shaders"));
    session.look_for("mesh-viewer-computed", SIZE, &|picture| *picture == meshed);
    session.press(ESCAPE)?;
    assert!(viewer.0.wait()?.success(), "the validation layers are silent");
    Ok(())
}
