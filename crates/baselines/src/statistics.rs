//! Counts that baselines report.

/// What an extraction did, in counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Nodes of a hierarchy, or meshlets, whose bound was tested.
    pub nodes_tested: usize,
    /// Edges tested one by one.
    pub edges_tested: usize,
    /// Wings found to be contour edges. A non-manifold edge counts once for each of its wings.
    pub contour_edges: usize,
}

impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.nodes_tested += other.nodes_tested;
        self.edges_tested += other.edges_tested;
        self.contour_edges += other.contour_edges;
    }
}
