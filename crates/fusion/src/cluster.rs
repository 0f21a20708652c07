//! A patch in the making, and what fusing two of them gains.

use glam::DVec3;

use crate::columns::Columns;
use crate::extent::{Extent, TRAITS};
use crate::geometry::EdgeShape;
use crate::greedy::GreedyModel;
use crate::lanes::{Lanes, Number};

/// How far a computed cost may lie from the exact one, per edge: generous, as it only lets a few
/// more pairs through to the exact comparison.
pub(crate) const COST_SLACK: f64 = 1e-9;

/// Normals by which [`least_cost`] knows a patch.
pub(crate) const SAMPLES: usize = 3;

/// A patch in the making: what is needed to bound the union with any other.
#[derive(Debug)]
pub(crate) struct Cluster<E> {
    /// Numbers of its edges in its part of space, unsorted.
    pub(crate) edges: Vec<u32>,
    /// Its expected cost E.
    pub(crate) cost: f64,
    /// Both faces' normals of each edge.
    normals: Columns<3>,
    /// Their sum: the axis of the cone is the mean normal.
    normal_sum: DVec3,
    extent: E,
}

impl<E: Extent> Cluster<E> {
    pub(crate) fn of_edge(number: u32, edge: &EdgeShape, model: &GreedyModel) -> Self {
        let mut cluster = Self {
            edges: vec![number],
            cost: 0.0,
            normals: edge.normals.iter().map(|n| n.to_array()).collect(),
            normal_sum: edge.normals[0] + edge.normals[1],
            extent: E::of_edge(edge),
        };
        let cos = cluster.least_cosine(axis(cluster.normal_sum));
        // An edge united with itself has the edge's own sphere.
        let radius = cluster.extent.union_radius(&cluster.extent);
        cluster.cost = model.patch(acceptance(cos, radius, model.view_distance), 1);
        cluster
    }

    pub(crate) fn fused(a: &Self, b: &Self, model: &GreedyModel) -> Self {
        Self {
            edges: a.edges.iter().chain(&b.edges).copied().collect(),
            cost: Self::union_cost(a, b, model, f64::INFINITY),
            normals: a.normals.iter().chain(b.normals.iter()).collect(),
            normal_sum: a.normal_sum + b.normal_sum,
            extent: a.extent.fused(&b.extent),
        }
    }

    /// What fusing a and b saves per view, in edge tests: G = E(a) + E(b) − E(a ∪ b). The same for
    /// (b, a), to the last bit. Where it falls short of `least`, any number below `least`.
    pub(crate) fn gain(a: &Self, b: &Self, model: &GreedyModel, least: f64) -> f64 {
        let apart = a.cost + b.cost;
        apart - Self::union_cost(a, b, model, apart - least)
    }

    /// E(a ∪ b); where that is certainly above `most`, any number above `most`.
    fn union_cost(a: &Self, b: &Self, model: &GreedyModel, most: f64) -> f64 {
        let edges = a.edges.len() + b.edges.len();
        let axis = axis(a.normal_sum + b.normal_sum);
        let cos = a.least_cosine(axis).min(b.least_cosine(axis));
        // Most pairs are out by their normals alone, and never touch their edges.
        let cost_in_a_point = model.patch(acceptance(cos, 0.0, model.view_distance), edges);
        if cost_in_a_point - COST_SLACK * edges as f64 > most {
            return cost_in_a_point;
        }
        let radius = a.extent.union_radius(&b.extent);
        model.patch(acceptance(cos, radius, model.view_distance), edges)
    }

    /// Cosine of the largest angle between a normal and `axis`.
    fn least_cosine(&self, axis: DVec3) -> f64 {
        let [a, b, c] = axis.to_array().map(Lanes::of);
        self.normals.min_of(|[x, y, z]| x * a + y * b + z * c)
    }

    /// What [`least_cost`] needs to know of this cluster.
    pub(crate) fn outline(&self) -> Outline<f64> {
        Outline {
            cost: self.cost,
            edges: self.edges.len() as f64,
            normal_sum: self.normal_sum.to_array(),
            samples: self.extreme_normals(),
            traits: self.extent.traits(),
        }
    }

    /// Normals that lie far apart: the one farthest from the axis, the one farthest from that, and
    /// the one farthest from both.
    fn extreme_normals(&self) -> [[f64; 3]; SAMPLES] {
        let farthest_from = |direction: DVec3| {
            let cosine = |n: &[f64; 3]| DVec3::from_array(*n).dot(direction);
            let least = self.normals.iter().min_by(|a, b| cosine(a).total_cmp(&cosine(b)));
            DVec3::from_array(least.unwrap_or_default())
        };
        let first = farthest_from(self.normal_sum);
        let second = farthest_from(first);
        let third = farthest_from(first + second);
        [first, second, third].map(|n| n.to_array())
    }
}

/// A cluster in a few numbers, or several clusters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline<T> {
    pub(crate) cost: T,
    pub(crate) edges: T,
    pub(crate) normal_sum: [T; 3],
    pub(crate) samples: [[T; 3]; SAMPLES],
    pub(crate) traits: [T; TRAITS],
}

