//! The loops that take most of the time, for the widest registers that the processor has.

use super::model::Model;

/// Numbers that are known of each cluster, see [`Outline`](super::outlines::Outline).
pub(crate) const FIELDS: usize = 10;

/// Clusters in a block: as many as the widest registers hold.
pub(crate) const LANES: usize = 8;

/// Fields of some clusters, side by side.
pub(crate) type Block = [[f32; LANES]; FIELDS];

/// Writes to `gains` what fusing `one` with each of the clusters in `blocks` would gain, roughly: as
/// if caps were filled to their rims.
///
/// The same on every processor: the widest registers do the same operations in the same order, on
/// more clusters at once.
pub(crate) fn gains(
    blocks: &[Block],
    one: &[f32; FIELDS],
    model: &Model,
    gains: &mut [[f32; LANES]],
) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        #[expect(unsafe_code, reason = "to use instructions that not every processor has")]
        // SAFETY: this processor has AVX2.
        return unsafe { gains_avx2(blocks, one, model, gains) };
    }
    gains_anywhere(blocks, one, model, gains);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn gains_avx2(blocks: &[Block], one: &[f32; FIELDS], model: &Model, gains: &mut [[f32; LANES]]) {
    gains_anywhere(blocks, one, model, gains);
}

#[inline(always)]
fn gains_anywhere(
    blocks: &[Block],
    one: &[f32; FIELDS],
    model: &Model,
    gains: &mut [[f32; LANES]],
) {
    let max = |a: f32, b: f32| if a > b { a } else { b };
    let [nx, ny, nz, px, py, pz, half_angle, apex_angle, count, cost] = *one;
    for (block, gains) in blocks.iter().zip(gains) {
        let [ax, ay, az, cx, cy, cz, half_angles, apex_angles, edges, costs] = block;
        for i in 0..LANES {
            let (dx, dy, dz) = (ax[i] - nx, ay[i] - ny, az[i] - nz);
            let between = (dx * dx + dy * dy + dz * dz).sqrt();
            let filled = 0.5 * (half_angles[i] + half_angle + between);
            let angle = max(max(half_angles[i], half_angle), filled);
            // How high one center lies above the other, along the axis half-way between.
            let height = (ax[i] + nx) * (cx[i] - px)
                + (ay[i] + ny) * (cy[i] - py)
                + (az[i] + nz) * (cz[i] - pz);
            let height = (0.5 * height).abs() * model.nearness;
            let spread = 0.5 * (apex_angles[i] + apex_angle + height);
            let apex = max(max(apex_angles[i], apex_angle), spread);
            gains[i] = costs[i] + cost - model.rough_patch(angle + apex, edges[i] + count);
        }
    }
}

/// The first of the largest numbers, and how large it is; `None` if all are negative infinity.
pub(crate) fn most(numbers: &[[f32; LANES]]) -> Option<(usize, f32)> {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        #[expect(unsafe_code, reason = "to use instructions that not every processor has")]
        // SAFETY: this processor has AVX2.
        return unsafe { most_avx2(numbers) };
    }
    most_anywhere(numbers)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn most_avx2(numbers: &[[f32; LANES]]) -> Option<(usize, f32)> {
    most_anywhere(numbers)
}

#[inline(always)]
fn most_anywhere(numbers: &[[f32; LANES]]) -> Option<(usize, f32)> {
    let mut largest = [f32::NEG_INFINITY; LANES];
    for block in numbers {
        for (largest, &number) in largest.iter_mut().zip(block) {
            *largest = if number > *largest { number } else { *largest };
        }
    }
    // In pairs, which is three steps for eight, and not `max`, which heeds NaN.
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            let other = largest[lane + half];
            largest[lane] = if other > largest[lane] { other } else { largest[lane] };
        }
        half /= 2;
    }
    let most = largest[0];
    if most == f32::NEG_INFINITY {
        return None;
    }
    // Lanes that hold it, as bits: one look at all of them.
    let holders = |block: &[f32; LANES]| {
        (0..LANES).fold(0u32, |bits, lane| bits | u32::from(block[lane] == most) << lane)
    };
    let found = |(number, block)| {
        let holders = holders(block);
        (holders != 0).then(|| LANES * number + holders.trailing_zeros() as usize)
    };
    Some((numbers.iter().enumerate().find_map(found)?, most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CostModel, ViewProfile};

    /// Fails where the widest registers compute anything else.
    #[test]
    fn every_processor_finds_the_same() {
        let mut rng = 1u32;
        let mut number = || {
            rng = rng.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f32::from_bits(0x3f80_0000 | (rng >> 9)) - 1.0
        };
        for cost in [CostModel::PAPER, CostModel::MESH_SHADER] {
            let model = Model::new(cost, &ViewProfile::FAR);
            for len in [0, 1, 5] {
                let block = |_| std::array::from_fn(|_| std::array::from_fn(|_| number()));
                let blocks: Vec<Block> = (0..len).map(block).collect();
                let one = std::array::from_fn(|_| number());
                let (mut widest, mut anywhere) = (vec![[0.0; LANES]; len], vec![[1.0; LANES]; len]);
                gains(&blocks, &one, &model, &mut widest);
                gains_anywhere(&blocks, &one, &model, &mut anywhere);
                let bits = |gains: &[[f32; LANES]]| -> Vec<u32> {
                    gains.as_flattened().iter().map(|gain| gain.to_bits()).collect()
                };
                assert_eq!(bits(&widest), bits(&anywhere));
                assert_eq!(most(&widest), most_anywhere(&widest));
            }
        }
    }
}
