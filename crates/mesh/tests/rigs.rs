//! Rigs against what the glTF specification says, worked out anew from the file, in f64.
#![cfg(feature = "gltf")]

use std::cmp::Ordering;
use std::path::PathBuf;

use drypoint_mesh::io::{Format, Model, parse};
use drypoint_mesh::rig::{Pose, Rig, Skin};
use drypoint_mesh::{EdgeFilter, EdgeId, Viewpoint, contour_edges};
use glam::{DMat4, DQuat, DVec3, Vec3};
use gltf::animation::util::ReadOutputs;
use gltf::animation::{Interpolation, Property};

const MODELS: [&str; 3] = ["RobotExpressive.glb", "BrainStem.glb", "Fox.glb"];

/// Of each model at hand its bytes, and what we read of it.
fn models() -> Vec<(&'static str, Vec<u8>, Model)> {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS").map(PathBuf::from) else {
        return Vec::new();
    };
    let read = |name| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let model = parse(Format::Gltf, &bytes).unwrap();
        (name, bytes, model)
    };
    MODELS.map(read).into()
}

/// Another reader of the same file: corners of triangles, in the order in which they are drawn.
struct Oracle {
    document: gltf::Document,
    blob: Vec<u8>,
    locals: Vec<(DVec3, DQuat, DVec3)>,
    matrices: Vec<Option<DMat4>>,
    weights: Vec<Vec<f64>>,
}

impl Oracle {
    fn new(bytes: &[u8]) -> Self {
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(bytes).unwrap();
        let vector = |v: [f32; 3]| Vec3::from_array(v).as_dvec3();
        let (mut locals, mut matrices, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for node in document.nodes() {
            let (t, r, s) = node.transform().decomposed();
            locals.push((vector(t), DQuat::from_array(r.map(f64::from)), vector(s)));
            matrices.push(match node.transform() {
                gltf::scene::Transform::Matrix { matrix } => Some(matrix_of(matrix)),
                gltf::scene::Transform::Decomposed { .. } => None,
            });
            let mesh = node.mesh();
            let given = node.weights().or(mesh.as_ref().and_then(|mesh| mesh.weights()));
            weights.push(given.unwrap_or(&[]).iter().map(|&w| f64::from(w)).collect());
        }
        Self { document, blob: blob.unwrap(), locals, matrices, weights }
    }

    /// Moves nodes and weights to a time. Straight between keys, which is all that the models at hand have.
    fn animate(&mut self, animation: usize, seconds: f64) {
        let animation = self.document.animations().nth(animation).unwrap();
        for channel in animation.channels() {
            assert_eq!(channel.sampler().interpolation(), Interpolation::Linear);
            let reader = channel.reader(|_| Some(&self.blob));
            let times: Vec<f64> = reader.read_inputs().unwrap().map(f64::from).collect();
            let key = times.iter().rposition(|&time| time <= seconds).unwrap_or(0);
            let next = (key + 1).min(times.len() - 1);
            let span = times[next] - times[key];
            let t = if span > 0.0 { ((seconds - times[key]) / span).clamp(0.0, 1.0) } else { 0.0 };
            let node = channel.target().node().index();
            let mix = |values: Vec<[f32; 3]>| {
                let [a, b] = [key, next].map(|k| Vec3::from_array(values[k]).as_dvec3());
                a.lerp(b, t)
            };
            match reader.read_outputs().unwrap() {
                ReadOutputs::Translations(values) => self.locals[node].0 = mix(values.collect()),
                ReadOutputs::Scales(values) => self.locals[node].2 = mix(values.collect()),
                ReadOutputs::Rotations(values) => {
                    let values: Vec<[f32; 4]> = values.into_f32().collect();
                    let [a, b] = [key, next]
                        .map(|k| DQuat::from_array(values[k].map(f64::from)).normalize());
                    self.locals[node].1 = a.slerp(b, t);
                }
                ReadOutputs::MorphTargetWeights(values) => {
                    let values: Vec<f64> = values.into_f32().map(f64::from).collect();
                    let width = values.len() / times.len();
                    let at = |k: usize, i: usize| values[k * width + i];
                    let mixed = |i| at(key, i) + t * (at(next, i) - at(key, i));
                    self.weights[node] = (0..width).map(mixed).collect();
                }
            }
            if channel.target().property() != Property::MorphTargetWeights {
                self.matrices[node] = None;
            }
        }
    }

    fn globals(&self) -> Vec<DMat4> {
        let mut globals = vec![DMat4::IDENTITY; self.locals.len()];
        let mut open: Vec<(gltf::Node<'_>, DMat4)> =
            self.document.default_scene().unwrap().nodes().map(|n| (n, DMat4::IDENTITY)).collect();
        while let Some((node, parent)) = open.pop() {
            let (translation, rotation, scale) = self.locals[node.index()];
            let local = self.matrices[node.index()].unwrap_or_else(|| {
                let unit = rotation.normalize();
                DMat4::from_scale_rotation_translation(scale, unit, translation)
            });
            globals[node.index()] = parent * local;
            open.extend(node.children().map(|child| (child, parent * local)));
        }
        globals
    }

    /// Corners of all triangles, in the scene, those of the file's order.
    fn corners(&self) -> Vec<[DVec3; 3]> {
        let globals = self.globals();
        let mut corners = Vec::new();
        let scene = self.document.default_scene().unwrap();
        let mut open: Vec<gltf::Node<'_>> = scene.nodes().collect();
        open.reverse();
        while let Some(node) = open.pop() {
            for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
                let places = self.places(&node, &primitive, &globals);
                let reader = primitive.reader(|_| Some(&self.blob));
                let indices: Vec<u32> = match reader.read_indices() {
                    Some(indices) => indices.into_u32().collect(),
                    None => (0..).take(places.len()).collect(),
                };
                corners.extend(
                    indices
                        .chunks_exact(3)
                        .map(|t| [t[0], t[1], t[2]].map(|vertex| places[vertex as usize])),
                );
            }
            let mut children: Vec<_> = node.children().collect();
            children.reverse();
            open.extend(children);
        }
        corners
    }

    fn places(
        &self,
        node: &gltf::Node<'_>,
        primitive: &gltf::Primitive<'_>,
        globals: &[DMat4],
    ) -> Vec<DVec3> {
        let reader = primitive.reader(|_| Some(&self.blob));
        let vector = |v: [f32; 3]| Vec3::from_array(v).as_dvec3();
        let mut stored: Vec<DVec3> = reader.read_positions().unwrap().map(vector).collect();
        let weights = &self.weights[node.index()];
        for (target, weight) in reader.read_morph_targets().zip(weights) {
            for (place, by) in stored.iter_mut().zip(target.0.into_iter().flatten()) {
                *place += *weight * vector(by);
            }
        }
        let joints = reader.read_joints(0).map(|joints| joints.into_u16().collect::<Vec<_>>());
        let (Some(skin), Some(joints)) = (node.skin(), joints) else {
            return stored.iter().map(|p| globals[node.index()].transform_point3(*p)).collect();
        };
        let weights: Vec<[f32; 4]> = reader.read_weights(0).unwrap().into_f32().collect();
        let binds = skin.reader(|_| Some(&self.blob)).read_inverse_bind_matrices().unwrap();
        let matrices: Vec<DMat4> = skin
            .joints()
            .zip(binds)
            .map(|(joint, bind)| globals[joint.index()] * matrix_of(bind))
            .collect();
        let blend = |(vertex, place): (usize, &DVec3)| {
            let pairs = || joints[vertex].iter().zip(weights[vertex]);
            let sum: f64 = pairs().map(|(_, weight)| f64::from(weight)).sum();
            let moved = pairs().map(|(&joint, weight)| {
                f64::from(weight) / sum * matrices[joint as usize].transform_point3(*place)
            });
            moved.sum()
        };
        stored.iter().enumerate().map(blend).collect()
    }
}

fn matrix_of(matrix: [[f32; 4]; 4]) -> DMat4 {
    DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from)))
}

