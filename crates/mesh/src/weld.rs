//! Vertices at equal positions are one vertex.

use glam::Vec3;
use rustc_hash::FxHashMap;

/// For each vertex the lowest index of a vertex at the same position. Linear.
///
/// OBJ and glTF files split vertices where texture coordinates or normals jump, and STL files at
/// every triangle; the surface does not end there. Positions are compared exactly, and −0 equals 0.
pub fn weld_by_position(positions: &[Vec3]) -> Vec<u32> {
    let mut first_at: FxHashMap<[u32; 3], u32> =
        FxHashMap::with_capacity_and_hasher(positions.len(), Default::default());
    let weld = |(index, position): (u32, &Vec3)| {
        // Adding 0 turns −0 into 0.
        let key = position.to_array().map(|x| (x + 0.0).to_bits());
        *first_at.entry(key).or_insert(index)
    };
    (0..).zip(positions).map(weld).collect()
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
}
