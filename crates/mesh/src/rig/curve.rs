//! Values over time: Khronos Group, glTF 2.0 Specification, 2.0.1, 2021, §3.11 and Appendix C.

use glam::{DQuat, DVec4};

/// How a [`Curve`] runs from one key to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// It stays at the value of the key before.
    Step,
    /// Straight; rotations along the shorter arc of the sphere.
    Linear,
    /// A cubic Hermite spline. Each key has an in-tangent, a value and an out-tangent.
    CubicSpline,
}

impl Interpolation {
    /// Values a key: 1, or 3 for a spline.
    pub const fn values_per_key(self) -> usize {
        match self {
            Self::Step | Self::Linear => 1,
            Self::CubicSpline => 3,
        }
    }
}

/// Values at keys, and between them. Before the first key and after the last it stays.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    times: Vec<f64>,
    values: Vec<f64>,
    width: usize,
    interpolation: Interpolation,
}

/// Why times and values make no [`Curve`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CurveError {
    /// There is no key.
    #[error("has no keys")]
    NoKeys,
    /// Times must be finite and must not run backwards.
    #[error("has a key {key} that is before the one before it, or at no finite time")]
    Order {
        /// The key, from 0.
        key: usize,
    },
    /// Not as many numbers as the keys need.
    #[error("has {found} numbers where its keys need {needed}")]
    Count {
        /// How many there are.
        found: usize,
        /// How many there should be.
        needed: usize,
    },
    /// A value that is NaN or infinite.
    #[error("has a number {index} that is not finite")]
    NotFinite {
        /// Its place among the numbers, from 0.
        index: usize,
    },
}

impl Curve {
    /// A curve of `width` numbers a value through keys at `times`, in seconds. `values` are laid out key by
    /// key, in a spline in-tangent, value and out-tangent of each. Linear.
    ///
    /// # Errors
    /// No keys, times that run backwards, numbers that are not finite, or not as many as the keys need.
    pub fn new(
        times: Vec<f64>,
        values: Vec<f64>,
        width: usize,
        interpolation: Interpolation,
    ) -> Result<Self, CurveError> {
        if times.is_empty() {
            return Err(CurveError::NoKeys);
        }
        let before = std::iter::once(&f64::NEG_INFINITY).chain(&times);
        let is_disordered = |(time, before): (&f64, &f64)| !time.is_finite() || time < before;
        if let Some(key) = times.iter().zip(before).position(is_disordered) {
            return Err(CurveError::Order { key });
        }
        let (found, needed) = (values.len(), times.len() * interpolation.values_per_key() * width);
        if found != needed {
            return Err(CurveError::Count { found, needed });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(CurveError::NotFinite { index });
        }
        Ok(Self { times, values, width, interpolation })
    }

    /// Numbers a value.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Time of the last key, in seconds.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Writes the value at a time, in seconds, to `value`: of its [`Curve::width`] numbers as many as fit.
    /// Logarithmic in keys. A time that is NaN counts as before the first.
    pub fn sample(&self, seconds: f64, value: &mut [f64]) {
        let (key, fraction, span) = self.locate(seconds);
        let [before, after] = [self.value(key), self.value(key + usize::from(fraction > 0.0))];
        match self.interpolation {
            Interpolation::Step => value.iter_mut().zip(before).for_each(|(v, &a)| *v = a),
            Interpolation::Linear => {
                let mix = |a: f64, b: f64| a + fraction * (b - a);
                let pairs = before.iter().zip(after);
                value.iter_mut().zip(pairs).for_each(|(v, (&a, &b))| *v = mix(a, b));
            }
            Interpolation::CubicSpline if fraction == 0.0 => {
                value.iter_mut().zip(before).for_each(|(v, &a)| *v = a);
            }
            Interpolation::CubicSpline => {
                // Appendix C.5: Hermite's basis, tangents scaled by the time between the keys.
                let (t, t2, t3) = (fraction, fraction * fraction, fraction.powi(3));
                let basis = [
                    2.0 * t3 - 3.0 * t2 + 1.0,
                    span * (t3 - 2.0 * t2 + t),
                    -2.0 * t3 + 3.0 * t2,
                    span * (t3 - t2),
                ];
                let (out, into) = (self.element(key, 2), self.element(key + 1, 0));
                for (i, v) in value.iter_mut().enumerate().take(self.width) {
                    let terms = [before[i], out[i], after[i], into[i]];
                    *v = terms.iter().zip(basis).map(|(x, b)| x * b).sum();
                }
            }
        }
    }

    /// The rotation at a time, for a curve of width 4 (x, y, z, w); of unit length. Between the keys of a
    /// linear one it turns evenly, the shorter way round.
    pub fn rotation(&self, seconds: f64) -> DQuat {
        let unit = |value: &[f64]| {
            let mut four = [0.0; 4];
            four.iter_mut().zip(value).for_each(|(slot, &x)| *slot = x);
            let quaternion = DVec4::from_array(four);
            DQuat::from_vec4(quaternion.normalize_or(DVec4::W))
        };
        if self.interpolation == Interpolation::Linear {
            let (key, fraction, _) = self.locate(seconds);
            let next = key + usize::from(fraction > 0.0);
            return unit(self.value(key)).slerp(unit(self.value(next)), fraction).normalize();
        }
        let mut value = [0.0; 4];
        self.sample(seconds, &mut value);
        unit(&value)
    }

