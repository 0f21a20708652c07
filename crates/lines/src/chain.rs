//! Segments joined into polylines.

use drypoint_mesh::EdgeId;
use glam::DVec3;

use crate::Segment;

/// At a point of more lines than this all of them end: the pairs to compare grow as the square.
const MAX_PAIRED: usize = 32;

/// A polyline of segments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// The segments along the line, each in the direction of the chain: from where the one before it
    /// ends.
    pub segments: Vec<Segment>,
    /// The last segment ends where the first one starts.
    pub closed: bool,
}

/// Joins `segments` at equal ends, each into exactly one chain. `position` says where an end is, as
/// [`Segments::position`](crate::Segments::position) does.
///
/// Two lines that meet are one. Where more meet, the straightest pair in space continues, then the
/// straightest of what is left; ties go to the lowest edge id, or to the lowest faces. Chains are
/// ordered by their lowest edge or faces and run the way that segment does. Where more than 32 lines
/// meet, all end. Linear but for a sort.
pub fn chain(position: impl Fn(u32) -> DVec3, segments: &[Segment]) -> Vec<Chain> {
    let links = links(position, segments);
    let mut order: Vec<usize> = (0..segments.len()).collect();
    order.sort_by_key(|&segment| rank(&segments[segment]));
    let mut used = vec![false; segments.len()];
    let mut chains = Vec::new();
    for first in order {
        if used[first] {
            continue;
        }
        // Back to where the line starts; a closed one comes round to where it is.
        let mut start = End { segment: first, at: 0 };
        let closed = loop {
            match links[start.index()] {
                None => break false,
                Some(previous) if previous == (End { segment: first, at: 1 }) => break true,
                Some(previous) => start = previous.other(),
            }
        };
        if closed {
            start = End { segment: first, at: 0 };
        }
        let mut line = Vec::new();
        let mut end = Some(start);
        while let Some(End { segment, at }) = end {
            let Segment { ends, .. } = segments[segment];
            used[segment] = true;
            line.push(Segment { ends: [ends[at], ends[1 - at]], ..segments[segment] });
            end = links[End { segment, at }.other().index()].filter(|&next| next != start);
        }
        chains.push(Chain { segments: line, closed });
    }
    chains
}

/// What decides between segments.
fn rank(segment: &Segment) -> (Option<EdgeId>, [u32; 2]) {
    (segment.edge, segment.faces)
}

/// One end of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct End {
    segment: usize,
    /// 0 or 1, as in [`Segment::ends`].
    at: usize,
}

impl End {
    fn index(self) -> usize {
        2 * self.segment + self.at
    }

    fn other(self) -> Self {
        Self { at: 1 - self.at, ..self }
    }
}

/// For each end of each segment the end that it continues at.
fn links(position: impl Fn(u32) -> DVec3, segments: &[Segment]) -> Vec<Option<End>> {
    let mut ends: Vec<End> =
        (0..segments.len()).flat_map(|segment| [0, 1].map(|at| End { segment, at })).collect();
    let point = |end: &End| segments[end.segment].ends[end.at];
    ends.sort_by_key(|end| (point(end), rank(&segments[end.segment]), end.at));
    let mut links = vec![None; ends.len()];
    let mut link = |a: End, b: End| {
        links[a.index()] = Some(b);
        links[b.index()] = Some(a);
    };
    for around in ends.chunk_by(|a, b| point(a) == point(b)) {
        match around {
            [a, b] => link(*a, *b),
            _ if around.len() > MAX_PAIRED => {}
            _ => pair_straightest(&position, segments, around, &mut link),
        }
    }
    links
}

