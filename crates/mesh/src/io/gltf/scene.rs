//! Where the nodes of a document are.

use ::gltf::json;
use glam::{DAffine3, DMat4, DQuat, DVec3};

use super::document::object;
use crate::io::error::{Fault, Place, ReadError};
use crate::rig::{Local, Node};

/// The nodes of a document as a forest.
#[derive(Debug)]
pub(super) struct Nodes {
    /// For each node its transform to the scene.
    transforms: Vec<DAffine3>,
    /// Nodes that are no one's child.
    roots: Vec<usize>,
    /// All of them, parents before children, each with its parent.
    order: Vec<(usize, Option<usize>)>,
}

/// The space in which a node stands still.
#[derive(Clone, Copy)]
pub(super) struct Base {
    /// The nearest node that moves: itself or an ancestor. `None` is the scene.
    pub(super) node: Option<u32>,
    /// From the node to there.
    pub(super) to_base: DAffine3,
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
        let mut order = Vec::with_capacity(root.nodes.len());
        let mut open: Vec<_> = roots.iter().map(|&n| (n, None, DAffine3::IDENTITY)).collect();
        while let Some((index, parent, to_scene)) = open.pop() {
            order.push((index, parent));
            let transform = to_scene * local(&root.nodes[index]).to_affine();
            transforms[index] = Some(transform);
            let children = root.nodes[index].children.iter().flatten();
            open.extend(children.map(|child| (child.value(), Some(index), transform)));
        }
        // Whatever has a parent and hangs from no root goes round in a circle.
        let reached = |(index, transform): (usize, Option<DAffine3>)| {
            transform.ok_or_else(|| Fault::Cycle.at(place(index)))
        };
        let transforms =
            transforms.into_iter().enumerate().map(reached).collect::<Result<_, _>>()?;
        Ok(Self { transforms, roots, order })
    }

    /// The transform of a node to the scene.
    pub(super) fn transform(&self, node: usize) -> DAffine3 {
        self.transforms[node]
    }

    /// All nodes as those of a rig, of which some move.
    pub(super) fn of_rig(&self, root: &json::Root, moves: &[bool]) -> Vec<Node> {
        let mut nodes: Vec<Node> = (root.nodes.iter().zip(moves))
            .map(|(node, &moves)| {
                let name = node.name.clone().unwrap_or_default();
                Node { name, parent: None, rest: local(node), moves }
            })
            .collect();
        for &(index, parent) in &self.order {
            nodes[index].parent = parent.and_then(|parent| u32::try_from(parent).ok());
        }
        nodes
    }

    /// For each node the space in which it stands still, if only those that are told move.
    pub(super) fn bases(&self, root: &json::Root, moves: &[bool]) -> Vec<Base> {
        let scene = Base { node: None, to_base: DAffine3::IDENTITY };
        let mut bases = vec![scene; moves.len()];
        for &(index, parent) in &self.order {
            let of_parent = parent.map_or(scene, |parent| bases[parent]);
            bases[index] = if moves[index] {
                Base { node: u32::try_from(index).ok(), to_base: DAffine3::IDENTITY }
            } else {
                let to_base = of_parent.to_base * local(&root.nodes[index]).to_affine();
                Base { to_base, ..of_parent }
            };
        }
        bases
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

/// Where a node is in its parent's space.
fn local(node: &json::Node) -> Local {
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        return Local::Matrix(DAffine3::from_mat4(matrix));
    }
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    Local::Trs {
        translation: node.translation.map_or(DVec3::ZERO, vector),
        rotation: node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from))),
        scale: node.scale.map_or(DVec3::ONE, vector),
    }
}