    /// The key at or before a time, how much of the way to the next has passed, 0 .. 1, and how many seconds
    /// that way is.
    fn locate(&self, seconds: f64) -> (usize, f64, f64) {
        let after = self.times.partition_point(|&time| time <= seconds);
        let key = after.saturating_sub(1);
        match self.times.get(key + 1) {
            Some(&next) if after > 0 => {
                let span = next - self.times[key];
                (key, (seconds - self.times[key]) / span, span)
            }
            _ => (key, 0.0, 0.0),
        }
    }

    /// The value of a key.
    fn value(&self, key: usize) -> &[f64] {
        self.element(key, self.interpolation.values_per_key() / 2)
    }

    fn element(&self, key: usize, element: usize) -> &[f64] {
        let index = key * self.interpolation.values_per_key() + element;
        &self.values[index * self.width..][..self.width]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(interpolation: Interpolation, times: &[f64], values: &[f64]) -> Curve {
        let width = values.len() / times.len() / interpolation.values_per_key();
        Curve::new(times.to_vec(), values.to_vec(), width, interpolation).unwrap()
    }

    #[track_caller]
    fn check(curve: &Curve, expected: &[(f64, f64)]) {
        for &(seconds, expected) in expected {
            let mut value = [f64::NAN];
            curve.sample(seconds, &mut value);
            assert!((value[0] - expected).abs() < 1e-12, "at {seconds}: {}", value[0]);
        }
    }

    #[test]
    fn steps_stay_and_lines_run_between_keys() {
        let (times, values) = ([1.0, 2.0, 4.0], [10.0, 20.0, 0.0]);
        let outside = [(-1.0, 10.0), (1.0, 10.0), (4.0, 0.0), (9.0, 0.0), (f64::NAN, 10.0)];
        let step = curve(Interpolation::Step, &times, &values);
        check(&step, &[(1.999, 10.0), (2.0, 20.0), (3.9, 20.0)]);
        check(&step, &outside);
        let linear = curve(Interpolation::Linear, &times, &values);
        check(&linear, &[(1.5, 15.0), (2.0, 20.0), (3.0, 10.0), (3.5, 5.0)]);
        check(&linear, &outside);
        assert_eq!(linear.end(), 4.0);
    }

    #[test]
    fn a_spline_with_the_tangents_of_a_parabola_is_one() {
        // x = t², whose slope is 2 t, at t = 1, 2 and 4.
        let values = [2.0, 1.0, 2.0, 4.0, 4.0, 4.0, 8.0, 16.0, 8.0];
        let spline = curve(Interpolation::CubicSpline, &[1.0, 2.0, 4.0], &values);
        let parabola = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 3.75, 4.0].map(|t| (t, t * t));
        check(&spline, &parabola);
        check(&spline, &[(0.0, 1.0), (5.0, 16.0)]);
        check(
            &curve(Interpolation::CubicSpline, &[3.0], &[9.0, 5.0, 9.0]),
            &[(1.0, 5.0), (4.0, 5.0)],
        );
    }

    #[test]
    fn rotations_turn_evenly_the_shorter_way_round() {
        let [a, b] = [0.2, 1.0].map(DQuat::from_rotation_z);
        for sign in [1.0, -1.0] {
            let values = [a, b * sign].map(|q| q.to_array()).concat();
            let turn = curve(Interpolation::Linear, &[0.0, 2.0], &values);
            for (seconds, angle) in [(-1.0, 0.2), (0.0, 0.2), (0.5, 0.4), (1.5, 0.8), (3.0, 1.0)] {
                let found = turn.rotation(seconds);
                let expected = DQuat::from_rotation_z(angle);
                assert!(found.dot(expected).abs() > 1.0 - 1e-14, "at {seconds}: {found}");
            }
        }
        let nothing = curve(Interpolation::Step, &[0.0], &[0.0; 4]);
        assert_eq!(nothing.rotation(0.0), DQuat::IDENTITY);
    }

    #[test]
    fn keys_at_one_time_jump() {
        let jump = curve(Interpolation::Linear, &[0.0, 1.0, 1.0, 2.0], &[0.0, 1.0, 5.0, 6.0]);
        check(&jump, &[(0.999_999, 0.999_999), (1.0, 5.0), (1.5, 5.5)]);
    }

    #[test]
    fn nonsense_is_refused() {
        let new = |times: &[f64], values: &[f64]| {
            Curve::new(times.to_vec(), values.to_vec(), 1, Interpolation::Linear).unwrap_err()
        };
        assert_eq!(new(&[], &[]), CurveError::NoKeys);
        assert_eq!(new(&[0.0, -1.0], &[0.0, 0.0]), CurveError::Order { key: 1 });
        assert_eq!(new(&[f64::NAN], &[0.0]), CurveError::Order { key: 0 });
        assert_eq!(new(&[0.0, 1.0], &[0.0]), CurveError::Count { found: 1, needed: 2 });
        assert_eq!(new(&[0.0], &[f64::INFINITY]), CurveError::NotFinite { index: 0 });
    }
}
