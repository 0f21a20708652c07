//! Every extractor against the definition.

use std::fmt;

use drypoint_cpu::{
    Batch, BruteForce, Contours, Extractor, FaceSigns, FaceStrips, Instructions, Statistics,
    StoredPlanes, extract_all_wings, extract_patches,
};
use drypoint_fusion::PatchSet;
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges};
use rayon::prelude::*;

use crate::judges::{Judge, Tested};

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

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.viewpoint.is_point() { "eye" } else { "direction" };
        let xyz = self.viewpoint.xyz().to_array();
        let (lost, invented) = (self.lost.len(), self.invented.len());
        write!(
            f,
            "{} disagrees with the definition from {kind} {xyz:?}: {lost} edges lost, {invented} invented",
            self.extractor
        )
    }
}

/// What agreed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Viewpoints looked from.
    pub viewpoints: usize,
    /// Contour edges found, over all viewpoints.
    pub contour_edges: usize,
    /// Edges that were tested, over all viewpoints.
    pub edges_tested: usize,
}

impl std::ops::Add for Agreement {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            viewpoints: self.viewpoints + other.viewpoints,
            contour_edges: self.contour_edges + other.contour_edges,
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
        let exact = BruteForce::new(mesh, adjacency, filter);
        let laid_out = LaidOut::of_every_kind(mesh, adjacency, filter);
        let look = |(exact, laid_out): &mut (BruteForce<'_>, Vec<LaidOut<'_>>),
                    &viewpoint: &Viewpoint| {
            let (mut expected, mut found) = (Vec::new(), Vec::new());
            contour_edges(mesh, adjacency, viewpoint, filter, &mut expected);
            exact.extract(viewpoint, &mut found);
            check("brute-force", viewpoint, &expected, &found)?;
            laid_out.iter_mut().try_for_each(|each| each.compare(viewpoint, &expected))?;
            Ok((viewpoint, expected))
        };
        let views = viewpoints.par_iter().map_init(|| (exact.clone(), laid_out.clone()), look);
        Ok(Self { filter, views: views.collect::<Result<_, Box<Disagreement>>>()? })
    }

    /// The same by the definition alone.
    pub fn by_definition(
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
        viewpoints: &[Viewpoint],
    ) -> Self {
        let look = |&viewpoint: &Viewpoint| {
            let mut expected = Vec::new();
            contour_edges(mesh, adjacency, viewpoint, filter, &mut expected);
            (viewpoint, expected)
        };
        Self { filter, views: viewpoints.par_iter().map(look).collect() }
    }

    /// Whether `patches`, made of the same mesh with the same filter, give the same from
    /// everywhere. On all threads.
    ///
    /// # Errors
    /// Where they do not.
    pub fn compare(&self, patches: &PatchSet) -> Result<Agreement, Box<Disagreement>> {
        assert_eq!(patches.edge_filter(), self.filter, "made with another filter");
        let extractors: Vec<(&str, Extractor<'_>)> = [
            ("portable kernels", Instructions::Portable),
            ("AVX2 kernels", Instructions::Avx2),
            ("AVX-512 kernels", Instructions::Avx512),
        ]
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
            compare_kernels(&extractors, viewpoint, &ends, (expected, statistics))?;
            Ok(Agreement {
                viewpoints: 1,
                contour_edges: expected.len(),
                edges_tested: statistics.edges_tested,
            })
        };
        let views = self.views.par_iter().enumerate().map(look);
        let agreement: Result<_, Box<Disagreement>> =
            views.try_reduce(Agreement::default, |a, b| Ok(a + b));
        let agreement = agreement?;
        for (name, extractor) in &extractors {
            self.compare_batch(name, extractor)?;
        }
        Ok(agreement)
    }

    /// What each view takes through the bounds of `judge`, which must find the same. On all threads.
    ///
    /// # Errors
    /// Where it does not.
    pub fn watch(
        &self,
        name: &'static str,
        judge: &dyn Judge,
    ) -> Result<Vec<Tested>, Box<Disagreement>> {
        let look = |found: &mut Vec<EdgeId>, (viewpoint, expected): &(Viewpoint, Vec<EdgeId>)| {
            let tested = judge.extract(*viewpoint, found);
            found.sort_unstable();
            check(name, *viewpoint, expected, found).map(|()| tested)
        };
        self.views.par_iter().map_init(Vec::new, look).collect()
    }

    /// The same, summed up.
    ///
    /// # Errors
    /// Where it does not find the same.
    pub fn agreement(
        &self,
        name: &'static str,
        judge: &dyn Judge,
    ) -> Result<Agreement, Box<Disagreement>> {
        let tested = self.watch(name, judge)?;
        Ok(Agreement {
            viewpoints: tested.len(),
            contour_edges: self.counts().sum(),
            edges_tested: tested.iter().map(|view| view.edges).sum(),
        })
    }

    /// How many contour edges there are from each viewpoint.
    pub fn counts(&self) -> impl Iterator<Item = usize> + '_ {
        self.views.iter().map(|(_, edges)| edges.len())
    }

    /// A batch gives what its views give one by one, and so do all threads on one view.
    fn compare_batch(
        &self,
        name: &'static str,
        extractor: &Extractor<'_>,
    ) -> Result<(), Box<Disagreement>> {
        let viewpoints: Vec<Viewpoint> =
            self.views.iter().map(|(viewpoint, _)| *viewpoint).collect();
        let (mut edges, mut pairs) = (Batch::default(), Batch::default());
        extractor.edges_of_batch(&viewpoints, &mut edges);
        extractor.vertex_pairs_of_batch(&viewpoints, &mut pairs);
        assert_eq!((edges.len(), pairs.len()), (self.views.len(), self.views.len()));
        let (mut one, mut one_pairs) = (Contours::default(), Contours::default());
        for (index, (viewpoint, expected)) in self.views.iter().enumerate() {
            let viewpoint = *viewpoint;
            let (found, statistics) = edges.view(index);
            check(name, viewpoint, expected, &sorted(found))?;
            assert_eq!(statistics, extractor.edges(viewpoint, &mut one), "{name}: {viewpoint:?}");
            assert!(found == &*one, "order of {name} in a batch from {viewpoint:?}");
            assert_eq!(extractor.edges_on_threads(viewpoint, &mut one), statistics);
            assert!(found == &*one, "order of {name} on threads from {viewpoint:?}");
            assert_eq!(extractor.vertex_pairs_on_threads(viewpoint, &mut one_pairs), statistics);
            assert!(pairs.view(index) == (&*one_pairs, statistics), "{name} from {viewpoint:?}");
        }
        Ok(())
    }
}

