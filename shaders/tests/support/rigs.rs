//! Rigs to test on, their poses, and what the definition says about them: included by path.
#![allow(dead_code, reason = "each test program uses what it needs")]
#![allow(clippy::cast_possible_truncation, reason = "rigs of tests are small")]

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, PatchSet, fuse_shapes};
use drypoint_mesh::rig::{Influence, Offset, Pose, Rig, RigBuilder, Skin};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, Viewpoint, shapes};
use drypoint_shaders::{Placement, RigInstance, RigLayout};
use fastrand::Rng;
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

/// A rig, split, with patches of all edges that keep their shape.
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) rig: Rig,
    pub(crate) skin: Skin,
    pub(crate) patches: Vec<PatchSet>,
}

impl Subject {
    pub(crate) fn new(name: &str, rig: Rig) -> Self {
        let skin = Skin::new(&rig).expect("positions are finite");
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse_shapes(&skin, EdgeFilter::All, &FusionParams::FAST, &go_on);
        Self { name: name.to_owned(), rig, skin, patches: patches.expect("nothing stops it") }
    }
}

/// Rigs with each thing that a rig may have.
pub(crate) fn subjects() -> Vec<Subject> {
    vec![
        Subject::new("tube", tube(24, 40, 1.0)),
        Subject::new("far tube", tube(12, 20, 1e4)),
        Subject::new("assembly", assembly()),
        Subject::new("face with targets", face_with_targets()),
        Subject::new("pairs of triangles", pairs_of_triangles()),
        Subject::new("nothing", RigBuilder::default().finish()),
    ]
}

