//! The lowest point above some planes: a linear program of three unknowns.
//!
//! Seidel, Small-Dimensional Linear Programming and Convex Hulls Made Easy, Discrete & Computational
//! Geometry 6, 1991: constraints are taken in one after the other, and where one is violated the
//! new optimum lies on it, so that a program of one unknown less is left. His linear time rests on a
//! random order. Here he is given a few planes only, in the order in which they come: those known to
//! matter, and then, until none is violated, the one that is violated most.

use glam::DVec2;

/// Rounds after which a place is taken as it is. The height grows with each, so that only rounding
/// could keep it going for so long.
const MAX_ROUNDS: usize = 64;

/// What two heights may differ by and count as equal, as a share of how far places reach.
const TOLERANCE: f64 = 1e-10;

/// A plane as a function over the plane across the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Height {
    /// Where it crosses the axis.
    pub(super) at_start: f64,
    /// By how much it rises along both directions across.
    pub(super) slope: DVec2,
}

impl Height {
    pub(super) fn at(&self, place: DVec2) -> f64 {
        self.at_start + self.slope.dot(place)
    }
}

impl std::ops::Neg for Height {
    type Output = Self;

    fn neg(self) -> Self {
        Self { at_start: -self.at_start, slope: -self.slope }
    }
}

/// The place, with coordinates within ±`reach`, where the highest of all `heights` is lowest, to
/// within rounding. One of them, if there are several.
///
/// `support` are the indices of some that are likely to matter, at least one; it is replaced by those
/// that do. A few scans.
pub(super) fn lowest_place(heights: &[Height], reach: f64, support: &mut Vec<usize>) -> DVec2 {
    let mut chosen: Vec<Height> = support.iter().map(|&index| heights[index]).collect();
    let mut place = DVec2::ZERO;
    let mut lowest = f64::NEG_INFINITY;
    for _ in 0..MAX_ROUNDS {
        place = lowest_of_few(&chosen, reach);
        let known = highest_at(&chosen, place).1;
        let least = known - TOLERANCE * reach;
        let (highest, height) = highest_at(heights, place);
        let is_lowest = height <= known + TOLERANCE * reach;
        // What is below all others there does not hold it up. While the height stays, nothing is dropped, or
        // the same planes could come and go for ever.
        if is_lowest || known > lowest + TOLERANCE * reach {
            support.retain(|&index| heights[index].at(place) >= least);
        }
        if is_lowest {
            break;
        }
        lowest = known;
        support.push(highest);
        chosen.clear();
        chosen.extend(support.iter().map(|&index| heights[index]));
    }
    place
}

fn highest_at(heights: &[Height], place: DVec2) -> (usize, f64) {
    let mut highest = (0, f64::NEG_INFINITY);
    for (index, height) in heights.iter().enumerate() {
        let height = height.at(place);
        if height > highest.1 {
            highest = (index, height);
        }
    }
    highest
}

/// Seidel's method. Cubic at worst.
fn lowest_of_few(heights: &[Height], reach: f64) -> DVec2 {
    let (mut place, mut lowest) = (DVec2::ZERO, f64::NEG_INFINITY);
    for (index, height) in heights.iter().enumerate() {
        if height.at(place) > lowest {
            place = lowest_on_plane(*height, &heights[..index], reach);
            lowest = height.at(place);
        }
    }
    place
}

/// Where `height` is lowest among the places at which none of the `others` is higher.
fn lowest_on_plane(height: Height, others: &[Height], reach: f64) -> DVec2 {
    let down = -height.slope;
    let corner = |slope: f64| if slope == 0.0 { 0.0 } else { reach.copysign(slope) };
    let mut place = DVec2::new(corner(down.x), corner(down.y));
    for (index, other) in others.iter().enumerate() {
        let cut = Cut::below(*other, height);
        if cut.normal.dot(place) > cut.offset {
            let before = others[..index].iter().map(|other| Cut::below(*other, height));
            place = farthest_on_line(cut, before, down, reach).unwrap_or(place);
        }
    }
    place
}

/// The half-plane of the places p with normal · p ≤ offset.
#[derive(Clone, Copy)]
struct Cut {
    normal: DVec2,
    offset: f64,
}

impl Cut {
    /// Where one height is not above the other.
    fn below(low: Height, high: Height) -> Self {
        Self { normal: low.slope - high.slope, offset: high.at_start - low.at_start }
    }
}

