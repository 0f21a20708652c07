//! Vectors in whole numbers, of a length that rounds well.
//!
//! Of a plane's four numbers only the direction counts, and of a viewpoint's. Of the multiples that make
//! the largest whole, one in 64 brings each of the others within ⅛ of a whole number, if these lie anyhow:
//! rounding then loses a quarter of what it may, for a length that is hardly less.

use crate::simd::{Kernel, Lanes, Level};

/// S, the greatest length.
pub(crate) const SCALE: f64 = 32_767.0;

/// Multiples that are compared at a time: a power of two.
const TRIES: u32 = 128;

/// A multiple of a vector, and the whole numbers next to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Whole {
    pub(crate) numbers: [i16; 4],
    /// What the vector was multiplied by; at most S.
    pub(crate) scale: f64,
}

impl Whole {
    /// Of [`TRIES`] multiples, the longest but for a hundredth, one that loses little. No component is
    /// beyond −1 or 1, and one at least ½ away from 0.
    pub(crate) fn new(level: Level, vector: [f64; 4]) -> Self {
        Self::up_to(level, vector, most(vector))
    }

    /// The same, but for as much shorter ones as it takes to lose no more than `loss` in any component;
    /// `None` if none does.
    pub(crate) fn within(level: Level, vector: [f64; 4], loss: f64) -> Option<Self> {
        let most = most(vector);
        let starts = (TRIES..=most).rev().step_by(TRIES as usize);
        starts
            .map(|most| Self::up_to(level, vector, most))
            .find(|whole| whole.losses(vector).into_iter().all(|lost| lost.abs() <= loss))
    }

    /// What rounding has added to each component.
    pub(crate) fn losses(&self, vector: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|i| f64::from(self.numbers[i]) - self.scale * vector[i])
    }

    /// Where the largest component is `most`, or a little less.
    #[expect(clippy::cast_possible_truncation, reason = "at most S")]
    fn up_to(level: Level, vector: [f64; 4], most: u32) -> Self {
        let largest = largest(vector);
        let turns = vector.map(|x| turn(x / largest));
        let scale = f64::from(most - level.run(LeastLoss { turns, most })) / largest;
        Self { numbers: vector.map(|x| (scale * x).round() as i16), scale }
    }
}

fn largest(vector: [f64; 4]) -> f64 {
    vector.into_iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The largest component of the longest multiple.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to S")]
fn most(vector: [f64; 4]) -> u32 {
    (SCALE * largest(vector)) as u32
}

/// `x` without its whole part, in units of 2⁻³².
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "that is what is left")]
fn turn(x: f64) -> u32 {
    (x * 4_294_967_296.0).round() as i64 as u32
}

/// Of `most`, `most` − 1, ... the number whose products with `turns` are nearest to whole, by the farthest
/// of them: gives what is taken from `most`.
struct LeastLoss {
    turns: [u32; 4],
    most: u32,
}

impl Kernel for LeastLoss {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> u32 {
        let Self { turns, most } = self;
        // One long loop for each component: they are what compilers make the best of.
        let mut losses = [0; TRIES as usize];
        for turn in turns {
            for (loss, less) in losses.iter_mut().zip(0..) {
                let rest = turn.wrapping_mul(most.wrapping_sub(less)).cast_signed();
                *loss = u32::max(*loss, (rest ^ rest >> 31).cast_unsigned());
            }
        }
        // The number of a multiple takes the place of the last digits of what it loses.
        let mut least = u32::MAX;
        for (loss, less) in losses.into_iter().zip(0..) {
            least = least.min(loss & !(TRIES - 1) | less);
        }
        least % TRIES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Instructions;

    fn most_lost(whole: Whole, vector: [f64; 4]) -> f64 {
        whole.losses(vector).into_iter().map(f64::abs).fold(0.0, f64::max)
    }

    #[test]
    fn every_instruction_set_finds_the_same() {
        let mut lost = 0.0;
        for number in 0..500 {
            let part = |factor: f64| (factor * f64::from(number)).sin();
            let vector = [part(0.7), part(1.9), part(3.1), part(5.3).signum()];
            let levels = || Instructions::ALL.into_iter().filter_map(Instructions::level);
            let mut found = levels().map(|level| Whole::new(level, vector));
            let first = found.next().unwrap();
            assert!(found.all(|whole| whole == first));
            assert!(first.scale <= SCALE && first.scale > 0.99 * SCALE);
            lost += most_lost(first, vector) / 500.0;
            let mut found = levels().map(|level| Whole::within(level, vector, 0.05));
            let first = found.next().unwrap().unwrap();
            assert!(found.all(|whole| whole == Some(first)));
            assert!(most_lost(first, vector) <= 0.05);
        }
        // Rounding alone loses 0.4 on average.
        assert!(lost < 0.11, "{lost}");
    }

    #[test]
    fn what_does_not_round_well_gets_shorter() {
        let vector = [1.0, 0.4 / SCALE, 0.0, 0.0];
        assert!(most_lost(Whole::new(Level::Portable, vector), vector) > 0.3);
        let shorter = Whole::within(Level::Portable, vector, 0.1).unwrap();
        assert!(shorter.scale > 0.2 * SCALE && shorter.scale < 0.26 * SCALE, "{shorter:?}");
        assert!(Whole::within(Level::Portable, vector, 0.004).unwrap().scale < 0.01 * SCALE);
        assert_eq!(Whole::within(Level::Portable, [1.0, 0.5f64.sqrt(), 0.6, 0.3], 1e-9), None);
    }
}
