//! Every extractor against the definition.

use drypoint_cpu::{
    BruteForce, Contours, Extractor, Instructions, Statistics, extract_all_wings, extract_patches,
};
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges};
use rayon::prelude::*;

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
    /// Bounds that were tested, of patches and super-patches, over all viewpoints.
    pub bounds_tested: usize,
    /// Edges that patches tested, over all viewpoints.
    pub edges_tested: usize,
}

impl std::ops::Add for Agreement {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            viewpoints: self.viewpoints + other.viewpoints,
            contour_edges: self.contour_edges + other.contour_edges,
            bounds_tested: self.bounds_tested + other.bounds_tested,
            edges_tested: self.edges_tested + other.edges_tested,
        }
    }
}

/// One viewpoint in so many is also looked from without culling: that does not depend on bounds.
const ALL_WINGS_EVERY: usize = 8;

/// What is to be found in a mesh, by the definition, for comparing many patch sets of it.
#[derive(Clone, Debug)]
pub struct Expected {
    filter: EdgeFilter,
    /// Contour edges from each viewpoint, by id.
    views: Vec<(Viewpoint, Vec<EdgeId>)>,
}

impl Expected {
    /// Looks at `mesh` from every viewpoint, by the definition and by brute force. On all threads.
    ///
    /// # Errors
    /// Where brute force disagrees.
    pub fn new(
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
        viewpoints: &[Viewpoint],
    ) -> Result<Self, Box<Disagreement>> {
        let brute_force = BruteForce::new(mesh, adjacency, filter);
        let look = |brute_force: &mut BruteForce<'_>, &viewpoint: &Viewpoint| {
            let (mut expected, mut found) = (Vec::new(), Vec::new());
            contour_edges(mesh, adjacency, viewpoint, filter, &mut expected);
            brute_force.extract(viewpoint, &mut found);
            check("brute-force", viewpoint, &expected, &found)?;
            Ok((viewpoint, expected))
        };
        let views = viewpoints.par_iter().map_init(|| brute_force.clone(), look);
        Ok(Self { filter, views: views.collect::<Result<_, Box<Disagreement>>>()? })
    }

    /// Whether `patches`, made of the same mesh with the same filter, give the same from
    /// everywhere. On all threads.
    ///
    /// # Errors
    /// Where they do not.
    pub fn compare(&self, patches: &PatchSet) -> Result<Agreement, Box<Disagreement>> {
        assert_eq!(patches.edge_filter(), self.filter, "made with another filter");
        let extractors: Vec<(&str, Extractor<'_>)> =
            [("portable kernels", Instructions::Portable), ("AVX2 kernels", Instructions::Avx2)]
                .into_iter()
                .filter_map(|(name, set)| Some((name, Extractor::with(patches, set)?)))
                .collect();
        let mut ends =
            vec![[0; 2]; patches.edge_ids().iter().map(|e| e.index() + 1).max().unwrap_or(0)];
        for (edge, wing) in patches.edge_ids().iter().zip(patches.wings()) {
            ends[edge.index()] = wing.ends();
        }
        let look = |(index, (viewpoint, expected)): (usize, &(Viewpoint, Vec<EdgeId>))| {
            let (viewpoint, mut found) = (*viewpoint, Vec::new());
            if index.is_multiple_of(ALL_WINGS_EVERY) {
                extract_all_wings(patches, viewpoint, &mut found);
                check("brute-force over patches", viewpoint, expected, &sorted(&found))?;
            }
            let statistics = extract_patches(patches, viewpoint, &mut found);
            check("patches", viewpoint, expected, &sorted(&found))?;
            for (name, extractor) in &extractors {
                compare_kernels(name, extractor, viewpoint, (&ends, &found, statistics))?;
            }
            Ok(Agreement {
                viewpoints: 1,
                contour_edges: expected.len(),
                bounds_tested: statistics.super_patches_tested + statistics.patches_tested,
                edges_tested: statistics.edges_tested,
            })
        };
        let views = self.views.par_iter().enumerate().map(look);
        views.try_reduce(Agreement::default, |a, b| Ok(a + b))
    }
}

/// Kernels find the same edges as patches tested one by one, in the same order, after as many tests.
fn compare_kernels(
    name: &'static str,
    extractor: &Extractor<'_>,
    viewpoint: Viewpoint,
    (ends, expected, statistics): (&[[u32; 2]], &[EdgeId], Statistics),
) -> Result<(), Box<Disagreement>> {
    let (mut edges, mut pairs) = (Contours::default(), Contours::default());
    assert_eq!(extractor.edges(viewpoint, &mut edges), statistics, "{name} from {viewpoint:?}");
    check(name, viewpoint, &sorted(expected), &sorted(&edges))?;
    assert!(expected == &*edges, "order of {name} from {viewpoint:?}");
    extractor.vertex_pairs(viewpoint, &mut pairs);
    let ends = expected.iter().map(|edge| &ends[edge.index()]);
    assert!(pairs.iter().eq(ends), "vertex pairs of {name} from {viewpoint:?}");
    extractor.all_edges(viewpoint, &mut edges);
    check(name, viewpoint, &sorted(expected), &sorted(&edges))
}

/// Looks at `mesh` from every viewpoint with every extractor.
///
/// # Errors
/// Where one disagrees with [`contour_edges`].
pub fn compare(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    patches: &PatchSet,
    viewpoints: &[Viewpoint],
) -> Result<Agreement, Box<Disagreement>> {
    Expected::new(mesh, adjacency, patches.edge_filter(), viewpoints)?.compare(patches)
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
