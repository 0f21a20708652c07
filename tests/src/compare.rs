//! Every extractor against the definition.

use drypoint_cpu::{BruteForce, extract_all_wings, extract_patches};
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges};

/// How an extractor disagrees with the definition, with all that is needed to see it again.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// The extractor.
    pub extractor: &'static str,
    /// From where.
    pub viewpoint: Viewpoint,
    /// Edges of the definition that the extractor did not find.
    pub lost: Vec<EdgeId>,
    /// Edges that it found and the definition does not have.
    pub invented: Vec<EdgeId>,
}

/// What agreed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Viewpoints looked from.
    pub viewpoints: usize,
    /// Contour edges found, over all viewpoints.
    pub contour_edges: usize,
    /// Edges that patches tested, over all viewpoints.
    pub edges_tested: usize,
}

/// Looks at `mesh` from every viewpoint with every extractor; the first that disagrees with
/// [`contour_edges`] is an error.
pub fn compare(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    patches: &PatchSet,
    viewpoints: &[Viewpoint],
) -> Result<Agreement, Box<Disagreement>> {
    let filter: EdgeFilter = patches.edge_filter();
    let mut brute_force = BruteForce::new(mesh, adjacency, filter);
    let (mut expected, mut found) = (Vec::new(), Vec::new());
    let mut agreement = Agreement::default();
    for &viewpoint in viewpoints {
        contour_edges(mesh, adjacency, viewpoint, filter, &mut expected);
        brute_force.extract(viewpoint, &mut found);
        check("brute-force", viewpoint, &expected, &found)?;
        extract_all_wings(patches, viewpoint, &mut found);
        check("brute-force over patches", viewpoint, &expected, &sorted(&found))?;
        let statistics = extract_patches(patches, viewpoint, &mut found);
        check("patches", viewpoint, &expected, &sorted(&found))?;
        agreement.viewpoints += 1;
        agreement.contour_edges += expected.len();
        agreement.edges_tested += statistics.edges_tested;
    }
    Ok(agreement)
}

fn sorted(edges: &[EdgeId]) -> Vec<EdgeId> {
    let mut edges = edges.to_vec();
    edges.sort_unstable();
    edges
}

/// Both sorted; an edge found twice is invented.
fn check(
    extractor: &'static str,
    viewpoint: Viewpoint,
    expected: &[EdgeId],
    found: &[EdgeId],
) -> Result<(), Box<Disagreement>> {
    if expected == found {
        return Ok(());
    }
    let without = |these: &[EdgeId], those: &[EdgeId]| {
        these.iter().copied().filter(|edge| those.binary_search(edge).is_err()).collect()
    };
    let mut invented: Vec<EdgeId> = without(found, expected);
    invented.extend(found.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]));
    Err(Box::new(Disagreement { extractor, viewpoint, lost: without(expected, found), invented }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn lost_and_invented_edges_are_named() {
        let viewpoint = Viewpoint::at(DVec3::ZERO);
        let edges = |ids: &[u32]| ids.iter().map(|&id| EdgeId(id)).collect::<Vec<_>>();
        let check = |expected: &[u32], found: &[u32]| {
            check("it", viewpoint, &edges(expected), &edges(found))
                .map_err(|wrong| (wrong.lost, wrong.invented))
        };
        assert_eq!(check(&[1, 2, 5], &[1, 2, 5]), Ok(()));
        assert_eq!(check(&[1, 2, 5], &[1, 3, 5]), Err((edges(&[2]), edges(&[3]))));
        assert_eq!(check(&[1, 2], &[1, 1, 2]), Err((edges(&[]), edges(&[1]))));
    }
}
