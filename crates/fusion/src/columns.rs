//! Lists of tuples by columns, so that loops over them vectorise.

use crate::lanes::{LANES, Lanes, Number};

/// A list of `N`-tuples in blocks of [`LANES`], each component in a row of its own. The last block
/// is filled up with copies of the last tuple, so that a minimum or maximum over whole blocks is one
/// over the list.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const N: usize> {
    blocks: Vec<[Lanes; N]>,
    len: usize,
}

impl<const N: usize> Columns<N> {
    pub(crate) fn push(&mut self, tuple: [f64; N]) {
        let lane = self.len % LANES;
        if lane == 0 {
            self.blocks.push([Lanes::of(0.0); N]);
        }
        let last = self.blocks.len() - 1;
        for (row, x) in self.blocks[last].iter_mut().zip(tuple) {
            row.0[lane..].fill(x);
        }
        self.len += 1;
    }

    pub(crate) fn get(&self, index: usize) -> [f64; N] {
        self.blocks[index / LANES].map(|row| row.0[index % LANES])
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = [f64; N]> + '_ {
        (0..self.len).map(|i| self.get(i))
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// The smallest value of `f` over the list, and ∞ over an empty one. NaN is passed over.
    #[inline(always)]
    pub(crate) fn min_of(&self, f: impl Fn([Lanes; N]) -> Lanes) -> f64 {
        let mut least = Lanes::of(f64::INFINITY);
        for &block in &self.blocks {
            least = f(block).smaller(least);
        }
        least.0.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The largest value of `f` over the list, and −∞ over an empty one. NaN is passed over.
    #[inline(always)]
    pub(crate) fn max_of(&self, f: impl Fn([Lanes; N]) -> Lanes) -> f64 {
        -self.min_of(|tuple| Lanes::of(0.0) - f(tuple))
    }
}

impl<const N: usize> FromIterator<[f64; N]> for Columns<N> {
    fn from_iter<I: IntoIterator<Item = [f64; N]>>(tuples: I) -> Self {
        let tuples = tuples.into_iter();
        let blocks = Vec::with_capacity(tuples.size_hint().0.div_ceil(LANES));
        let mut columns = Self { blocks, len: 0 };
        tuples.for_each(|tuple| columns.push(tuple));
        columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padding_is_never_seen() {
        for count in 0..10 {
            let tuple = |i: u32| [f64::from(i) + 1.0, 7.0];
            let columns: Columns<2> = (0..count).map(tuple).collect();
            assert_eq!(columns.len(), count as usize);
            assert!(columns.iter().eq((0..count).map(tuple)));
            let least = if count == 0 { f64::INFINITY } else { 1.0 };
            assert_eq!(columns.min_of(|[x, _]| x), least);
            let most = if count == 0 { f64::NEG_INFINITY } else { f64::from(count) };
            assert_eq!(columns.max_of(|[x, _]| x), most);
        }
    }
}
