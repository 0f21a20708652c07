//! Extracts contours of a glTF model at times of its animations, and says what patches save.
//!
//! ```sh
//! cargo run --release -p drypoint-cpu --example poses -- robot.glb
//! ```
//!
//! Each animation is looked at 12 times in its course, from each of 21 viewpoints: 7 directions, at 5, 10 and
//! 50 half-lengths of the model's longest side. What is found is compared with the definition first; then the
//! same extractor is timed with patches and without, by turns.
#![allow(clippy::print_stdout, reason = "the report is what this program is for")]

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_cpu::{Instructions, RigContours, RigExtractor};
use drypoint_fusion::{CostModel, FusionParams, fuse_shapes};
use drypoint_mesh::rig::{Pose, Rig, Skin};
use drypoint_mesh::{Aabb, EdgeFilter, Viewpoint, io};
use glam::DVec3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("a glTF file is needed")?;
    let model = io::read(file.as_ref()).map_err(|error| format!("{file}: {error}"))?;
    let rig = model.rig.ok_or(format!("{file}: nothing in it moves"))?;
    let bounds = model.mesh.bounds().ok_or("there is nothing to look at: the mesh has no faces")?;

    let skin = Skin::new(&rig)?;
    println!(
        "{} rigid parts of {} shapes, {} loose edges; {:.1} % of all edges with two faces are rigid; {:?}",
        skin.parts().len(),
        skin.shapes().len(),
        skin.loose().len(),
        100.0 * skin.rigid_share(),
        Instructions::newest(),
    );
    for (name, cost) in [("CPU_SIMD", CostModel::CPU_SIMD), ("PAPER", CostModel::PAPER)] {
        // Once for each model.
        let params = FusionParams { cost, ..FusionParams::DEFAULT };
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse_shapes(&skin, EdgeFilter::Convex, &params, &go_on)?;
        let extractor = RigExtractor::new(&rig, &skin, &patches);
        let count = patches.iter().map(|set| set.patches().len()).sum::<usize>();
        print!("CostModel::{name}: {count} patches; ");
        measure(&rig, &skin, &extractor, bounds)?;
    }
    Ok(())
}

/// Looks at all poses from all viewpoints.
fn measure(
    rig: &Rig,
    skin: &Skin,
    extractor: &RigExtractor<'_>,
    bounds: Aabb,
) -> Result<(), Box<dyn std::error::Error>> {
    let (mut found, mut expected) = (RigContours::default(), Vec::new());
    let (mut tested, mut contours, mut views) = (0, 0, 0);
    let (mut times, mut ratios) = (Vec::new(), Vec::new());
    for pose in poses(rig) {
        for viewpoint in viewpoints(bounds) {
            skin.contour_edges(rig, &pose, viewpoint, EdgeFilter::Convex, &mut expected);
            let statistics = extractor.edges(&pose, viewpoint, &mut found);
            let mut edges = found.edges().to_vec();
            edges.sort_unstable();
            if edges != expected {
                return Err(format!("other edges than the definition's from {viewpoint:?}").into());
            }
            let with = time(|| extractor.edges(&pose, viewpoint, &mut found));
            let without = time(|| extractor.all_edges(&pose, viewpoint, &mut found));
            times.push(with);
            ratios.push(without / with);
            tested += statistics.edges_tested;
            contours += statistics.contour_edges;
            views += 1;
        }
    }
    println!(
        "{} of {} edges tested, {} contour edges (means of {views} views); {:.1} µs a view, {:.2} times as \
         fast as without patches (medians)",
        tested / views,
        extractor.edge_count(),
        contours / views,
        median(&mut times),
        median(&mut ratios)
    );
    Ok(())
}

/// The course of each animation, or the rest of a model that has none.
fn poses(rig: &Rig) -> Vec<Pose> {
    const TIMES: u32 = 12;
    if rig.animations().is_empty() {
        return vec![rig.rest()];
    }
    let of_animation = |(index, animation): (usize, &drypoint_mesh::rig::Animation)| {
        let at = |time| f64::from(time) / f64::from(TIMES) * animation.duration();
        (0..TIMES).map(move |time| rig.pose_at(index, at(time))).collect::<Vec<_>>()
    };
    rig.animations().iter().enumerate().flat_map(of_animation).collect()
}

fn viewpoints(bounds: Aabb) -> Vec<Viewpoint> {
    let directions = [
        DVec3::Z,
        DVec3::new(1.0, 0.2, 0.4),
        DVec3::new(-0.7, 0.5, 1.0),
        DVec3::new(-0.3, 0.1, -1.0),
        DVec3::new(0.6, -0.4, -0.8),
        DVec3::new(0.1, 1.0, 0.3),
        DVec3::new(-1.0, 0.05, -0.1),
    ];
    let at = |distance: f64| {
        let unit = distance * bounds.half_longest_side();
        directions.map(|direction| Viewpoint::at(bounds.center() + unit * direction.normalize()))
    };
    [at(5.0), at(10.0), at(50.0)].concat()
}

/// Microseconds.
fn time<T>(extract: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    extract();
    1e6 * start.elapsed().as_secs_f64()
}

fn median(numbers: &mut [f64]) -> f64 {
    numbers.sort_unstable_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}
