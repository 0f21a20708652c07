//! A scene in which something can move, or in which a mesh is placed more than once: a rig.

use glam::{DAffine3, DVec3};

use super::accessor::Elements;
use super::animation::animations;
use super::document::{Document, object};
use super::scene::{Base, Nodes};
use super::skin::Skinning;
use super::welded::{Found, Welded, add};
use super::{Piece, Surface};
use crate::io::error::{Fault, Place, ReadError};
use crate::io::parts::{self, Dropped, Model, Parts};
use crate::rig::{Animation, Influence, Offset, Pose, Property, RigBuilder, posed_position};

/// The rig in the making, and where its vertices rest.
pub(super) struct Moving {
    builder: RigBuilder,
    /// Where the carriers made so far rest.
    pose: Pose,
    bases: Vec<Base>,
    /// Of each node the first of its morph targets, and how many there are.
    morphs: Vec<(u32, usize)>,
    /// Meshes that are placed more than once.
    is_repeated: Vec<bool>,
    strict: bool,
    welded: Welded,
    /// For each vertex of the rig the welded one.
    sources: Vec<u32>,
    /// In vertices of the rig.
    triangles: Vec<[u32; 3]>,
    dropped: Dropped,
}

/// What carries a vertex, and how it comes into that space.
#[derive(Clone, Copy)]
struct Carried {
    carrier: u32,
    weight: f64,
    bind: DAffine3,
}

impl Moving {
    /// `None` if nothing moves, and no mesh is placed more than once.
    pub(super) fn new(
        document: &Document<'_>,
        nodes: &Nodes,
        drawn: &[usize],
        strict: bool,
    ) -> Result<Option<Self>, ReadError> {
        let is_repeated = repeated_meshes(document, drawn)?;
        let targets = |node: usize| {
            let mesh = document.root.nodes[node].mesh.map(|mesh| mesh.value());
            mesh.and_then(|mesh| document.root.meshes.get(mesh)).map_or(0, |mesh| {
                let count = |p: &::gltf::json::mesh::Primitive| p.targets.iter().flatten().count();
                mesh.primitives.iter().map(count).max().unwrap_or(0)
            })
        };
        let animations = animations(document, targets)?;
        let moves = moving_nodes(document, drawn, &animations, &is_repeated)?;
        let has_morphs = drawn.iter().any(|&node| targets(node) > 0);
        if !moves.contains(&true) && !has_morphs {
            return Ok(None);
        }
        let mut builder = RigBuilder::new(nodes.of_rig(&document.root, &moves))
            .expect("nodes were found to be a forest");
        let mut morphs = vec![(0, 0); moves.len()];
        for &node in drawn {
            for target in 0..targets(node) {
                let slot = builder.morph(index(node), rest_weight(document, node, target));
                let first = if target == 0 { slot } else { morphs[node].0 };
                morphs[node] = (first, target + 1);
            }
        }
        animations.into_iter().for_each(|animation| builder.animation(animation));
        let bases = nodes.bases(&document.root, &moves);
        let (welded, sources, triangles, dropped) = Default::default();
        Ok(Some(Self {
            builder,
            pose: Pose::default(),
            bases,
            morphs,
            is_repeated,
            strict,
            welded,
            sources,
            triangles,
            dropped,
        }))
    }

    /// What carries a piece: all that may do so becomes a carrier.
    fn carrying<'a>(&mut self, piece: &Piece<'a>) -> Result<Carrying<'a>, ReadError> {
        let Some(skinning) = Skinning::new(piece.document, piece.node, piece.primitive)? else {
            let base = self.bases[piece.node];
            let mesh = self.is_repeated[piece.mesh].then(|| index(piece.mesh));
            let carrier = self.builder.carrier(base.node, mesh);
            return Ok(Carrying::Whole(Carried { carrier, weight: 1.0, bind: base.to_base }));
        };
        let joints = skinning.joints.iter();
        let carriers =
            joints.map(|&(node, _)| self.builder.carrier(Some(index(node)), None)).collect();
        let scene = self.builder.carrier(None, None);
        Ok(Carrying::Skin { skinning, carriers, scene })
    }
}

