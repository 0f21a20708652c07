//! The examples without a window, run as a user runs them.

mod support;

use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs an example that writes a picture, and gives the share of its dark pixels.
#[track_caller]
fn darkness(name: &str, arguments: &[&str]) -> Result<f64, Box<dyn Error>> {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
    let output = Command::new(support::example(name)).args(arguments).arg(&path).output()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout)?;
    assert!(said.contains("edges_tested"), "{said}");
    let pixels = pixels(&path)?;
    let is_dark = |pixel: &&[u8]| pixel[..3].iter().all(|&channel| channel < 100);
    let count = pixels.chunks_exact(4).filter(is_dark).count();
    Ok(count as f64 / (pixels.len() / 4) as f64)
}

fn pixels(path: &Path) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut png = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
    let mut pixels = vec![0; png.output_buffer_size().ok_or("it fits memory")?];
    png.next_frame(&mut pixels)?;
    Ok(pixels)
}

#[test]
fn pictures_of_the_examples_have_lines() -> Result<(), Box<dyn Error>> {
    if support::is_without_gpu() {
        return Ok(());
    }
    let model = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("tetrahedron.obj");
    std::fs::write(
        &model,
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
    )?;
    let tetrahedron = darkness("headless", &[&model.to_string_lossy()])?;
    assert!((1e-4..0.02).contains(&tetrahedron), "{tetrahedron}");
    let field = darkness("render_graph", &[])?;
    assert!((0.01..0.2).contains(&field), "{field}");
    let knots = darkness("rigged", &[])?;
    assert!((0.005..0.2).contains(&knots), "{knots}");
    Ok(())
}

/// Where there is a model that moves.
#[test]
fn a_crowd_has_the_same_contours_through_patches() -> Result<(), Box<dyn Error>> {
    let folder = std::env::var_os("DRYPOINT_MODELS");
    let Some(folder) = folder.filter(|_| !support::is_without_gpu()) else { return Ok(()) };
    let fox = Path::new(&folder).join("Fox.glb");
    if !fox.exists() {
        return Ok(());
    }
    let output = Command::new(support::example("crowd")).arg(fox).arg("12").output()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout)?;
    let found =
        |line: &str| line.split("; ").nth(1).and_then(|said| said.split(' ').next()?.parse().ok());
    let counts: Vec<u64> = said.lines().filter_map(found).collect();
    let [brute_force, patches] = counts[..] else { panic!("{said}") };
    // But for edges within the margin of f32.
    assert!(brute_force > 12 * 100 && brute_force.abs_diff(patches) <= brute_force / 100, "{said}");
    Ok(())
}