/// Pairs the ends at one point, straightest first.
fn pair_straightest(
    position: impl Fn(u32) -> DVec3,
    segments: &[Segment],
    around: &[End],
    mut link: impl FnMut(End, End),
) {
    let leaving = |end: &End| -> DVec3 {
        let ends = segments[end.segment].ends;
        let [here, there] = [ends[end.at], ends[1 - end.at]].map(&position);
        (there - here).normalize_or_zero()
    };
    let directions: Vec<DVec3> = around.iter().map(leaving).collect();
    let mut pairs: Vec<(f64, usize, usize)> = (0..around.len())
        .flat_map(|i| (i + 1..around.len()).map(move |j| (i, j)))
        .map(|(i, j)| (directions[i].dot(directions[j]), i, j))
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut paired = vec![false; around.len()];
    for (_, i, j) in pairs {
        if !paired[i] && !paired[j] {
            (paired[i], paired[j]) = (true, true);
            link(around[i], around[j]);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Positions around a circle, so that no two directions are the same.
    fn around(point: u32) -> DVec3 {
        let angle = f64::from(point) * 2.4;
        DVec3::new(angle.cos(), angle.sin(), 0.1 * f64::from(point))
    }

    fn segments(ends: &[[u32; 2]]) -> Vec<Segment> {
        let along = |(i, &ends): (u32, &[u32; 2])| Segment {
            ends,
            faces: [i, 100 - i],
            edge: Some(EdgeId(10 * i)),
        };
        (0..).zip(ends).map(along).collect()
    }

    /// The points along a chain; a closed one names the first no second time.
    fn points(chain: &Chain) -> Vec<u32> {
        let mut points: Vec<u32> = chain.segments.iter().map(|s| s.ends[0]).collect();
        for (segment, next) in chain.segments.iter().zip(&points[1..]) {
            assert_eq!(segment.ends[1], *next, "a chain has a gap");
        }
        let end = chain.segments.last().unwrap().ends[1];
        if chain.closed {
            assert_eq!(end, points[0]);
        } else {
            points.push(end);
        }
        points
    }

    #[track_caller]
    fn check(position: impl Fn(u32) -> DVec3, ends: &[[u32; 2]], expected: &[(&[u32], bool)]) {
        let chains = chain(position, &segments(ends));
        let found: Vec<_> = chains.iter().map(|chain| (points(chain), chain.closed)).collect();
        let expected: Vec<_> = expected.iter().map(|(p, closed)| (p.to_vec(), *closed)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn lines_are_joined_and_rings_closed() {
        check(around, &[], &[]);
        check(around, &[[3, 1]], &[(&[3, 1], false)]);
        check(around, &[[1, 2], [0, 1], [3, 2]], &[(&[0, 1, 2, 3], false)]);
        check(around, &[[1, 2], [0, 2], [1, 0]], &[(&[1, 2, 0], true)]);
        check(around, &[[0, 1], [4, 5], [2, 1]], &[(&[0, 1, 2], false), (&[4, 5], false)]);
    }

    #[test]
    fn the_straightest_line_goes_on() {
        let at = |x, y| DVec3::new(x, y, 0.0);
        let cross = [at(0.0, 0.0), at(1.0, 0.0), at(-1.0, 0.1), at(0.0, 1.0), at(0.1, -1.0)];
        let cross = |point: u32| cross[point as usize];
        let spokes = [[0, 1], [0, 3], [0, 2], [4, 0]];
        check(cross, &spokes, &[(&[2, 0, 1], false), (&[4, 0, 3], false)]);
        check(cross, &spokes[..3], &[(&[2, 0, 1], false), (&[0, 3], false)]);
    }

    #[test]
    fn at_a_hub_of_very_many_lines_all_end() {
        let spokes: Vec<[u32; 2]> = (1..40).map(|i| [0, i]).collect();
        assert_eq!(chain(around, &segments(&spokes)).len(), 39);
        assert_eq!(chain(around, &segments(&spokes[..32])).len(), 16);
    }

    proptest! {
        #[test]
        fn every_segment_is_in_one_chain(
            ends in proptest::collection::btree_set((0u32..12, 0u32..12), 0..50),
            turned in any::<u64>(),
        ) {
            let edges = ends.into_iter().filter(|(a, b)| a < b).enumerate();
            let ends: Vec<_> =
                edges.map(|(i, (a, b))| if turned >> i & 1 == 1 { [b, a] } else { [a, b] }).collect();
            let segments = segments(&ends);
            let chains = chain(around, &segments);
            let mut found = Vec::new();
            for chain in &chains {
                prop_assert!(!chain.closed || chain.segments.len() > 2);
                found.extend(chain.segments.iter().copied());
            }
            let sorted = |segments: &[Segment]| {
                let mut all: Vec<_> = segments
                    .iter()
                    .map(|&Segment { ends: [a, b], edge, .. }| (edge, a.min(b), a.max(b)))
                    .collect();
                all.sort_unstable();
                all
            };
            prop_assert_eq!(sorted(&found), sorted(&segments));
            // Below the limit, at most one line ends at a vertex for want of a partner.
            let mut ending = [0; 12];
            for chain in chains.iter().filter(|chain| !chain.closed) {
                let along = points(chain);
                ending[along[0] as usize] += 1;
                ending[along[along.len() - 1] as usize] += 1;
            }
            prop_assert!(ending.iter().all(|&count| count < 2));
            // The order of the input is no order of the output.
            let mut reversed = segments.clone();
            reversed.reverse();
            prop_assert_eq!(super::chain(around, &reversed), chains);
        }
    }
}
