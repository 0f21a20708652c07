//! The example `viewer` in a window of a virtual X server: what it shows, and that it hears keys.

#[path = "support/screen.rs"]
mod screen;
mod support;

use std::error::Error;

use screen::{C, Counts, ESCAPE, P, Picture, SIZE, Session};

#[test]
fn the_viewer_shows_contours_and_hears_keys() -> Result<(), Box<dyn Error>> {
    if support::is_without_gpu() {
        return Ok(());
    }
    let (_server, display) = screen::start_server();
    let arguments = ["--instances", "30", "--still"];
    let mut viewer = screen::start(&support::example("viewer"), &arguments, &display)?;
    let session = Session::new(&display)?;

    let is_counted = |title: &str| title.contains("edge") && Counts::of(title).contours > 0;
    let culled = session.wait_for("contours are counted", &is_counted);
    assert!(culled.contains("30 instances") && culled.contains("culling on"), "{culled}");
    let culled = Counts::of(&culled);
    assert!(culled.tested < culled.edges / 2, "most are culled: {culled:?}");
    let lines = session.look_for("viewer-lines", SIZE, &Picture::is_drawing);

    session.focus()?;
    session.press(C)?;
    let tests_all = |title: &str| {
        let counts = Counts::of(title);
        title.contains("culling off") && counts.tested == counts.edges
    };
    let all = session.wait_for("without culling all are tested", &tests_all);
    assert_eq!(Counts::of(&all).contours, culled.contours);

    session.press(P)?;
    let has_colors = |picture: &Picture| picture.shares().colorful > 0.05;
    let patches = session.look_for("viewer-patches", SIZE, &has_colors).shares();
    assert!(patches.dark > 0.5 * lines.shares().dark, "lines are still there: {patches:?}");

    session.press(ESCAPE)?;
    assert!(viewer.0.wait()?.success());
    Ok(())
}