/// A name for messages, animation and time if it is not at rest, and the pose.
type Sample = (String, Option<(usize, f64)>, Pose);

/// Poses of a rig: at rest, and at times of each animation, before its first key and after its last too.
fn poses(rig: &Rig) -> Vec<Sample> {
    let mut poses = vec![("rest".to_owned(), None, rig.rest())];
    for (index, animation) in rig.animations().iter().enumerate() {
        for part in [-0.1, 0.0, 0.21, 0.5, 0.83, 1.2] {
            let seconds = part * animation.duration();
            let name = format!("{} at {seconds}", animation.name);
            poses.push((name, Some((index, seconds)), rig.pose_at(index, seconds)));
        }
    }
    poses
}

#[test]
fn vertices_are_where_the_specification_says() {
    for (name, bytes, model) in models() {
        let rig = model.rig.unwrap();
        let size = model.mesh.bounds().unwrap().half_longest_side();
        for (pose_name, animation, pose) in poses(&rig) {
            let mut oracle = Oracle::new(&bytes);
            if let Some((animation, seconds)) = animation {
                oracle.animate(animation, seconds);
            }
            let expected = oracle.corners();
            assert_eq!(expected.len(), rig.triangles().len(), "{name}");
            for (corners, triangle) in expected.iter().zip(rig.triangles()) {
                // A triangle that is turned over has the same first corner.
                let found = triangle.map(|vertex| rig.position(vertex, &pose));
                let distance = |order: [usize; 3]| {
                    let pairs = corners.iter().zip(order.map(|i| found[i]));
                    pairs.map(|(a, b)| a.distance(b)).fold(0.0, f64::max)
                };
                let off = distance([0, 1, 2]).min(distance([0, 2, 1]));
                assert!(off < 4e-7 * size, "{name}, {pose_name}: off by {off}");
            }
        }
    }
}

