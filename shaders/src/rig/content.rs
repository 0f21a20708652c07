//! From a rig and the patches of its shapes to what lies in buffers.

use std::collections::BTreeMap;

use drypoint_fusion::PatchSet;
use drypoint_mesh::EdgeId;
use drypoint_mesh::rig::{Rig, Skin};
use glam::{DVec3, Vec3};

use super::layout::{
    BendingFace, CarrierBox, ClassLayout, LooseEdge, MorphOffset, PartFace, PartPlace, RigCounts,
    RigLayout, VertexInfluence, count,
};
use crate::edge::plane;
use crate::{Content, Frame};

/// What is not there.
const NONE: u32 = u32::MAX;

/// All that extraction reads of a rig.
#[derive(Clone, Debug)]
pub struct RigContent {
    /// What there is, and how it is placed.
    pub layout: RigLayout,
    /// The shapes of each class, each as a part. Vertices are numbered among `positions`, and are not here.
    pub classes: Vec<Content>,
    /// Vertices of all shapes, in their own spaces.
    pub positions: Vec<Vec3>,
    /// Where the influences of each vertex that is posed begin.
    pub first_influences: Vec<u32>,
    /// Influences, vertex by vertex.
    pub influences: Vec<VertexInfluence>,
    /// What displaces them, influence by influence.
    pub offsets: Vec<MorphOffset>,
    /// All faces that bend, by index in the rig.
    pub bending_faces: Vec<BendingFace>,
    /// Faces of rigid parts beside loose edges.
    pub part_faces: Vec<PartFace>,
    /// Loose edges, by id.
    pub loose_edges: Vec<LooseEdge>,
}

impl RigContent {
    /// Of a rig that is split into `skin`, whose shapes have `patches`, in order. Linear, as
    /// [`Content::new`]; `None` if the patches are not those of the shapes.
    pub fn new(rig: &Rig, skin: &Skin, patches: &[PatchSet]) -> Option<Self> {
        let are_of_shapes = patches.len() == skin.shapes().len()
            && patches.iter().zip(skin.shapes()).all(|(set, shape)| {
                let edges = shape.adjacency.wings().len();
                set.positions() == shape.mesh.positions()
                    && set.edge_ids().iter().all(|edge| edge.index() < edges)
            });
        if !are_of_shapes {
            return None;
        }
        let layouts = class_layouts(skin);
        let (classes, positions) = contents(&layouts, patches);
        let parts = places(skin, &layouts, &classes);
        let mut loose = Loose::new(rig, skin);
        loose.add_faces(&parts);
        let carriers = loose.carrier_boxes();
        let (first_influences, influences, offsets) = loose.influences(&carriers);
        let counts = RigCounts {
            first_vertex: count(positions.len()),
            vertex_count: count(loose.vertices.len()),
            bending_count: count(loose.bending.len()),
            face_count: count(loose.bending.len() + loose.rigid.len()),
            carrier_count: count(carriers.len()),
            morph_count: count(rig.morphs().len()),
        };
        Some(Self {
            layout: RigLayout { counts, classes: layouts, parts, carriers },
            loose_edges: loose.edges(),
            bending_faces: loose.bending,
            part_faces: loose.rigid,
            classes,
            positions,
            first_influences,
            influences,
            offsets,
        })
    }

    /// Edges that an instance has: those of all its parts, and loose ones.
    pub fn edge_count(&self) -> u64 {
        let classes = self.classes.iter().zip(&self.layout.classes);
        let of_classes = classes
            .map(|(content, class)| u64::from(content.edge_count()) * u64::from(class.copies));
        of_classes.sum::<u64>() + self.loose_edges.len() as u64
    }
}

