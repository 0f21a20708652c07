//! Specks: visible runs so short and so alone that they are noise on paper.

use std::collections::HashMap;

use crate::Run;
use crate::disjoint::DisjointSets;

/// Side of the cells in which runs meet, in pixels: runs that come nearer than one side touch,
/// those two sides apart do not.
const CELL: f64 = 1.0;

/// For each of `runs` whether it is part of a speck: a visible run or several touching ones that
/// are shorter than `limit` pixels in sum and touch no longer one. Where nothing longer is to be
/// seen, what is short is the picture, and no speck. Linear in the pixels of line.
///
/// Length alone would not do: on a dense mesh an outline is made of many short runs. Nor would
/// sparing closed runs, which may outline something small: a scan is covered with closed contours a
/// pixel or two wide.
pub(crate) fn specks(runs: &[&Run], limit: f64) -> Vec<bool> {
    let lengths: Vec<f64> = runs.iter().map(|run| run.length()).collect();
    let is_short = |i: usize| runs[i].visible && lengths[i] < limit;
    let mut groups = DisjointSets::new(runs.len());
    let mut owners: HashMap<[i64; 2], usize> = HashMap::new();
    for index in (0..runs.len()).filter(|&i| is_short(i)) {
        for_each_cell(runs[index], |[x, y]| {
            for cell in (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y])) {
                let owner = *owners.entry(cell).or_insert(index);
                groups.join(owner, index);
            }
        });
    }
    if owners.is_empty() {
        return vec![false; runs.len()];
    }
    let mut group_length = vec![0.0; runs.len()];
    for index in 0..runs.len() {
        if is_short(index) {
            group_length[groups.root(index)] += lengths[index];
        } else if runs[index].visible {
            for_each_cell(runs[index], |cell| {
                if let Some(&owner) = owners.get(&cell) {
                    group_length[groups.root(owner)] = f64::INFINITY;
                }
            });
        }
    }
    let is_speck = |i: usize| is_short(i) && group_length[groups.root(i)] < limit;
    let is_speck: Vec<bool> = (0..runs.len()).map(is_speck).collect();
    let is_all_there_is = runs.iter().zip(&is_speck).all(|(run, &speck)| speck || !run.visible);
    if is_all_there_is { vec![false; runs.len()] } else { is_speck }
}

/// Visits the cells along a run, at steps of half a cell, some more than once.
fn for_each_cell(run: &Run, mut visit: impl FnMut([i64; 2])) {
    let next = run.points.iter().cycle().skip(1);
    for ((&a, &b), _) in run.points.iter().zip(next).zip(&run.segments) {
        let steps = (a.distance(b) / (0.5 * CELL)).ceil().max(1.0);
        for step in (0..).map(f64::from).take_while(|&step| step <= steps) {
            let cell = (a.lerp(b, step / steps) / CELL).floor();
            #[expect(clippy::cast_possible_truncation, reason = "whole, and within the page")]
            visit([cell.x as i64, cell.y as i64]);
        }
    }
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::EdgeId;
    use glam::DVec2;

    use super::*;
    use crate::Segment;

    fn run(points: &[[f64; 2]], visible: bool) -> Run {
        Run {
            points: points.iter().map(|&p| DVec2::from_array(p)).collect(),
            segments: vec![
                Segment { ends: [0, 1], faces: [0, 0], edge: Some(EdgeId(0)) };
                points.len() - 1
            ],
            closed: false,
            visible,
            label: None,
        }
    }

    /// Beside a long line, so that not all is short.
    #[track_caller]
    fn check(runs: &[Run], expected: &[bool]) {
        let long = run(&[[0.0, 500.0], [500.0, 500.0]], true);
        let found = specks(&runs.iter().chain([&long]).collect::<Vec<_>>(), 4.0);
        assert_eq!(found[..runs.len()], *expected);
        assert!(!found[runs.len()]);
    }

    #[test]
    fn a_short_run_alone_is_a_speck() {
        check(&[], &[]);
        check(&[run(&[[5.0, 5.0], [7.0, 5.0]], true)], &[true]);
        check(&[run(&[[5.0, 5.0], [9.0, 5.0]], true)], &[false]);
        check(&[run(&[[5.0, 5.0], [7.0, 5.0]], false)], &[false]);
    }

    #[test]
    fn a_small_picture_is_kept() {
        let (seen, hidden) =
            (run(&[[5.0, 5.0], [7.0, 5.0]], true), run(&[[9.0, 5.0], [99.0, 5.0]], false));
        assert_eq!(specks(&[&seen, &hidden], 4.0), [false, false]);
    }

    #[test]
    fn short_runs_that_make_a_line_are_none() {
        let dash = |x: f64| run(&[[x, 5.5], [x + 1.5, 5.5]], true);
        check(&[dash(0.0), dash(2.0)], &[true, true]);
        check(&[dash(0.0), dash(2.0), dash(4.0)], &[false, false, false]);
        check(&[dash(0.0), dash(5.0), dash(10.0)], &[true, true, true]);
    }

    #[test]
    fn a_short_run_at_a_long_one_is_none() {
        let tick = run(&[[50.0, 5.0], [50.0, 3.5]], true);
        check(&[run(&[[0.0, 5.0], [100.0, 5.0]], true), tick.clone()], &[false, false]);
        check(&[run(&[[0.0, 8.0], [100.0, 8.0]], true), tick.clone()], &[false, true]);
        check(&[run(&[[0.0, 5.0], [100.0, 5.0]], false), tick], &[false, true]);
    }
}
