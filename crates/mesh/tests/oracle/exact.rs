//! Signs of determinants, by whole numbers where they do and by fractions where they do not.

use glam::DVec3;
use num_rational::BigRational;

/// 1 if the corners run counter-clockwise seen from the point, −1 if clockwise, 0 in one plane.
pub(crate) fn side([a, b, c]: [DVec3; 3], point: DVec3) -> i8 {
    determinant_sign([[b, a], [c, a], [point, a]])
}

/// Sign of the determinant of three differences.
pub(crate) fn determinant_sign(rows: [[DVec3; 2]; 3]) -> i8 {
    // Small multiples of 1/64 are whole numbers in that unit.
    let parts = rows.map(|row| row.map(|p| (64.0 * p).to_array()));
    if parts.as_flattened().as_flattened().iter().all(|x| x.fract() == 0.0 && x.abs() < 1e6) {
        #[expect(clippy::cast_possible_truncation, reason = "whole and below a million")]
        let [u, v, w] = parts.map(|[p, q]| [0, 1, 2].map(|i| p[i] as i128 - q[i] as i128));
        return sign(&determinant(&u, &v, &w));
    }
    // Far from zero rounding cannot matter; the bound is a thousand times what it need be.
    let rough = rows.map(|[p, q]| p - q);
    let products = rough.map(|r| r.abs()).map(|r| r.to_array());
    let size: f64 = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0], [1, 0, 2], [0, 2, 1]]
        .iter()
        .map(|&[i, j, k]| products[0][i] * products[1][j] * products[2][k])
        .sum();
    let estimate = rough[0].cross(rough[1]).dot(rough[2]);
    if size.is_finite() && estimate.abs() > 1e-11 * size && size > 1e-250 {
        return if estimate > 0.0 { 1 } else { -1 };
    }
    let [u, v, w] = rows.map(|[p, q]| difference(&exact(p), &exact(q)));
    sign(&determinant(&u, &v, &w))
}

fn determinant<T>(u: &[T; 3], v: &[T; 3], w: &[T; 3]) -> T
where
    for<'a> &'a T: std::ops::Mul<&'a T, Output = T>,
    T: std::ops::Sub<T, Output = T> + std::ops::Add<T, Output = T>,
{
    let [x, y, z] =
        [(1, 2, 0), (2, 0, 1), (0, 1, 2)].map(|(i, j, k)| &(&u[i] * &v[j] - &u[j] * &v[i]) * &w[k]);
    x + y + z
}

fn sign<T: Default + PartialOrd>(x: &T) -> i8 {
    i8::from(*x > T::default()) - i8::from(*x < T::default())
}

pub(crate) fn exact(p: DVec3) -> [BigRational; 3] {
    p.to_array().map(|x| BigRational::from_float(x).unwrap())
}

pub(crate) fn difference(p: &[BigRational; 3], q: &[BigRational; 3]) -> [BigRational; 3] {
    [0, 1, 2].map(|i| &p[i] - &q[i])
}
