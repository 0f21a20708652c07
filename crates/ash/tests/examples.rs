//! The example without a window, run as a user runs it.

mod support;

use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;
use std::process::Command;

#[test]
fn the_picture_of_the_example_has_lines() -> Result<(), Box<dyn Error>> {
    if support::is_without_gpu() {
        return Ok(());
    }
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let [model, picture] = ["octahedron.obj", "octahedron.png"].map(|name| folder.join(name));
    std::fs::write(
        &model,
        "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\n\
         f 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n",
    )?;
    let output =
        Command::new(support::example("mesh_headless")).args([&model, &picture]).output()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout)?;
    assert!(said.contains("mesh_workgroups: 1,"), "{said}");
    let mut png = png::Decoder::new(BufReader::new(File::open(&picture)?)).read_info()?;
    let mut pixels = vec![0; png.output_buffer_size().ok_or("it fits memory")?];
    png.next_frame(&mut pixels)?;
    let is_dark = |pixel: &&[u8]| pixel[..3].iter().all(|&channel| channel < 100);
    let share = pixels.chunks_exact(4).filter(is_dark).count() as f64 / (pixels.len() / 4) as f64;
    assert!((1e-4..0.02).contains(&share), "{share}");
    Ok(())
}
