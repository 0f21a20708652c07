//! What was counted.

use crate::Totals;

/// What one extraction found and tested, all instances together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Contour edges found, whether they fit the output or not.
    pub segments: u64,
    /// Segments that fit the output.
    pub capacity: u32,
    /// Edges tested.
    pub edges_tested: u64,
    /// Patches tested.
    pub patches_tested: u64,
    /// Patches that were not culled.
    pub patches_accepted: u64,
    /// Super-patches tested.
    pub super_patches_tested: u64,
    /// Super-patches that were not culled.
    pub super_patches_accepted: u64,
}

impl Statistics {
    /// What a compute pipeline has added up, with that much room for segments.
    pub fn new(totals: &Totals, capacity: u32) -> Self {
        let number = |[low, high]: [u32; 2]| u64::from(low) | u64::from(high) << 32;
        Self {
            segments: number(totals.segments),
            capacity,
            edges_tested: number(totals.edges_tested),
            patches_tested: number(totals.patches_tested),
            patches_accepted: number(totals.patches_accepted),
            super_patches_tested: number(totals.super_patches_tested),
            super_patches_accepted: number(totals.super_patches_accepted),
        }
    }

    /// The capacity that would have been needed, if that is more than there is: then segments are missing.
    pub fn overflow(&self) -> Option<u64> {
        (self.segments > u64::from(self.capacity)).then_some(self.segments)
    }
}