/// Shapes by how many parts have them.
fn class_layouts(skin: &Skin) -> Vec<ClassLayout> {
    let mut parts_of_shapes = vec![Vec::new(); skin.shapes().len()];
    for (part, rigid) in (0..).zip(skin.parts()) {
        parts_of_shapes[rigid.shape as usize].push(part);
    }
    let mut by_copies: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (shape, parts) in (0..).zip(&parts_of_shapes) {
        by_copies.entry(count(parts.len())).or_default().push(shape);
    }
    let mut placements_before = 0;
    let class = |(copies, shapes): (u32, Vec<u32>)| {
        let copy = |copy| shapes.iter().map(move |&shape| (shape as usize, copy));
        let parts = (0..copies as usize).flat_map(copy);
        let parts: Vec<u32> = parts.map(|(shape, copy)| parts_of_shapes[shape][copy]).collect();
        let before = placements_before;
        placements_before += count(parts.len());
        ClassLayout { shapes, copies, parts, placements_before: before }
    };
    by_copies.into_iter().map(class).collect()
}

/// The shapes of each class, and the vertices of all.
fn contents(layouts: &[ClassLayout], patches: &[PatchSet]) -> (Vec<Content>, Vec<Vec3>) {
    let mut positions = Vec::new();
    let content = |class: &ClassLayout| {
        let sets: Vec<&PatchSet> =
            class.shapes.iter().map(|&shape| &patches[shape as usize]).collect();
        let mut content = Content::of_shapes(&sets);
        let first_vertex = count(positions.len());
        for ends in &mut content.ends {
            ends.from_vertex += first_vertex;
            ends.to_vertex += first_vertex;
        }
        positions.append(&mut content.positions);
        content
    };
    (layouts.iter().map(content).collect(), positions)
}

fn places(skin: &Skin, layouts: &[ClassLayout], contents: &[Content]) -> Vec<PartPlace> {
    let mut places = vec![None; skin.parts().len()];
    for (class, content) in layouts.iter().zip(contents) {
        for (place, &part) in (0..).zip(&class.parts) {
            places[part as usize] = Some(PartPlace {
                carrier: skin.parts()[part as usize].carrier,
                frame: content.frames[place as usize % class.shapes.len()],
                placements_before: class.placements_before,
                class_placements: count(class.parts.len()),
                place,
            });
        }
    }
    places.into_iter().map(|place| place.expect("each part is of a class")).collect()
}

/// What loose edges need, in the making.
struct Loose<'a> {
    rig: &'a Rig,
    skin: &'a Skin,
    /// Of each vertex of the rig, its number among those that are posed.
    numbers: Vec<u32>,
    vertices: Vec<u32>,
    /// Of each face of the rig, its number among those that loose edges ask.
    face_numbers: Vec<u32>,
    bending: Vec<BendingFace>,
    rigid: Vec<PartFace>,
}

impl<'a> Loose<'a> {
    /// The vertices.
    fn new(rig: &'a Rig, skin: &'a Skin) -> Self {
        let mut numbers = vec![NONE; rig.vertex_count()];
        for (face, corners) in (0..).zip(rig.triangles()) {
            if skin.part_of_face(face).is_none() {
                corners.iter().for_each(|&corner| numbers[corner as usize] = 0);
            }
        }
        for &edge in skin.loose() {
            let ends = skin.adjacency().wing(edge).ends();
            ends.iter().for_each(|&end| numbers[end as usize] = 0);
        }
        let mut vertices = Vec::new();
        for (vertex, number) in (0..).zip(&mut numbers) {
            if *number != NONE {
                *number = count(vertices.len());
                vertices.push(vertex);
            }
        }
        let face_numbers = vec![NONE; rig.triangles().len()];
        Self { rig, skin, numbers, vertices, face_numbers, bending: Vec::new(), rigid: Vec::new() }
    }

    fn add_faces(&mut self, parts: &[PartPlace]) {
        for (face, corners) in (0..).zip(self.rig.triangles()) {
            if self.skin.part_of_face(face).is_none() {
                let carrier = self.rig.leading_carrier(corners[0]);
                let corners = corners.map(|corner| self.numbers[corner as usize]);
                self.face_numbers[face as usize] = count(self.bending.len());
                self.bending.push(BendingFace { corners, carrier });
            }
        }
        for face in self.skin.loose().iter().flat_map(|&edge| self.skin.adjacency().sides(edge)) {
            let face = face.triangle();
            if let Some((part, local)) = self.skin.part_of_face(face)
                && self.face_numbers[face as usize] == NONE
            {
                self.face_numbers[face as usize] = count(self.bending.len() + self.rigid.len());
                self.rigid.push(part_face(self.skin, &parts[part as usize], part, local));
            }
        }
    }

