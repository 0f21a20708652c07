//! Where the nodes of a document are.

use ::gltf::json;
use glam::{DMat4, DQuat, DVec3};

use super::document::object;
use crate::io::error::{Fault, Place, ReadError};

/// The nodes of a document as a forest.
#[derive(Debug)]
pub(super) struct Nodes {
    /// For each node its transform to the scene.
    transforms: Vec<DMat4>,
    /// Nodes that are no one's child.
    roots: Vec<usize>,
}

impl Nodes {
    /// The nodes of `root`. Linear.
    ///
    /// # Errors
    /// A node with two parents, or below itself; a child that does not exist.
    pub(super) fn of(root: &json::Root) -> Result<Self, ReadError> {
        let mut has_parent = vec![false; root.nodes.len()];
        for (index, node) in root.nodes.iter().enumerate() {
            for child in node.children.iter().flatten() {
                object(&root.nodes, child.value(), "nodes", &place(index))?;
                if std::mem::replace(&mut has_parent[child.value()], true) {
                    return Err(Fault::TwoParents.at(place(child.value())));
                }
            }
        }
        let roots: Vec<usize> = (0..root.nodes.len()).filter(|&node| !has_parent[node]).collect();
        let mut transforms = vec![None; root.nodes.len()];
        let mut open: Vec<(usize, DMat4)> = roots.iter().map(|&n| (n, DMat4::IDENTITY)).collect();
        while let Some((index, parent)) = open.pop() {
            let transform = parent * local_transform(&root.nodes[index]);
            transforms[index] = Some(transform);
            let children = root.nodes[index].children.iter().flatten();
            open.extend(children.map(|child| (child.value(), transform)));
        }
        // Whatever has a parent and hangs from no root goes round in a circle.
        let reached = |(index, transform): (usize, Option<DMat4>)| {
            transform.ok_or_else(|| Fault::Cycle.at(place(index)))
        };
        let transforms =
            transforms.into_iter().enumerate().map(reached).collect::<Result<_, _>>()?;
        Ok(Self { transforms, roots })
    }

    /// The transform of a node to the scene.
    pub(super) fn transform(&self, node: usize) -> DMat4 {
        self.transforms[node]
    }

    /// The nodes to draw, each once, parents before their children.
    pub(super) fn drawn(&self, root: &json::Root) -> Result<Vec<usize>, ReadError> {
        let scenes = match root.scene {
            Some(scene) => {
                let place = Place::Json("scene".to_owned());
                std::slice::from_ref(object(&root.scenes, scene.value(), "scenes", &place)?)
            }
            None => root.scenes.as_slice(),
        };
        let mut open = if scenes.is_empty() { self.roots.clone() } else { Vec::new() };
        for node in scenes.iter().flat_map(|scene| &scene.nodes) {
            let place = Place::Json("scenes".to_owned());
            object(&root.nodes, node.value(), "nodes", &place)?;
            open.push(node.value());
        }
        open.reverse();
        let mut drawn = Vec::new();
        let mut seen = vec![false; root.nodes.len()];
        while let Some(index) = open.pop() {
            if !std::mem::replace(&mut seen[index], true) {
                drawn.push(index);
                let children = root.nodes[index].children.iter().flatten().rev();
                open.extend(children.map(|child| child.value()));
            }
        }
        Ok(drawn)
    }
}

fn place(node: usize) -> Place {
    Place::Json(format!("nodes[{node}]"))
}

fn local_transform(node: &json::Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |quaternion| {
        // Stored in f32, so of unit length only nearly.
        let quaternion = DQuat::from_array(quaternion.0.map(f64::from));
        let length = quaternion.length();
        if length > 0.0 { quaternion / length } else { DQuat::IDENTITY }
    });
    DMat4::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, vector),
        rotation,
        node.translation.map_or(DVec3::ZERO, vector),
    )
}