impl<T: Copy> Outline<T> {
    pub(crate) fn map<U>(&self, f: impl Fn(T) -> U) -> Outline<U> {
        Outline {
            cost: f(self.cost),
            edges: f(self.edges),
            normal_sum: self.normal_sum.map(&f),
            samples: self.samples.map(|sample| sample.map(&f)),
            traits: self.traits.map(&f),
        }
    }

    pub(crate) fn set_each<U: Copy>(&mut self, values: &Outline<U>, set: impl Fn(&mut T, U)) {
        let each = |rows: &mut [T], values: &[U]| {
            rows.iter_mut().zip(values).for_each(|(row, &value)| set(row, value));
        };
        set(&mut self.cost, values.cost);
        set(&mut self.edges, values.edges);
        each(&mut self.normal_sum, &values.normal_sum);
        each(self.samples.as_flattened_mut(), values.samples.as_flattened());
        each(&mut self.traits, &values.traits);
    }
}

/// The most that fusing two clusters may gain: never below [`Cluster::gain`], rounding included.
///
/// The axis of the union is known; the samples are normals of it, so its angle is no smaller than
/// theirs; and H grows with the angle and with the radius.
#[inline(always)]
pub(crate) fn most_gain<E: Extent>(
    a: &Outline<Lanes>,
    b: &Outline<Lanes>,
    model: &GreedyModel,
) -> Lanes {
    let ([a0, a1, a2], [b0, b1, b2]) = (a.normal_sum, b.normal_sum);
    let (x, y, z) = (a0 + b0, a1 + b1, a2 + b2);
    let mut least_dot = Lanes::of(f64::INFINITY);
    for i in 0..SAMPLES {
        for [u, v, w] in [&a.samples[i], &b.samples[i]] {
            least_dot = (x * *u + y * *v + z * *w).smaller(least_dot);
        }
    }
    // Rounding of the cosine is the only one that counts, where the sine is small.
    let cos = least_dot / (x * x + y * y + z * z).sqrt() + Lanes::of(1e-12);
    let radius = E::least_radius(&a.traits, &b.traits) * Lanes::of(1.0 - 1e-12);
    let acceptance = acceptance(cos, radius, Lanes::of(model.view_distance));
    let least_cost =
        Lanes::of(model.patch_test) + (acceptance - Lanes::of(COST_SLACK)) * (a.edges + b.edges);
    a.cost + b.cost - least_cost
}

/// Unit vector along the sum of normals; zero, which no normal is near to, if they cancel.
fn axis(normal_sum: DVec3) -> DVec3 {
    let length = normal_sum.length();
    if length > 0.0 { normal_sum / length } else { DVec3::ZERO }
}

