//! What lines belong to.

use std::cmp::Ordering;
use std::collections::HashMap;

use drypoint_mesh::{Mesh, Viewpoint, face_side};

use crate::{Drawing, FaceNames, Run, Segment};

/// A part of a model and a material, by which a line can be told from others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Label {
    /// Empty if it has no name.
    pub part: String,
    /// Empty if it has no name.
    pub material: String,
}

impl Drawing {
    /// Says of each run which part and which material it belongs to, in [`Run::label`], and cuts runs
    /// where that changes, so that each can be selected with what it belongs to.
    ///
    /// A line lies in two faces. It belongs to the one that is turned towards the viewer, as that of a
    /// contour is; of two such to the first, which for an edge is the face on its left, and for an
    /// intersection the lower one. Linear, with a search in the names for each segment.
    ///
    /// # Panics
    /// If `mesh` is not that of the drawing.
    pub fn label(
        &mut self,
        mesh: &Mesh,
        viewpoint: Viewpoint,
        parts: &FaceNames,
        materials: &FaceNames,
    ) {
        let is_front = |face: u32| face_side(mesh.corners(face), viewpoint) != Ordering::Less;
        let names_of = |face: u32| [parts.of(face), materials.of(face)];
        let mut numbers: HashMap<[usize; 2], u32> = HashMap::new();
        let mut labels = Vec::new();
        let mut label_of = |segment: &Segment| {
            let [first, second] = segment.faces;
            let [of_first, of_second] = [first, second].map(names_of);
            let is_second = of_first != of_second && !is_front(first) && is_front(second);
            let names = if is_second { of_second } else { of_first };
            *numbers.entry(names).or_insert_with(|| {
                let [part, material] = names;
                labels.push(Label {
                    part: parts.names().get(part).cloned().unwrap_or_default(),
                    material: materials.names().get(material).cloned().unwrap_or_default(),
                });
                u32::try_from(labels.len() - 1).unwrap_or(u32::MAX)
            })
        };
        for layer in &mut self.layers {
            let runs = std::mem::take(&mut layer.runs);
            layer.runs.extend(runs.into_iter().flat_map(|run| run.cut(&mut label_of)));
        }
        self.labels = labels;
    }

    /// What a run belongs to, if that was asked for.
    pub fn label_of(&self, run: &Run) -> Option<&Label> {
        self.labels.get(run.label? as usize)
    }
}

impl Run {
    /// Cuts the run where the label of its segments changes.
    fn cut(mut self, label_of: &mut impl FnMut(&Segment) -> u32) -> Vec<Self> {
        let mut labels: Vec<u32> = self.segments.iter().map(label_of).collect();
        let Some(change) = (1..labels.len()).find(|&i| labels[i] != labels[i - 1]) else {
            self.label = labels.first().copied();
            return vec![self];
        };
        if self.closed {
            labels.rotate_left(change);
            self.segments.rotate_left(change);
            self.points.rotate_left(change);
            self.points.push(self.points[0]);
        }
        let mut runs = Vec::new();
        let mut start = 0;
        for same in labels.chunk_by(|a, b| a == b) {
            let end = start + same.len();
            runs.push(Self {
                points: self.points[start..=end].to_vec(),
                segments: self.segments[start..end].to_vec(),
                closed: false,
                visible: self.visible,
                label: Some(same[0]),
            });
            start = end;
        }
        runs
    }
}
