//! What property tests draw, the same in every run.

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

/// The same cases in every run, so that the table of mutants can be compared.
pub(crate) fn cases(count: u32) -> Config {
    Config {
        cases: count,
        rng_seed: RngSeed::Fixed(20),
        failure_persistence: None,
        // Enough to read a case by, and little enough for broken bounds to fail within seconds.
        max_shrink_iters: 1_000,
        ..Config::default()
    }
}

/// A unit vector, uniform over the sphere.
pub(crate) fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0f64, 0.0..std::f64::consts::TAU).prop_map(|(z, turn)| {
        let (sin, cos) = turn.sin_cos();
        let across = ((1.0 - z) * (1.0 + z)).sqrt();
        DVec3::new(across * cos, across * sin, z)
    })
}

/// 10 to a power between `low` and `high`.
pub(crate) fn magnitude(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|exponent| 10f64.powf(exponent))
}