/// A closed tube along z that two joints bend: rings at its ends follow one of them, and rings between both. It
/// is that far from where the spaces of the joints begin.
pub(crate) fn tube(sides: u32, rings: u32, offset: f32) -> Rig {
    let mut builder = RigBuilder::default();
    let joints = [0, 1].map(|joint| builder.carrier(None, Some(joint)));
    let mut vertex = |position: Vec3, ring: u32| {
        let share = (2.0 * f64::from(ring) / f64::from(rings - 1) - 0.5).clamp(0.0, 1.0);
        let influences = [(joints[0], 1.0 - share, 0.0), (joints[1], share, 1.0)];
        let influences: Vec<_> = influences
            .into_iter()
            .filter(|&(_, weight, _)| weight > 0.0)
            .map(|(carrier, weight, z)| {
                let position = position - z * Vec3::Z + offset * Vec3::X;
                Influence { carrier, weight, position }
            })
            .collect();
        builder.vertex(&influences, &[])
    };
    let mut grid = Vec::new();
    for ring in 0..rings {
        let z = 2.0 * ring as f32 / (rings - 1) as f32;
        let at = |side: u32| {
            let angle = std::f32::consts::TAU * side as f32 / sides as f32;
            let radius = 0.3 + 0.05 * (5.0 * z + 3.0 * angle).sin();
            Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        let ring: Vec<u32> = (0..sides).map(|side| vertex(at(side), ring)).collect();
        grid.push(ring);
    }
    let ends = [vertex(Vec3::ZERO, 0), vertex(2.0 * Vec3::Z, rings - 1)];
    for side in 0..sides as usize {
        let next = (side + 1) % sides as usize;
        for pair in grid.windows(2) {
            let [low, high] = [&pair[0], &pair[1]];
            builder.triangle([low[side], low[next], high[next]]);
            builder.triangle([low[side], high[next], high[side]]);
        }
        builder.triangle([ends[0], grid[0][next], grid[0][side]]);
        let last = grid.len() - 1;
        builder.triangle([ends[1], grid[last][side], grid[last][next]]);
    }
    builder.finish()
}

/// Adds `mesh`, all of it carried by `carrier`.
fn add(builder: &mut RigBuilder, mesh: &Mesh, carrier: u32) {
    let vertices: Vec<u32> = mesh
        .positions()
        .iter()
        .map(|&position| builder.vertex(&[Influence { carrier, weight: 1.0, position }], &[]))
        .collect();
    for triangle in mesh.triangles() {
        builder.triangle(triangle.map(|corner| vertices[corner as usize]));
    }
}

/// Five screws, two nuts, two washers, and a plate: three classes of shapes.
pub(crate) fn assembly() -> Rig {
    let mut builder = RigBuilder::default();
    let meshes = [
        (shapes::torus_knot(400), 5),
        (shapes::bumpy_sphere(300), 2),
        (shapes::icosphere(80), 2),
        (shapes::cad_part(600), 1),
    ];
    let mut next = 0;
    for (mesh, copies) in &meshes {
        for _ in 0..*copies {
            let carrier = builder.carrier(None, Some(next));
            add(&mut builder, mesh, carrier);
            next += 1;
        }
    }
    builder.finish()
}

/// A sphere, part of which three morph targets displace, one of them beyond it.
fn face_with_targets() -> Rig {
    let mut builder = RigBuilder::default();
    let head = builder.carrier(None, None);
    let targets = [0.0, 0.5, 0.0].map(|rest| builder.morph(0, rest));
    let mesh = shapes::icosphere(1_200);
    let vertices: Vec<u32> = mesh
        .positions()
        .iter()
        .map(|&position| {
            let offset = |morph, by| Offset { morph, influence: 0, by };
            let reach = (position.z - 0.2).max(0.0);
            let offsets = [
                offset(targets[0], reach * Vec3::new(0.3, 0.1, 0.5)),
                offset(targets[1], reach * position.x * Vec3::Y),
                offset(targets[2], if position.z > 0.7 { 3.0 * Vec3::Z } else { Vec3::ZERO }),
            ];
            builder.vertex(&[Influence { carrier: head, weight: 1.0, position }], &offsets)
        })
        .collect();
    for triangle in mesh.triangles() {
        builder.triangle(triangle.map(|corner| vertices[corner as usize]));
    }
    builder.finish()
}

/// Two rigid triangles that meet in an edge whose ends follow both their carriers by halves, and one more at the
/// same edge, wound against them: parts without an edge of their own, and edges of three faces.
fn pairs_of_triangles() -> Rig {
    let mut builder = RigBuilder::default();
    let carriers = [0, 1].map(|mesh| builder.carrier(None, Some(mesh)));
    let at = |carrier: usize, position: Vec3| Influence {
        carrier: carriers[carrier],
        weight: 1.0,
        position: 1e3 * position,
    };
    let halves =
        |position: Vec3| [0, 1].map(|carrier| Influence { weight: 0.5, ..at(carrier, position) });
    let ends = [Vec3::ZERO, Vec3::X].map(|position| builder.vertex(&halves(position), &[]));
    let mut tip = |carrier: usize, position: Vec3| builder.vertex(&[at(carrier, position)], &[]);
    let [left, right] = [tip(0, Vec3::Y), tip(1, Vec3::new(0.3, -1.0, 0.5))];
    let mut corner = |x: f32| tip(1, Vec3::new(x, 2.0, 1.0));
    let alone = [0.0, 1.0, 2.0].map(&mut corner);
    let third = tip(0, Vec3::new(0.4, 0.1, -1.0));
    builder.triangle([ends[0], ends[1], left]);
    builder.triangle([ends[1], ends[0], right]);
    builder.triangle([ends[1], ends[0], third]);
    builder.triangle([alone[0], alone[1], right]);
    builder.triangle([alone[1], alone[0], left]);
    builder.triangle(alone);
    builder.finish()
}

/// At rest, turned, mirrored here and there, flattened to planes, and to lines and points.
pub(crate) fn poses(rig: &Rig, rng: &mut Rng) -> Vec<Pose> {
    let mut poses = vec![rig.rest()];
    for kind in 0..5 {
        let mut pose = rig.rest();
        for to_scene in &mut pose.to_scene {
            let mut number = |most: f64| most * (2.0 * rng.f64() - 1.0);
            let axis = DVec3::new(number(1.0), number(1.0), number(1.0));
            let turn = DQuat::from_scaled_axis(axis * if kind == 0 { 0.3 } else { 3.0 });
            let moved = DVec3::new(number(2.0), number(2.0), number(2.0));
            let mut scale = DVec3::ONE + 0.3 * DVec3::new(number(1.0), number(1.0), number(1.0));
            match kind {
                2 if rng.bool() => scale.x = -scale.x,
                3 => scale[rng.usize(0..3)] = 0.0,
                4 => (0..rng.usize(0..4)).for_each(|axis| scale[axis] = 0.0),
                _ => {}
            }
            *to_scene = DAffine3::from_scale_rotation_translation(scale, turn, moved);
        }
        pose.weights.iter_mut().for_each(|weight| *weight = 1.5 * rng.f64() - 0.2);
        poses.push(pose);
    }
    poses
}

/// Whether a carrier is flattened.
pub(crate) fn is_flat(pose: &Pose) -> bool {
    pose.to_scene.iter().any(|to_scene| to_scene.matrix3.determinant().abs() < 1e-9)
}

/// Afar, close by, inside, and directions.
pub(crate) fn viewpoints(rng: &mut Rng) -> Vec<Viewpoint> {
    let mut direction = || DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5);
    let distances = [0.1, 1.0, 3.0, 30.0, 1e5];
    let mut all: Vec<_> =
        distances.into_iter().map(|distance| Viewpoint::at(direction() * distance)).collect();
    all.push(Viewpoint::from_direction(direction()));
    all.push(Viewpoint::from_direction(DVec3::Y));
    all
}

