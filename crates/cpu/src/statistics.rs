//! Counts that extractors report.

/// What an extraction did, in counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Super-patches whose bound was tested; 0 if there is no second level.
    pub super_patches_tested: usize,
    /// Super-patches that may hold a contour edge, so that their patches were tested.
    pub super_patches_accepted: usize,
    /// Patches whose bound was tested: not those of culled super-patches. 0 for brute force.
    pub patches_tested: usize,
    /// Survivors: patches that may hold a contour edge.
    pub patches_accepted: usize,
    /// Edges tested one by one: those of the survivors and those that are always tested.
    pub edges_tested: usize,
    /// Wings found to be contour edges. A non-manifold edge counts once for each of its wings.
    pub contour_edges: usize,
}

impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.super_patches_tested += other.super_patches_tested;
        self.super_patches_accepted += other.super_patches_accepted;
        self.patches_tested += other.patches_tested;
        self.patches_accepted += other.patches_accepted;
        self.edges_tested += other.edges_tested;
        self.contour_edges += other.contour_edges;
    }
}