/// The brute forces with planes in whole numbers, for one instruction set.
#[derive(Clone)]
struct LaidOut<'mesh> {
    stored: StoredPlanes<'mesh>,
    signs: FaceSigns<'mesh>,
    strips: FaceStrips<'mesh>,
    contours: Contours<EdgeId>,
}

impl<'mesh> LaidOut<'mesh> {
    /// For each instruction set of this processor.
    fn of_every_kind(
        mesh: &'mesh Mesh,
        adjacency: &MeshAdjacency,
        filter: EdgeFilter,
    ) -> Vec<Self> {
        let stored = StoredPlanes::new(mesh, adjacency, filter);
        let signs = FaceSigns::new(mesh, adjacency, filter);
        let strips = FaceStrips::new(mesh, adjacency, filter);
        let with = |set| {
            Some(Self {
                stored: stored.clone().with_instructions(set)?,
                signs: signs.clone().with_instructions(set)?,
                strips: strips.clone().with_instructions(set)?,
                contours: Contours::default(),
            })
        };
        Instructions::ALL.into_iter().filter_map(with).collect()
    }

    fn compare(
        &mut self,
        viewpoint: Viewpoint,
        expected: &[EdgeId],
    ) -> Result<(), Box<Disagreement>> {
        let Self { stored, signs, strips, contours } = self;
        stored.extract(viewpoint, contours);
        check("stored planes", viewpoint, expected, contours)?;
        signs.extract(viewpoint, contours);
        check("face signs", viewpoint, expected, contours)?;
        strips.extract(viewpoint, contours);
        check("face strips", viewpoint, expected, &sorted(contours))
    }
}

/// Kernels find the same edges, after as many tests as patches tested one by one, and all of them in
/// the same order.
fn compare_kernels(
    extractors: &[(&'static str, Extractor<'_>)],
    viewpoint: Viewpoint,
    ends: &[[u32; 2]],
    (expected, statistics): (&[EdgeId], Statistics),
) -> Result<(), Box<Disagreement>> {
    let (mut edges, mut pairs) = (Contours::default(), Contours::default());
    let mut first: Option<Vec<EdgeId>> = None;
    for (name, extractor) in extractors {
        assert_eq!(extractor.edges(viewpoint, &mut edges), statistics, "{name} from {viewpoint:?}");
        check(name, viewpoint, expected, &sorted(&edges))?;
        let first = first.get_or_insert_with(|| edges.to_vec());
        assert!(*first == *edges, "order of {name} from {viewpoint:?}");
        extractor.vertex_pairs(viewpoint, &mut pairs);
        let ends = edges.iter().map(|edge| &ends[edge.index()]);
        assert!(pairs.iter().eq(ends), "vertex pairs of {name} from {viewpoint:?}");
        extractor.all_edges(viewpoint, &mut edges);
        check(name, viewpoint, expected, &sorted(&edges))?;
    }
    Ok(())
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
