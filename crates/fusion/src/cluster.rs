//! A patch in the making, and what fusing two of them gains.

use glam::DVec3;

use crate::CostModel;
use crate::columns::Columns;
use crate::extent::{Extent, TRAITS};
use crate::geometry::EdgeShape;
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
    pub(crate) fn of_edge(number: u32, edge: &EdgeShape, model: &CostModel) -> Self {
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

    pub(crate) fn fused(a: &Self, b: &Self, model: &CostModel) -> Self {
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
    pub(crate) fn gain(a: &Self, b: &Self, model: &CostModel, least: f64) -> f64 {
        let apart = a.cost + b.cost;
        apart - Self::union_cost(a, b, model, apart - least)
    }

    /// E(a ∪ b); where that is certainly above `most`, any number above `most`.
    fn union_cost(a: &Self, b: &Self, model: &CostModel, most: f64) -> f64 {
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
    model: &CostModel,
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
