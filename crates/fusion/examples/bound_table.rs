//! What each bound brings: one fusion, and around its patches every kind of bound in turn.
//!
//! ```sh
//! cargo run --release -p drypoint-fusion --example bound_table -- bunny.obj default
//! ```
//!
//! The second argument is a preset: `fast`, `default`, `best`, `paper` or `paper-mean`; a third limits
//! the parts of space of the last two. The mesh is scaled to \[−1, 1\]. *Far* are the 252 viewpoints
//! of Tsiapkolis and Bénard, CGF 2024; *near* are 1000 on, in and beside the surface: over and
//! under 100 faces, at 0, ±0.01, ±0.1 and ±0.5 along the normal, and 300 anywhere in the box. Times
//! are of one thread, the least of five, normals included.
#![allow(clippy::print_stdout, reason = "the table is what this program is for")]

#[path = "support/mean.rs"]
mod mean;
#[path = "support/near.rs"]
mod near;
mod support;

use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_bounds::{DoubleCone, NormalCone, Plane, SpatializedNormalCone, Sphere};
use drypoint_fusion::{FusionParams, Patch, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, io};
use glam::DVec3;
use mean::mean_view;
use near::near_viewpoints;
use support::far_viewpoints;

const USAGE: &str =
    "usage: bound_table MESH [fast|default|best|paper|paper-mean [MOST_EDGES_IN_A_PART]]";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or(USAGE)?;
    let preset = match args.next().as_deref() {
        None | Some("default") => FusionParams::DEFAULT,
        Some("fast") => FusionParams::FAST,
        Some("best") => FusionParams::BEST,
        Some("paper") => FusionParams::PAPER,
        Some("paper-mean") => FusionParams::PAPER_MEAN,
        Some(_) => return Err(USAGE.into()),
    };
    let params = match args.next() {
        Some(most) => preset.with_max_partition(Some(most.parse()?)),
        None => preset,
    };
    let mesh =
        io::read(path.as_ref()).map_err(|error| format!("{path}: {error}"))?.mesh.normalized();
    let adjacency = MeshAdjacency::new(&mesh);
    let go_on = |_| ControlFlow::Continue(());
    let set = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)?;
    let always_tested = set.always_tested().len();
    println!(
        "{} patches of {} edges, {always_tested} edges always tested\n",
        set.patches().len(),
        set.wings().len() - always_tested,
    );
    println!(
        "| Bound | mean α | mean t | far: survivors | edges tested | near: survivors | edges tested | µs a patch |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let (far, near) = (far_viewpoints(), near_viewpoints(&mesh));
    for (name, bound) in BOUNDS {
        let build = || -> Vec<Patch> {
            let bounded = |patch: &Patch| Patch { bound: bound(&shapes(&set, patch)), ..*patch };
            set.patches().iter().map(bounded).collect()
        };
        let patches = build();
        let micros = 1e6 * least_seconds(|| drop(build())) / patches.len() as f64;
        let mean = |f: fn(&DoubleCone) -> f64| {
            patches.iter().map(|patch| f(&patch.bound)).sum::<f64>() / patches.len() as f64
        };
        let half_angle = mean(|bound| f64::from(bound.tan_squared).sqrt().atan().to_degrees());
        let apex_distance = mean(|bound| f64::from(bound.apex_distance));
        let [far, near] = [&far, &near].map(|views| mean_view(&patches, always_tested, views));
        println!(
            "| {name} | {half_angle:.2}° | {apex_distance:.5} | {:.0} | {:.0} | {:.0} | {:.0} | {micros:.1} |",
            far.survivors, far.tested, near.survivors, near.tested,
        );
    }
    Ok(())
}

/// Of five runs, the least: on a machine that does other things as well, the nearest to the truth.
fn least_seconds(run: impl Fn()) -> f64 {
    let seconds = |_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    (0..5).map(seconds).fold(f64::INFINITY, f64::min)
}

/// Unit normals of both faces of an edge, and its ends.
type Shape = ([DVec3; 2], [DVec3; 2]);

/// A way to bound a patch.
type Build = fn(&[Shape]) -> DoubleCone;

/// From the published bounds to ours, step by step.
const BOUNDS: [(&str, Build); 6] = [
    ("mean cone, Mean Sphere", |edges| {
        let mut vertices: Vec<DVec3> = edges.iter().flat_map(|edge| edge.1).collect();
        vertices.sort_unstable_by(|a, b| {
            a.to_array().map(f64::to_bits).cmp(&b.to_array().map(f64::to_bits))
        });
        vertices.dedup();
        let sphere = Sphere::mean(vertices.into_iter());
        SpatializedNormalCone { cone: NormalCone::mean(normals(edges)), sphere }.into()
    }),
    ("mean cone, Reduced Sphere", |edges| {
        let sphere = Sphere::reduced(lines(edges));
        SpatializedNormalCone { cone: NormalCone::mean(normals(edges)), sphere }.into()
    }),
    ("minimal cone, Reduced Sphere", |edges| {
        let sphere = Sphere::reduced(lines(edges));
        SpatializedNormalCone { cone: NormalCone::minimal(normals(edges)), sphere }.into()
    }),
    ("minimal cone, minimal sphere", |edges| {
        let sphere = Sphere::minimal(lines(edges));
        SpatializedNormalCone { cone: NormalCone::minimal(normals(edges)), sphere }.into()
    }),
    ("tight, about the center of the Reduced Sphere", |edges| {
        let axis = NormalCone::minimal(normals(edges)).axis;
        DoubleCone::about(axis, Sphere::reduced(lines(edges)).center, faces(edges))
    }),
    ("tight", |edges| DoubleCone::tight(faces(edges))),
];

fn normals(edges: &[Shape]) -> impl Iterator<Item = DVec3> + Clone {
    edges.iter().flat_map(|edge| edge.0)
}

fn lines(edges: &[Shape]) -> impl Iterator<Item = [DVec3; 2]> + Clone {
    edges.iter().map(|edge| edge.1)
}

fn faces(edges: &[Shape]) -> impl Iterator<Item = Plane> + Clone {
    edges.iter().flat_map(|(normals, [tail, head])| {
        normals.map(|normal| Plane { normal, point: 0.5 * (tail + head) })
    })
}

fn shapes(set: &PatchSet, patch: &Patch) -> Vec<Shape> {
    let position = |vertex: u32| set.positions()[vertex as usize].as_dvec3();
    let normal = |face: [u32; 3]| {
        let [a, b, c] = face.map(position);
        (b - a).normalize().cross((c - a).normalize()).normalize()
    };
    let wings = patch.edges().map(|place| set.wings()[place as usize]);
    wings
        .map(|w| ([normal(w.left_face()), normal(w.right_face())], w.ends().map(position)))
        .collect()
}