/// The side of a face that a viewpoint is on, and whether that is beyond what rounding its corners and
/// those of the same face in another space can change.
fn side(corners: [DVec3; 3], viewpoint: Viewpoint) -> (Ordering, bool) {
    let [a, b, c] = corners;
    let (u, v, w) = (b - a, c - a, viewpoint.from_point(a));
    let volume = u.cross(v).dot(w);
    let size = corners.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let moved = 4.0 * size * f64::from(f32::EPSILON);
    let doubt = moved * ((u.length() + v.length()) * w.length() + u.length() * v.length());
    (volume.total_cmp(&0.0), volume.abs() > doubt)
}

fn viewpoints(size: f64) -> Vec<Viewpoint> {
    let directions = [
        DVec3::new(0.3, 0.2, 1.0),
        DVec3::new(-1.0, 0.7, 0.4),
        DVec3::new(0.5, -0.9, -0.6),
        DVec3::new(0.1, 1.0, -0.2),
    ];
    let near = directions.map(|d| Viewpoint::at(1.7 * size * d.normalize()));
    let far = directions.map(|d| Viewpoint::at(20.0 * size * d.normalize()));
    let infinite = directions.map(Viewpoint::from_direction);
    [near, far, infinite].concat()
}

#[test]
fn contours_are_those_of_the_skinned_surface() {
    let (mut compared, mut doubtful) = (0usize, 0usize);
    for (name, bytes, model) in models() {
        let rig = model.rig.unwrap();
        let skin = Skin::new(&rig).unwrap();
        let size = model.mesh.bounds().unwrap().half_longest_side();
        for (pose_name, animation, pose) in poses(&rig) {
            let mut oracle = Oracle::new(&bytes);
            if let Some((animation, seconds)) = animation {
                oracle.animate(animation, seconds);
            }
            let corners = oracle.corners();
            for viewpoint in viewpoints(size) {
                let mut contours = Vec::new();
                skin.contour_edges(&rig, &pose, viewpoint, EdgeFilter::All, &mut contours);
                let sides: Vec<_> = corners.iter().map(|&c| side(c, viewpoint)).collect();
                for edge in skin.edges(EdgeFilter::All) {
                    let [left, right] =
                        skin.adjacency().sides(edge).map(|half| sides[half.triangle() as usize]);
                    let turned = skin.adjacency().is_right_turned(edge);
                    let expected = (left.0 == right.0) == turned;
                    let found = contours.binary_search(&edge).is_ok();
                    compared += 1;
                    if !left.1 || !right.1 {
                        doubtful += 1;
                        continue;
                    }
                    assert_eq!(found, expected, "{name}, {pose_name}, {viewpoint:?}: {edge:?}");
                }
            }
        }
    }
    // A margin that swallows everything would hide everything.
    assert!(
        doubtful * 500 < compared || compared == 0,
        "{doubtful} of {compared} edges are in doubt"
    );
}

/// What is decided on the surface in a pose, rounded to f32, is the same but for some faces that are seen
/// edge-on.
#[test]
fn contours_are_nearly_those_of_the_posed_mesh() {
    let (mut edges, mut differing) = (0usize, 0usize);
    for (_, _, model) in models() {
        let rig = model.rig.unwrap();
        let skin = Skin::new(&rig).unwrap();
        let size = model.mesh.bounds().unwrap().half_longest_side();
        for (_, _, pose) in poses(&rig) {
            let mesh = rig.mesh(&pose).unwrap();
            let adjacency = rig.adjacency(&mesh);
            for viewpoint in viewpoints(size) {
                let [mut of_rig, mut of_mesh] = [(); 2].map(|()| Vec::<EdgeId>::new());
                skin.contour_edges(&rig, &pose, viewpoint, EdgeFilter::All, &mut of_rig);
                contour_edges(&mesh, &adjacency, viewpoint, EdgeFilter::All, &mut of_mesh);
                let mut pairs: Vec<_> =
                    of_rig.iter().map(|&e| skin.adjacency().wing(e).ends()).collect();
                let mut expected: Vec<_> =
                    of_mesh.iter().map(|&e| adjacency.wing(e).ends()).collect();
                pairs.sort_unstable();
                expected.sort_unstable();
                edges += skin.adjacency().wings().len();
                differing +=
                    pairs.iter().filter(|pair| expected.binary_search(pair).is_err()).count();
                differing +=
                    expected.iter().filter(|pair| pairs.binary_search(pair).is_err()).count();
            }
        }
    }
    assert!(differing * 100_000 < edges || edges == 0, "{differing} of {edges}");
}

/// The share of rigid edges of TB24's Table 2 runs from 45 to 98 %.
#[test]
fn models_have_the_parts_that_are_known() {
    // Parts, loose edges, and the share of rigid edges in thousandths.
    let expected = [(20, 938, 802), (18, 0, 1000), (9, 724, 162)];
    for ((name, _, model), expected) in models().into_iter().zip(expected) {
        let skin = Skin::new(&model.rig.unwrap()).unwrap();
        #[expect(clippy::cast_possible_truncation, reason = "a share is at most 1")]
        let share = (1000.0 * skin.rigid_share()).round() as i32;
        assert_eq!((skin.parts().len(), skin.loose().len(), share), expected, "{name}");
    }
}
