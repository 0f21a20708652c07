//! Several f64 at once, so that comparing one cluster with many uses the whole of a register.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// Numbers in one [`Lanes`]: an AVX register, or two of SSE2, which every x86-64 has.
pub(crate) const LANES: usize = 4;

/// A real number, or one in each lane: formulas that are needed both ways are written once.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same in every lane.
    fn of(x: f64) -> Self;

    /// Square root; NaN below 0.
    fn sqrt(self) -> Self;

    /// In each lane `then` if `self` is less than `than`, and `otherwise` if not, or if either is
    /// NaN.
    fn if_less(self, than: Self, then: Self, otherwise: Self) -> Self;

    /// The smaller; the other if `self` is NaN.
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.if_less(other, self, other)
    }

    /// The larger; the other if `self` is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        other.if_less(self, self, other)
    }
}

impl Number for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn if_less(self, than: Self, then: Self, otherwise: Self) -> Self {
        if self < than { then } else { otherwise }
    }
}

/// One number in each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

impl Number for Lanes {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self([x; LANES])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn if_less(self, than: Self, then: Self, otherwise: Self) -> Self {
        Self(from_fn(|i| if self.0[i] < than.0[i] { then.0[i] } else { otherwise.0[i] }))
    }
}

macro_rules! lane_by_lane {
    ($($operator:ident $function:ident;)*) => {$(
        impl $operator for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i].$function(other.0[i])))
            }
        }
    )*};
}

lane_by_lane! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_do_as_numbers_do() {
        let values = [[2.0, -1.0, f64::NAN, 0.0], [4.0, -3.0, 1.0, f64::INFINITY]];
        let [a, b] = values.map(Lanes);
        let check = |lanes: Lanes, number: fn(f64, f64) -> f64| {
            let expected: [f64; LANES] = from_fn(|i| number(values[0][i], values[1][i]));
            assert_eq!(lanes.0.map(f64::to_bits), expected.map(f64::to_bits));
        };
        check(a + b, |a, b| a + b);
        check(a - b, |a, b| a - b);
        check(a * b, |a, b| a * b);
        check(a / b, |a, b| a / b);
        check(b.sqrt(), |_, b| b.sqrt());
        check(a.smaller(b), |a, b| a.smaller(b));
        check(a.larger(b), |a, b| a.larger(b));
        check(Lanes::of(3.0), |_, _| 3.0);
        assert_eq!((2.0.smaller(1.0), 2.0.larger(1.0)), (1.0, 2.0));
        assert_eq!((f64::NAN.smaller(1.0), f64::NAN.larger(1.0)), (1.0, 1.0));
    }
}