/// The place on the line around `cut` that is within the `others` and farthest along `direction`.
/// `None` if rounding left no line, or nothing of it.
fn farthest_on_line(
    cut: Cut,
    others: impl Iterator<Item = Cut>,
    direction: DVec2,
    reach: f64,
) -> Option<DVec2> {
    let along = cut.normal.perp().try_normalize()?;
    let start = cut.normal * (cut.offset / cut.normal.length_squared());
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut clip = |slope: f64, room: f64| {
        // slope · t ≤ room
        if slope > 0.0 {
            high = high.min(room / slope);
        } else if slope < 0.0 {
            low = low.max(room / slope);
        }
    };
    for axis in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
        clip(axis.dot(along), reach - axis.dot(start));
    }
    for other in others {
        clip(other.normal.dot(along), other.offset - other.normal.dot(start));
    }
    // Lines that meet in one point leave an interval that rounding may turn over.
    let end = if direction.dot(along) > 0.0 { high } else { low };
    end.is_finite().then(|| start + end * along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn highest(heights: &[Height], place: DVec2) -> f64 {
        highest_at(heights, place).1
    }

    /// The lowest of all points where three planes, or two and a side of the square, or one and a
    /// corner meet, with nothing above it.
    fn by_brute_force(heights: &[Height], reach: f64) -> f64 {
        let mut lines: Vec<Cut> = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]
            .map(|normal| Cut { normal, offset: reach })
            .to_vec();
        for (index, &a) in heights.iter().enumerate() {
            lines.extend(heights[index + 1..].iter().map(|&b| Cut::below(a, b)));
        }
        let mut lowest = f64::INFINITY;
        for (index, a) in lines.iter().enumerate() {
            for b in &lines[index + 1..] {
                let place = (a.offset * b.normal.perp() - b.offset * a.normal.perp())
                    / b.normal.perp_dot(a.normal);
                if place.abs().max_element() <= reach * (1.0 + 1e-12) {
                    lowest = lowest.min(highest(heights, place));
                }
            }
        }
        lowest
    }

    #[track_caller]
    fn check(heights: &[Height], reach: f64) {
        let mut support = vec![0];
        let place = lowest_place(heights, reach, &mut support);
        assert!(place.abs().max_element() <= reach * (1.0 + 1e-12), "{place}");
        let (found, expected) = (highest(heights, place), by_brute_force(heights, reach));
        assert!((found - expected).abs() <= 1e-7 * reach, "{found} for {expected}: {heights:?}");
    }

    fn height(at_start: f64, x: f64, y: f64) -> Height {
        Height { at_start, slope: DVec2::new(x, y) }
    }

    #[test]
    fn few_planes() {
        check(&[height(1.0, 0.0, 0.0)], 1.0);
        check(&[height(1.0, 0.5, -0.5)], 1.0);
        check(&[height(1.0, 0.5, 0.0), height(1.0, -0.5, 0.0)], 1.0);
        check(&[height(1.0, 0.5, 0.0), height(3.0, 0.5, 0.0), height(2.0, 0.5, 0.0)], 1.0);
        // Three that meet in one point above a level one.
        let level = height(-0.9572830089253508, 0.0, 0.0);
        let [up, aslant, down] =
            [(0.0, 3.9), (3.6, -6.3), (-6.1, 0.0)].map(|(x, y)| height(0.0, x, y));
        check(&[level, up, aslant, down], 2.0);
        // A pyramid upside down, with each side there twice, and its tip outside.
        for start in [0.0, 0.5, 7.0] {
            let side = |x: f64, y: f64| height(start * (x - y), x, y);
            let sides = [side(1.0, 0.0), side(0.0, 1.0), side(-1.0, 0.0), side(0.0, -1.0)];
            check(&[sides, sides].concat(), 1.0);
        }
    }

    proptest! {
        #[test]
        fn it_is_the_lowest(
            planes in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 1..12),
            steep in -6.0..1.0f64, grid in prop::bool::ANY,
        ) {
            // On a grid, many planes are parallel or meet in one line.
            let snap = |x: f64| if grid { (3.0 * x).round() / 3.0 } else { x };
            let planes: Vec<Height> = planes
                .into_iter()
                .map(|(c, x, y)| height(snap(c), 10f64.powf(steep) * snap(x), 10f64.powf(steep) * snap(y)))
                .collect();
            check(&planes, 2.0);
        }
    }
}