/// The rig as it is, and moved, turned and mirrored, seen in its own space from `viewpoint`.
pub(crate) fn placements(viewpoint: Viewpoint) -> [Placement; 2] {
    let turned = DMat3::from_rotation_y(0.7) * DMat3::from_diagonal(DVec3::new(-2.0, 2.0, 2.0));
    let to_scene = DAffine3 { matrix3: turned, translation: DVec3::new(5.0, -3.0, 2.0) };
    let moved = if viewpoint.is_point() {
        Viewpoint::at(to_scene.transform_point3(viewpoint.xyz()))
    } else {
        Viewpoint::from_direction(to_scene.transform_vector3(viewpoint.xyz()))
    };
    [Placement::at_origin(viewpoint), Placement { to_scene, viewpoint: moved }]
}

/// What the definition says of one instance.
pub(crate) struct Expected {
    /// Contour edges that f32 must find too.
    pub(crate) sure: BTreeSet<EdgeId>,
    /// Edges with a face within the margin that are contour edges, and that are not.
    pub(crate) doubtful: [BTreeSet<EdgeId>; 2],
}

impl Expected {
    pub(crate) fn new(subject: &Subject, layout: &RigLayout, instance: &RigInstance<'_>) -> Self {
        let Subject { rig, skin, .. } = subject;
        let faces = layout.doubtful_faces(rig, skin, instance);
        let adjacency = skin.adjacency();
        let is_doubtful = |edge: &EdgeId| {
            adjacency.sides(*edge).iter().any(|side| faces[side.triangle() as usize])
        };
        let viewpoint = instance.placement.viewpoint_of_part().expect("it has an inverse");
        let mut contours = Vec::new();
        skin.contour_edges(rig, instance.pose, viewpoint, EdgeFilter::All, &mut contours);
        let (doubtful, sure): (BTreeSet<_>, BTreeSet<_>) =
            contours.into_iter().partition(|edge| is_doubtful(edge));
        let others = skin.edges(EdgeFilter::All).filter(is_doubtful);
        let others = others.filter(|edge| !doubtful.contains(edge)).collect();
        Self { sure, doubtful: [doubtful, others] }
    }

    /// Compares what was found, sorted. The number of edges within the margin that differ.
    #[track_caller]
    pub(crate) fn compare(&self, found: &[EdgeId], what: &str) -> usize {
        assert!(found.is_sorted_by(|a, b| a < b), "{what}: an edge is there twice");
        let missing = self.sure.iter().find(|edge| found.binary_search(edge).is_err());
        assert_eq!(missing, None, "{what}: it is missing");
        let [contours, others] = &self.doubtful;
        let is_known =
            |edge: &&EdgeId| [&self.sure, contours, others].iter().any(|e| e.contains(edge));
        assert_eq!(
            found.iter().find(|edge| !is_known(edge)),
            None,
            "{what}: it is no contour edge"
        );
        let lost = contours.iter().filter(|edge| found.binary_search(edge).is_err()).count();
        lost + found.iter().filter(|edge| others.contains(edge)).count()
    }

    pub(crate) fn doubtful_count(&self) -> usize {
        self.doubtful.iter().map(BTreeSet::len).sum()
    }
}
