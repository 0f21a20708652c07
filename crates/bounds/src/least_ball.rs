//! The center of the smallest ball that meets given lines.
//!
//! The square of the distance to a line is a convex quadratic function, q(c) = |v|² with
//! v = (1 − u uᵀ)(c − a) for the line through a along the unit vector u, so that the smallest ball is
//! a convex program of four unknowns: s is least with every q(c) ≤ s. Newton's method follows the
//! minimum of τ (s + ρ |c|²) − Σ ln(s − q(c)) as τ grows (Nesterov and Nemirovskii, Interior-Point
//! Polynomial Algorithms in Convex Programming, 1994). The barrier is self-concordant: damped steps
//! need no line search and never leave the feasible side, and at the minimum s is too large by
//! count / τ at most.
//!
//! Lines that are nearly parallel leave the center free along them, where it is of no use far away:
//! ρ keeps it near.

use glam::{DMat3, DVec3};

/// How much larger than the least s may be, as a share of that of the start.
const TOLERANCE: f64 = 1e-8;

/// ρ, with distances in radii of the start: s may be larger by that much times the square of the
/// distance from the start to a center that would be better.
const STIFFNESS: f64 = 1e-6;

/// By how much τ grows when a minimum is found.
const GROWTH: f64 = 30.0;

/// A step shorter than this, in the norm of the Hessian, has found a minimum.
const SHORT_STEP: f64 = 0.3;

/// Steps after which a center is taken as it is. Patches of the bunny need 43, on the mean.
const MAX_STEPS: usize = 100;

/// The line through an edge, in a frame where the start is the origin and its ball has radius 1.
struct Line {
    point: DVec3,
    /// Unit vector; zero where the ends of the edge are equal.
    direction: DVec3,
}

impl Line {
    /// v: from the line to c, across the line.
    fn across(&self, c: DVec3) -> DVec3 {
        let from_point = c - self.point;
        from_point - self.direction.dot(from_point) * self.direction
    }
}

/// The center of the smallest ball that meets the line through each edge; where the ends of an edge
/// are equal, that point. `start` is near all of them, and the lines are within `radius` of it.
///
/// The square of its radius is at most 1e-8 `radius`² above the least of all centers, plus 1e-6
/// times the square of the distance from `start` to where that is. `start` itself if `radius` is 0
/// or not finite. Some 40 steps of two scans each.
pub(crate) fn center_of_least_ball(
    start: DVec3,
    radius: f64,
    edges: impl Iterator<Item = [DVec3; 2]>,
) -> DVec3 {
    if !(radius > 0.0 && radius.is_finite()) {
        return start;
    }
    let line = |[tail, head]: [DVec3; 2]| Line {
        point: (tail - start) / radius,
        direction: ((head - tail) / radius).normalize_or_zero(),
    };
    let lines: Vec<Line> = edges.map(line).collect();
    let (mut center, mut square) = (DVec3::ZERO, 2.0);
    let mut tau = lines.len() as f64;
    let most = lines.len() as f64 / TOLERANCE;
    for _ in 0..MAX_STEPS {
        let step = newton_step(&lines, tau, center, square);
        if !step.length.is_finite() {
            break;
        }
        center += step.center / (1.0 + step.length);
        square += step.square / (1.0 + step.length);
        if step.length < SHORT_STEP {
            if tau >= most {
                break;
            }
            tau = most.min(GROWTH * tau);
        }
    }
    start + radius * center
}

struct Step {
    center: DVec3,
    square: f64,
    /// In the norm of the Hessian: Newton's decrement.
    length: f64,
}

/// Towards the minimum of τ (s + ρ |c|²) − Σ ln(s − q(c)).
fn newton_step(lines: &[Line], tau: f64, center: DVec3, square: f64) -> Step {
    let weighted = |line: &Line| {
        let across = line.across(center);
        (1.0 / (square - across.length_squared()), 2.0 * across)
    };
    let (mut gradient, mut square_gradient) = (2.0 * STIFFNESS * tau * center, tau);
    let (mut square_hessian, mut mixed) = (0.0, DVec3::ZERO);
    for (weight, slope) in lines.iter().map(weighted) {
        gradient += weight * slope;
        square_gradient -= weight;
        square_hessian += weight * weight;
        mixed += weight * weight * slope;
    }
    // The Hessian after s is eliminated: as a sum about the mean slope, nothing cancels.
    let mean = mixed / square_hessian;
    let mut hessian = DMat3::from_diagonal(DVec3::splat(2.0 * STIFFNESS * tau));
    for (line, (weight, slope)) in lines.iter().zip(lines.iter().map(weighted)) {
        let (about_mean, u) = (weight * (slope - mean), line.direction);
        hessian += outer(about_mean, about_mean) - 2.0 * weight * outer(u, u)
            + DMat3::from_diagonal(DVec3::splat(2.0 * weight));
    }
    let center_step = solve(&hessian, -gradient - square_gradient * mean);
    let square_step = mean.dot(center_step) - square_gradient / square_hessian;
    let decrease = -(gradient.dot(center_step) + square_gradient * square_step);
    Step { center: center_step, square: square_step, length: decrease.max(0.0).sqrt() }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(b.x * a, b.y * a, b.z * a)
}

/// The solution x of `matrix` x = `right`, by Cholesky's method: a matrix that is positive, however
/// unevenly, is no trouble, as it would be to its determinant. NaN if it is not positive.
fn solve(matrix: &DMat3, right: DVec3) -> DVec3 {
    let [a, b, c] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let xx = a.x.sqrt();
    let (yx, zx) = (a.y / xx, a.z / xx);
    let yy = (b.y - yx * yx).sqrt();
    let zy = (b.z - yx * zx) / yy;
    let zz = (c.z - zx * zx - zy * zy).sqrt();
    let x = right.x / xx;
    let y = (right.y - yx * x) / yy;
    let z = (right.z - zx * x - zy * y) / (zz * zz);
    let y = (y - zy * z) / yy;
    DVec3::new((x - yx * y - zx * z) / xx, y, z)
}
