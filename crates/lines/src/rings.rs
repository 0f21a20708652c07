//! From triangles on the page to the outlines of what they cover together.

use std::collections::BTreeMap;

use glam::DVec2;

/// Steps of a pixel that points are rounded to: what an SVG says.
const STEPS: f64 = 100.0;

/// A point on the page, in steps.
type Point = [i64; 2];

/// The outlines of triangles that meet at whole sides or not at all: where two meet, the side
/// between them is gone. Where they do not meet at whole sides, outlines touch. Sorts the sides;
/// same output for the same triangles, whatever their order.
pub(crate) fn dissolve(triangles: &[[DVec2; 3]]) -> Vec<Vec<DVec2>> {
    let mut sides: Vec<(Point, Point, i64)> = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        let [a, mut b, mut c] = triangle.map(rounded);
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if twice == 0 {
            continue;
        }
        // Faces are seen from both sides; here all run the same way around.
        if twice < 0 {
            (b, c) = (c, b);
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sides.push(if from < to { (from, to, 1) } else { (to, from, -1) });
        }
    }
    sides.sort_unstable();
    let mut next: BTreeMap<Point, Vec<Point>> = BTreeMap::new();
    for side in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (from, to, _) = side[0];
        let net: i64 = side.iter().map(|side| side.2).sum();
        let (from, to) = if net > 0 { (from, to) } else { (to, from) };
        for _ in 0..net.abs() {
            next.entry(from).or_default().push(to);
        }
    }
    rings(next)
}

/// Walks from point to point. As many sides end at each as start there, so every walk comes back.
fn rings(mut next: BTreeMap<Point, Vec<Point>>) -> Vec<Vec<DVec2>> {
    let mut rings = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut ring = Vec::new();
        let mut point = start;
        while let Some(ways) = next.get_mut(&point) {
            ring.push(point);
            let way = ways.pop();
            if ways.is_empty() {
                next.remove(&point);
            }
            point = way.unwrap_or(start);
            if point == start {
                break;
            }
        }
        rings.push(ring.into_iter().map(unrounded).collect());
    }
    rings
}

fn rounded(point: DVec2) -> Point {
    #[expect(clippy::cast_possible_truncation, reason = "saturates, and pages are smaller")]
    let rounded = point.to_array().map(|x| (STEPS * x).round().clamp(-1e9, 1e9) as i64);
    rounded
}

fn unrounded(point: Point) -> DVec2 {
    DVec2::from_array(point.map(|x| x as f64 / STEPS))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn a_square_of_two_triangles_is_one_ring() {
        let [a, b, c, d] = [p(0.0, 0.0), p(2.0, 0.0), p(2.0, 2.0), p(0.0, 2.0)];
        for triangles in [[[a, b, c], [a, c, d]], [[c, b, a], [a, c, d]]] {
            assert_eq!(dissolve(&triangles), [vec![a, b, c, d]]);
        }
    }

    #[test]
    fn apart_they_are_two_and_a_hole_runs_the_other_way() {
        let [a, b, c] = [p(0.0, 0.0), p(1.0, 0.0), p(0.0, 1.0)];
        let away = [a, b, c].map(|q| q + 5.0);
        assert_eq!(dissolve(&[[a, b, c], away]), [vec![a, b, c], away.to_vec()]);
        assert_eq!(dissolve(&[[a, b, a]]), Vec::<Vec<DVec2>>::new());

        let (outer, inner) =
            ([p(0.0, 0.0), p(9.0, 0.0), p(0.0, 9.0)], [p(2.0, 2.0), p(4.0, 2.0), p(2.0, 4.0)]);
        let frame: Vec<_> = (0..3)
            .flat_map(|i| {
                let j = (i + 1) % 3;
                [[outer[i], outer[j], inner[i]], [inner[i], outer[j], inner[j]]]
            })
            .collect();
        let area = |ring: &Vec<DVec2>| -> f64 {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(a, b)| 0.5 * a.perp_dot(*b)).sum()
        };
        assert_eq!(dissolve(&frame).iter().map(area).collect::<Vec<_>>(), [40.5, -2.0]);
    }
}