impl Surface for Moving {
    fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    fn add(&mut self, piece: &Piece<'_>) -> Result<(), ReadError> {
        let targets = targets(piece)?;
        let first_morph = self.morphs[piece.node].0;
        let carrying = self.carrying(piece)?;
        // After the last carrier of this piece was made.
        self.builder.extend_rest(&mut self.pose);
        let (mut joints, mut carried) = (Vec::new(), Vec::new());
        let (mut influences, mut offsets) = (Vec::new(), Vec::new());
        let spend = |units: usize| piece.document.spend(units as u64);
        let Self { builder, pose, welded, sources, triangles, dropped, strict, .. } = self;
        add(piece, triangles, (dropped, *strict), |vertex| {
            carrying.of_vertex(vertex, &mut joints, &mut carried)?;
            let stored = piece.position(vertex);
            influences.clear();
            offsets.clear();
            spend(carried.len() * (16 + targets.len()))?;
            for (number, Carried { carrier, weight, bind }) in (0..).zip(carried.iter().copied()) {
                let position = bind.transform_point3(stored).as_vec3();
                influences.push(Influence { carrier, weight, position });
                for (morph, target) in (first_morph..).zip(&targets) {
                    let by = bind.transform_vector3(displacement(target.as_ref(), vertex));
                    if by != DVec3::ZERO {
                        offsets.push(Offset { morph, influence: number, by: by.as_vec3() });
                    }
                }
            }
            spend((16 + carried.len()) * offsets.len())?;
            let at = posed_position(&influences, &offsets, pose);
            // Not finite if a part of it is not; by weight 0, only so.
            let is_finite = influences.iter().all(|influence| influence.position.is_finite())
                && offsets.iter().all(|offset| offset.by.is_finite());
            let Some(source) = welded.vertex(at.as_vec3()).filter(|_| is_finite) else {
                return Ok(Found::Nowhere(at));
            };
            let in_rig = builder.vertex(&influences, &offsets);
            if in_rig as usize == sources.len() {
                sources.push(source);
            }
            let heaviest = carried.iter().reduce(|a, b| if b.weight > a.weight { b } else { a });
            let mirrors = heaviest.is_some_and(|c| c.bind.matrix3.determinant() < 0.0);
            Ok(Found::Vertex(in_rig, mirrors))
        })
    }

    fn into_model(self, parts: Parts, materials: Parts) -> Result<Model, ReadError> {
        let Self { mut builder, welded, sources, triangles, dropped, .. } = self;
        triangles.iter().for_each(|&triangle| builder.triangle(triangle));
        let rig = builder.finish();
        let mirrored = rig.mirrored(&rig.rest());
        let resting = |&triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| sources[vertex as usize]);
            let is_turned = mirrored[rig.leading_carrier(triangle[0]) as usize];
            if is_turned { [a, c, b] } else { [a, b, c] }
        };
        let triangles = triangles.iter().map(resting).collect();
        let model = parts::model(welded.positions, triangles, parts, materials)?;
        Ok(Model { rig: Some(rig), rig_vertices: sources, dropped, ..model })
    }
}

/// What carries a piece.
enum Carrying<'a> {
    /// Its node.
    Whole(Carried),
    /// The joints of a skin, each with its carrier; the scene where a vertex follows none of them.
    Skin { skinning: Skinning<'a>, carriers: Vec<u32>, scene: u32 },
}

