//! Vertices at equal positions are one vertex.

use std::hash::{BuildHasher, Hash, Hasher};
use std::sync::atomic::{AtomicU32, Ordering};

use foldhash::fast::RandomState;
use foldhash::{HashMap, HashMapExt};
use glam::Vec3;
use rayon::prelude::*;

/// Maps that vertices are shared out to. Each of a million vertices fits a processor's cache, and is four
/// times as fast for it as one of all.
const SHARDS: usize = 64;

/// Vertices that a thread shares out at once. Fewer in all are not worth sharing out.
const SHARE: usize = 1 << 14;

/// A position as a key: the bits of its coordinates, of which 0 has one set. Hashed as two numbers, which
/// takes half the time of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place([u32; 3]);

impl Place {
    pub(crate) fn of(position: Vec3) -> Self {
        // Adding 0 turns −0 into 0.
        Self((position + Vec3::ZERO).to_array().map(f32::to_bits))
    }
}

impl Hash for Place {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let [x, y, z] = self.0;
        state.write_u64(u64::from(x) << 32 | u64::from(y));
        state.write_u32(z);
    }
}

/// For each vertex the lowest index of a vertex at the same position. Linear, on all threads.
///
/// OBJ and glTF files split vertices where texture coordinates or normals jump, and STL files at
/// every triangle; the surface does not end there. Positions are compared exactly, and −0 equals 0.
/// Hashes differ from run to run, so that whoever makes a file cannot know which positions share one.
pub fn weld_by_position(positions: &[Vec3]) -> Vec<u32> {
    in_shares(positions, SHARE)
}

fn in_shares(positions: &[Vec3], share: usize) -> Vec<u32> {
    if positions.len() <= share {
        let mut first_at = HashMap::with_capacity(positions.len());
        let weld = |(index, &position)| *first_at.entry(Place::of(position)).or_insert(index);
        return (0..).zip(positions).map(weld).collect();
    }
    let hasher = RandomState::default();
    let starts = (0..positions.len()).into_par_iter().step_by(share);
    let shared_out: Vec<Vec<Vec<u32>>> = starts
        .map(|start| {
            let mut lists = vec![Vec::new(); SHARDS];
            let end = positions.len().min(start + share);
            for (index, &position) in (start..end).zip(&positions[start..end]) {
                let hash = hasher.hash_one(Place::of(position)).to_le_bytes();
                let index = u32::try_from(index).unwrap_or(u32::MAX);
                lists[usize::from(hash[4]) % SHARDS].push(index);
            }
            lists
        })
        .collect();
    let welded: Vec<AtomicU32> = positions.par_iter().map(|_| AtomicU32::new(0)).collect();
    (0..SHARDS).into_par_iter().for_each(|shard| {
        let mut first_at = HashMap::new();
        // In order, so that the first is the lowest.
        for &index in shared_out.iter().flat_map(|lists| &lists[shard]) {
            let place = Place::of(positions[index as usize]);
            let first = *first_at.entry(place).or_insert(index);
            welded[index as usize].store(first, Ordering::Relaxed);
        }
    });
    welded.into_par_iter().map(AtomicU32::into_inner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_index_stands_for_all() {
        let at = |x: f32| Vec3::new(x, 1.0, 0.0);
        assert_eq!(
            weld_by_position(&[at(0.0), at(2.0), at(-0.0), at(2.0), at(3.0)]),
            [0, 1, 0, 1, 4]
        );
        assert!(weld_by_position(&[]).is_empty());
    }

    #[test]
    fn shares_of_any_size_weld_the_same() {
        let mut random = 7u32;
        let positions: Vec<Vec3> = (0..5000)
            .map(|_| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let [_, _, a, b] = random.to_le_bytes();
                Vec3::new(f32::from(a % 16), -f32::from(b % 8), 0.0)
            })
            .collect();
        let whole = in_shares(&positions, positions.len());
        assert!(whole.iter().zip(0..).any(|(&first, index)| first < index));
        for share in [1, 7, 1000, 4999] {
            assert_eq!(in_shares(&positions, share), whole, "{share}");
        }
    }

    /// These share a hash in rustc-hash 2.1, whose seed is the same in every run: with it, minutes go by.
    #[test]
    fn positions_made_to_share_a_hash_are_welded_like_any() {
        let [x, y] = [0x85a3_08d3, 0x243f_6a88].map(f32::from_bits);
        let positions: Vec<Vec3> = (0..400_000u32).map(|z| Vec3::new(x, y, z as f32)).collect();
        let expected: Vec<u32> = (0..400_000).collect();
        assert_eq!(weld_by_position(&positions), expected);
        assert_eq!(in_shares(&positions, positions.len()), expected);
    }
}