    fn edges(&self) -> Vec<LooseEdge> {
        let adjacency = self.skin.adjacency();
        let edge = |&edge: &EdgeId| {
            let [left_face, right_face] =
                adjacency.sides(edge).map(|side| self.face_numbers[side.triangle() as usize]);
            let [from_vertex, to_vertex] =
                adjacency.wing(edge).ends().map(|end| self.numbers[end as usize]);
            let is_right_turned = u32::from(adjacency.is_right_turned(edge));
            LooseEdge { left_face, right_face, from_vertex, to_vertex, edge, is_right_turned }
        };
        self.skin.loose().iter().map(edge).collect()
    }

    /// Around the vertices of each carrier, with each morph target at 0 and at 1.
    fn carrier_boxes(&self) -> Vec<CarrierBox> {
        let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let mut boxes = vec![nothing; self.rig.carriers().len()];
        for &vertex in &self.vertices {
            for (number, influence) in (0..).zip(self.rig.influences(vertex)) {
                let [low, high] = &mut boxes[influence.carrier as usize];
                let position = influence.position.as_dvec3();
                let offsets = self.rig.offsets(vertex).iter();
                let displaced = offsets.filter(|offset| offset.influence == number);
                let displaced = displaced.map(|offset| position + offset.by.as_dvec3());
                for position in std::iter::once(position).chain(displaced) {
                    *low = low.min(position);
                    *high = high.max(position);
                }
            }
        }
        let carrier = |[low, high]: [DVec3; 2]| CarrierBox {
            frame: Frame::of_box(low, high),
            half_sides: if low.is_finite() { (high - low) / 2.0 } else { DVec3::NEG_ONE },
        };
        boxes.into_iter().map(carrier).collect()
    }

    fn influences(
        &self,
        carriers: &[CarrierBox],
    ) -> (Vec<u32>, Vec<VertexInfluence>, Vec<MorphOffset>) {
        let (mut first, mut influences, mut offsets) = (Vec::new(), Vec::new(), Vec::new());
        for &vertex in &self.vertices {
            first.push(count(influences.len()));
            let of_vertex = self.rig.influences(vertex);
            for (number, influence) in (0..).zip(of_vertex) {
                let frame = carriers[influence.carrier as usize].frame;
                let first_offset = count(offsets.len());
                for offset in self.rig.offsets(vertex) {
                    if offset.influence == number {
                        let by = (offset.by.as_dvec3() * frame.scale).as_vec3();
                        offsets.push(MorphOffset { by, morph: offset.morph });
                    }
                }
                #[expect(clippy::cast_possible_truncation, reason = "rounded for shaders")]
                let weight = influence.weight as f32;
                influences.push(VertexInfluence {
                    position: frame.point(influence.position.as_dvec3()).as_vec3(),
                    weight,
                    carrier: influence.carrier,
                    first_offset,
                    offset_end: count(offsets.len()),
                    is_last: u32::from(number + 1 == count(of_vertex.len())),
                });
            }
        }
        (first, influences, offsets)
    }
}

fn part_face(skin: &Skin, place: &PartPlace, part: u32, local: u32) -> PartFace {
    let shape = &skin.shapes()[skin.parts()[part as usize].shape as usize];
    PartFace {
        plane: plane(shape.mesh.positions(), welded_face(skin, part, local), &place.frame)
            .as_vec4(),
        placements_before: place.placements_before,
        class_placements: place.class_placements,
        place: place.place,
        carrier: place.carrier,
    }
}

/// The corners of a face of a part as its edges name them.
pub(super) fn welded_face(skin: &Skin, part: u32, local: u32) -> [u32; 3] {
    let shape = &skin.shapes()[skin.parts()[part as usize].shape as usize];
    let representatives = shape.adjacency.representatives();
    shape.mesh.triangles()[local as usize].map(|corner| representatives[corner as usize])
}