/// Probability H that a patch survives, for viewpoints at `distance` from its center in any
/// direction: sin(α + β), sin β = `radius` / `distance`, and 1 when α + β passes 90° (TB24 eq. 3).
///
/// 1 as well if `cos` α or `distance` is not above 0, or anything is NaN.
#[inline(always)]
pub(crate) fn acceptance<T: Number>(cos: T, radius: T, distance: T) -> T {
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let sin = (one - cos * cos).larger(zero).sqrt();
    let sin_beta = radius / distance;
    let cos_beta = (one - sin_beta * sin_beta).larger(zero).sqrt();
    let sum = sin * cos_beta + cos * sin_beta;
    let sum = (sin * sin_beta).if_less(cos * cos_beta, sum, one);
    let sum = sin_beta.if_less(zero, one, sum);
    zero.if_less(cos, sum, one)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extent::{MeanExtent, ReducedExtent};
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
    }

    /// Edges of a patch: normals around a direction, ends around a place; some share vertices.
    fn patch() -> impl Strategy<Value = Vec<EdgeShape>> {
        let edge = (vector(), vector(), vector(), 0..8u32, 100..u32::MAX);
        let spread = -6.0..0.5f64;
        (proptest::collection::vec(edge, 1..12), vector(), vector(), spread.clone(), spread)
            .prop_map(|(edges, normal, place, wide, large)| {
                let (wide, large) = (10f64.powf(wide), 10f64.powf(large));
                let unit = |n: DVec3| n.try_normalize().unwrap_or(DVec3::Z);
                let shape = |(m, n, p, vertex, other): (DVec3, DVec3, DVec3, u32, u32)| {
                    // A vertex has one place, whichever edge it belongs to.
                    let shared = DVec3::new(f64::from(vertex) / 8.0, 0.5, 0.0);
                    let free = place + large * p;
                    EdgeShape {
                        normals: [m, n].map(|n| unit(normal + wide * n)),
                        vertices: [vertex, other],
                        ends: [shared, free],
                        direction: unit(free - shared),
                    }
                };
                edges.into_iter().map(shape).collect()
            })
    }

    fn cluster<E: Extent>(edges: &[EdgeShape], model: &GreedyModel) -> Cluster<E> {
        let single = |(i, edge): (u32, &EdgeShape)| Cluster::<E>::of_edge(i, edge, model);
        (0..).zip(edges).map(single).reduce(|a, b| Cluster::fused(&a, &b, model)).unwrap()
    }

    /// E by its definition, with angles.
    fn expected_cost(edges: &[EdgeShape], is_reduced: bool, model: &GreedyModel) -> f64 {
        let normals: Vec<DVec3> = edges.iter().flat_map(|e| e.normals).collect();
        let axis = normals.iter().sum::<DVec3>().normalize();
        let alpha = normals.iter().map(|n| n.cross(axis).length().atan2(n.dot(axis)));
        let alpha = alpha.fold(0.0, f64::max);
        let radius = if is_reduced {
            let middle = |e: &EdgeShape| 0.5 * (e.ends[0] + e.ends[1]);
            let center = edges.iter().map(middle).sum::<DVec3>() / edges.len() as f64;
            edges
                .iter()
                .map(|e| (center - e.ends[1]).cross(e.direction).length())
                .fold(0.0, f64::max)
        } else {
            let ends = edges.iter().flat_map(|e| e.vertices.into_iter().zip(e.ends));
            let mut vertices: Vec<(u32, DVec3)> = ends.collect();
            vertices.sort_by_key(|&(vertex, _)| vertex);
            vertices.dedup_by_key(|&mut (vertex, _)| vertex);
            let center = vertices.iter().map(|&(_, p)| p).sum::<DVec3>() / vertices.len() as f64;
            vertices.iter().map(|&(_, p)| p.distance(center)).fold(0.0, f64::max)
        };
        let angle = alpha + (radius / model.view_distance).asin();
        let is_wide = radius >= model.view_distance || angle >= std::f64::consts::FRAC_PI_2;
        let acceptance = if is_wide { 1.0 } else { angle.sin() };
        model.patch_test + acceptance * edges.len() as f64
    }

    fn check_pair<E: Extent>(a: &[EdgeShape], b: &[EdgeShape], is_reduced: bool, distance: f64) {
        let model = GreedyModel { patch_test: 1.363, view_distance: distance };
        let (first, second) = (cluster::<E>(a, &model), cluster::<E>(b, &model));
        let gain = Cluster::gain(&first, &second, &model, f64::NEG_INFINITY);
        let reversed = Cluster::gain(&second, &first, &model, f64::NEG_INFINITY);
        assert_eq!(gain.to_bits(), reversed.to_bits());

        let cost = |edges: &[EdgeShape]| expected_cost(edges, is_reduced, &model);
        let expected = cost(a) + cost(b) - cost(&[a, b].concat());
        assert!((gain - expected).abs() <= 1e-5, "{gain} is not {expected}");

        for least in [0.0, gain - 1e-3, gain, gain + 1e-3] {
            let answer = Cluster::gain(&first, &second, &model, least);
            let is_right = if gain >= least { answer == gain } else { answer < least };
            assert!(is_right, "{answer} for {gain}, asked for {least}");
        }
        let [a_row, b_row] = [&first, &second].map(|c| c.outline().map(Lanes::of));
        let most = most_gain::<E>(&a_row, &b_row, &model).0[0];
        assert!(most >= gain, "{most} is below {gain}");
        if a.len() == 1 && b.len() == 1 && is_reduced {
            assert!(most <= gain + 1e-5, "single edges are known exactly: {most}, {gain}");
        }
    }

    proptest! {
        #[test]
        fn gains_are_right_and_bounded(a in patch(), b in patch(), distance in 1.0..20.0f64) {
            check_pair::<ReducedExtent>(&a, &b, true, distance);
            check_pair::<MeanExtent>(&a, &b, false, distance);
            check_pair::<ReducedExtent>(&a[..1], &b[..1], true, distance);
        }
    }

    #[test]
    fn acceptance_is_a_sine_up_to_a_right_angle() {
        let check = |cos: f64, radius: f64, distance: f64, expected: f64| {
            assert!((acceptance(cos, radius, distance) - expected).abs() < 1e-12);
            assert!(
                (acceptance(Lanes::of(cos), Lanes::of(radius), Lanes::of(distance)).0[1]
                    - expected)
                    .abs()
                    < 1e-12
            );
        };
        let cos = |degrees: f64| degrees.to_radians().cos();
        check(cos(0.0), 0.0, 10.0, 0.0);
        check(cos(30.0), 0.0, 10.0, 0.5);
        check(cos(30.0), 5.0, 10.0, 60f64.to_radians().sin());
        check(cos(59.9), 5.0, 10.0, 89.9f64.to_radians().sin());
        check(cos(60.1), 5.0, 10.0, 1.0);
        check(cos(95.0), 0.0, 10.0, 1.0);
        for nonsense in [0.0, -1.0, f64::NAN] {
            check(cos(30.0), 5.0, nonsense, 1.0);
            check(nonsense, 5.0, 10.0, 1.0);
        }
        check(cos(0.0), 10.0, 10.0, 1.0);
    }
}
