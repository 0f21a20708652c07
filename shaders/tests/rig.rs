//! The Rust twins of the shaders of rigs, against the definition.
#![allow(
    clippy::print_stdout,
    reason = "what is left to f32 is to be seen, as `--nocapture` shows it"
)]

#[path = "support/rigs.rs"]
mod rigs;

use drypoint_mesh::{EdgeFilter, EdgeId};
use drypoint_shaders::{RigContent, RigInput, RigInstance};
use fastrand::Rng;
use rigs::{Expected, Subject, is_flat, placements, poses, subjects, viewpoints};

/// The edges of one instance that shaders would find, sorted.
fn found(subject: &Subject, content: &RigContent, input: &RigInput, instance: u32) -> Vec<EdgeId> {
    let layout = &content.layout;
    let mut found = Vec::new();
    for (class, content) in layout.classes.iter().zip(&content.classes) {
        for (place, &part) in class.parts.iter().enumerate() {
            let placement = layout.placement(part, instance, input.most_instances);
            assert_eq!(layout.placed(placement, input.most_instances), (instance, Some(part)));
            let viewpoint = input.viewpoints[placement as usize];
            let edges = content.parts[place % class.shapes.len()].clone();
            for edge in edges.map(|edge| edge as usize) {
                if content.planes[edge].is_contour(viewpoint) {
                    let in_rig = &subject.skin.parts()[part as usize];
                    found.push(in_rig.edge_in_rig(content.ends[edge].edge));
                }
            }
        }
    }
    for edge in &content.loose_edges {
        let [left, right] =
            [edge.left_face, edge.right_face].map(|face| content.side(input, instance, face));
        if edge.is_contour(left, right) {
            found.push(edge.edge);
        }
    }
    found.sort_unstable();
    found
}

#[test]
fn what_is_found_of_rigs_is_exact_but_for_the_margin() {
    let mut rng = Rng::with_seed(11);
    for subject in subjects() {
        let Subject { name, rig, skin, patches } = &subject;
        let content = RigContent::new(rig, skin, patches).expect("patches are of the shapes");
        let [mut edges, mut sure, mut doubtful, mut differing] = [[0; 2]; 4];
        for (number, pose) in poses(rig, &mut rng).iter().enumerate() {
            let is_flat = usize::from(is_flat(pose));
            for viewpoint in viewpoints(&mut rng) {
                let instances =
                    placements(viewpoint).map(|placement| RigInstance { pose, placement });
                let mut input = RigInput::default();
                content.layout.place(&instances, 3, &mut input).expect("it can be placed");
                for (index, instance) in (0..).zip(&instances) {
                    let expected = Expected::new(&subject, &content.layout, instance);
                    let what = format!("{name}, pose {number}, {viewpoint:?}");
                    let found = found(&subject, &content, &input, index);
                    differing[is_flat] += expected.compare(&found, &what);
                    edges[is_flat] += skin.edges(EdgeFilter::All).count();
                    sure[is_flat] += expected.sure.len();
                    doubtful[is_flat] += expected.doubtful_count();
                }
            }
        }
        println!(
            "{name}, {} parts, {:.2} rigid: {sure:?} contour edges are sure, {doubtful:?} of {edges:?} edges within the margin, {differing:?} \
             differ (second: of poses that flatten something)",
            skin.parts().len(),
            skin.rigid_share()
        );
        // The far tube's vertices are rounded by a good part of its edges, by the definition too.
        let is_vacuous = doubtful[0] * 20 > edges[0] && *name != "far tube";
        assert!(!is_vacuous, "{name}: the margin would hide anything");
    }
}
