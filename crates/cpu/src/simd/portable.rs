//! With 128-bit instructions that the compiler may always use: SSE2 or NEON.

use wide::{CmpGt, CmpLt, f32x4, i16x8, i32x4};

use super::{COUNTED, Lanes, bits};
use crate::faces::{LANES, Pairs};

/// Four times four.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

/// So many labels are written in any case, as few blocks have more: a branch on how many there are would
/// be guessed wrong too often.
const MOST_CONTOURS: usize = 3;

impl Portable {
    #[inline(always)]
    fn compact<T: Copy>(from: &[T; LANES], mut mask: u16, to: &mut [T; LANES]) {
        let mut push = |place: &mut T| {
            *place = from[mask.trailing_zeros() as usize % LANES];
            mask &= mask.wrapping_sub(1);
            mask
        };
        let (first, more) = to.split_at_mut(MOST_CONTOURS);
        let mut left = 0;
        for place in first {
            left = push(place);
        }
        if left != 0 {
            for place in more {
                if push(place) == 0 {
                    break;
                }
            }
        }
    }
}

/// All bits of those that are [`Lanes::within`].
#[inline(always)]
fn are_within(a: [i32x4; 4], b: i32) -> [i32x4; 4] {
    let (above, below) = (i32x4::splat(-b - 1), i32x4::splat(b + 1));
    a.map(|a| a.cmp_gt(above) & a.cmp_lt(below))
}

impl Lanes for Portable {
    type Reals = [f32x4; 4];
    type Wholes = [i32x4; 4];

    #[inline(always)]
    fn reals(self, numbers: &[f32; LANES]) -> Self::Reals {
        bytemuck::cast(*numbers)
    }

    #[inline(always)]
    fn add(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
        [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
    }

    #[inline(always)]
    fn sub(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
    }

    #[inline(always)]
    fn mul(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
        [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
    }

    #[inline(always)]
    fn abs(self, a: Self::Reals) -> Self::Reals {
        a.map(f32x4::abs)
    }

    #[inline(always)]
    fn greater(self, a: Self::Reals, b: Self::Reals) -> u16 {
        let part = |i: usize| bits(a[i].cmp_gt(b[i]).move_mask());
        part(0) | part(1) << 4 | part(2) << 8 | part(3) << 12
    }

    #[inline(always)]
    fn dot(self, a: [&Pairs; 2], b: [[i16; 2]; 2]) -> Self::Wholes {
        let [first, second] = a.map(|pairs| bytemuck::cast::<Pairs, [i16x8; 4]>(*pairs));
        let [x, y] = b.map(|[x, y]| i16x8::from([x, y, x, y, x, y, x, y]));
        std::array::from_fn(|i| first[i].dot(x) + second[i].dot(y))
    }

    #[inline(always)]
    fn negative(self, a: Self::Wholes) -> u16 {
        let part = |i: usize| bits(a[i].move_mask());
        part(0) | part(1) << 4 | part(2) << 8 | part(3) << 12
    }

    #[inline(always)]
    fn within(self, a: Self::Wholes, b: i32) -> u16 {
        self.negative(are_within(a, b))
    }

    #[inline(always)]
    fn differ(self, [a, b]: [Self::Wholes; 2]) -> u16 {
        self.negative(std::array::from_fn(|i| a[i] ^ b[i]))
    }

    #[inline(always)]
    fn any_within(self, a: [Self::Wholes; 2], b: i32) -> u16 {
        let [first, second] = a.map(|a| are_within(a, b));
        self.negative(std::array::from_fn(|i| first[i] | second[i]))
    }

    #[inline(always)]
    fn compact_words(self, from: &[u32; LANES], mask: u16, to: &mut [u32; LANES]) {
        Self::compact(from, mask, to);
    }

    #[inline(always)]
    fn compact_pairs(self, from: &[[u32; 2]; LANES], mask: u16, to: &mut [[u32; 2]; LANES]) {
        Self::compact(from, mask, to);
    }

    #[inline(always)]
    fn counted_from(self, first: u32) -> [u32; LANES] {
        let mut numbers = COUNTED;
        for number in &mut numbers {
            *number += first;
        }
        numbers
    }
}