impl Carrying<'_> {
    /// Replaces `carried` by what carries a vertex.
    fn of_vertex(
        &self,
        vertex: usize,
        joints: &mut Vec<(usize, f64)>,
        carried: &mut Vec<Carried>,
    ) -> Result<(), Fault> {
        carried.clear();
        match self {
            Self::Whole(whole) => carried.push(*whole),
            Self::Skin { skinning, carriers, scene } => {
                skinning.influences(vertex, joints)?;
                carried.extend(joints.iter().map(|&(joint, weight)| Carried {
                    carrier: carriers[joint],
                    weight,
                    bind: skinning.joints[joint].1,
                }));
                if carried.is_empty() {
                    let bind = DAffine3::IDENTITY;
                    carried.push(Carried { carrier: *scene, weight: 1.0, bind });
                }
            }
        }
        Ok(())
    }
}

/// The displacements of each morph target of a piece; `None` for one that moves no vertex.
fn targets<'a>(piece: &Piece<'a>) -> Result<Vec<Option<Elements<'a>>>, ReadError> {
    let targets = piece.primitive.targets.iter().flatten();
    let read = |target: &::gltf::json::mesh::MorphTarget| {
        let accessor = target.positions.map(|accessor| accessor.value());
        accessor.map(|a| Elements::positions(piece.document, a, &piece.place)).transpose()
    };
    targets.map(read).collect()
}

fn displacement(target: Option<&Elements<'_>>, vertex: usize) -> DVec3 {
    let target = target.filter(|target| vertex < target.count());
    target.map_or(DVec3::ZERO, |target| [0, 1, 2].map(|i| target.real(vertex, i)).into())
}

/// Meshes that `drawn` nodes place more than once, as they are.
fn repeated_meshes(document: &Document<'_>, drawn: &[usize]) -> Result<Vec<bool>, ReadError> {
    let mut places = vec![0; document.root.meshes.len()];
    for &node in drawn {
        let json = &document.root.nodes[node];
        if let (Some(mesh), None) = (json.mesh, json.skin) {
            let place = Place::Json(format!("nodes[{node}]"));
            object(&document.root.meshes, mesh.value(), "meshes", &place)?;
            places[mesh.value()] += 1;
        }
    }
    Ok(places.into_iter().map(|places| places > 1).collect())
}

/// For each node whether it can move: by an animation, as a joint, or as one of several places of a mesh.
fn moving_nodes(
    document: &Document<'_>,
    drawn: &[usize],
    animations: &[Animation],
    is_repeated: &[bool],
) -> Result<Vec<bool>, ReadError> {
    let mut moves = vec![false; document.root.nodes.len()];
    let channels = animations.iter().flat_map(|animation| &animation.channels);
    for channel in channels.filter(|channel| channel.property != Property::Weights) {
        moves[channel.node as usize] = true;
    }
    let mut is_known = vec![false; document.root.skins.len()];
    for &node in drawn {
        let json = &document.root.nodes[node];
        let Some(mesh) = json.mesh.map(|mesh| mesh.value()) else { continue };
        moves[node] |= is_repeated.get(mesh).is_some_and(|&repeated| repeated);
        let place = Place::Json(format!("nodes[{node}]"));
        if let Some(skin) = json.skin {
            let json_skin = object(&document.root.skins, skin.value(), "skins", &place)?;
            if std::mem::replace(&mut is_known[skin.value()], true) {
                continue;
            }
            let place = Place::Json(format!("skins[{}]", skin.value()));
            for joint in &json_skin.joints {
                object(&document.root.nodes, joint.value(), "nodes", &place)?;
                moves[joint.value()] = true;
            }
        }
    }
    Ok(moves)
}

/// How much of a morph target is added to a node's mesh at rest.
fn rest_weight(document: &Document<'_>, node: usize, target: usize) -> f64 {
    let json = &document.root.nodes[node];
    let mesh = json.mesh.and_then(|mesh| document.root.meshes.get(mesh.value()));
    let weights = json.weights.as_ref().or(mesh.and_then(|mesh| mesh.weights.as_ref()));
    let weight = weights.and_then(|weights| weights.get(target)).copied().unwrap_or(0.0);
    if weight.is_finite() { weight.into() } else { 0.0 }
}

fn index(index: usize) -> u32 {
    u32::try_from(index).expect("a file of less than 4 GB lists fewer objects")
}
