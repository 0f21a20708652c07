//! Segments joined into polylines.

use drypoint_mesh::{EdgeId, Mesh};
use glam::DVec3;

use crate::Segment;

/// At a vertex of more lines than this all of them end: the pairs to compare grow as the square.
const MAX_PAIRED: usize = 32;

/// A polyline along edges of the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// Welded vertices along the line: one more than edges, or as many if it is closed.
    pub vertices: Vec<u32>,
    /// The edge from each vertex to the next.
    pub edges: Vec<EdgeId>,
    /// The last edge ends at the first vertex.
    pub closed: bool,
}

impl Chain {
    /// The segments along the line, each in the direction of the chain.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let next = self.vertices.iter().cycle().skip(1);
        let ends = self.vertices.iter().zip(next);
        ends.zip(&self.edges).map(|((&from, &to), &edge)| Segment { ends: [from, to], edge })
    }
}

/// Joins `segments` at equal vertices, each into exactly one chain.
///
/// Two lines that meet at a vertex are one. Where more meet, the straightest pair in space
/// continues, then the straightest of what is left; ties go to the lowest edge id. Chains are
/// ordered by their lowest edge and run the way that edge does. Where more than 32 lines meet, all
/// end. Linear but for a sort.
///
/// # Panics
/// If a vertex is not one of `mesh`.
pub fn chain(mesh: &Mesh, segments: &[Segment]) -> Vec<Chain> {
    let links = links(mesh, segments);
    let mut order: Vec<usize> = (0..segments.len()).collect();
    order.sort_by_key(|&segment| segments[segment].edge);
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
        let mut chain = Chain { vertices: vec![], edges: vec![], closed };
        let mut end = start;
        loop {
            let Segment { ends, edge } = segments[end.segment];
            used[end.segment] = true;
            chain.vertices.push(ends[end.at]);
            chain.edges.push(edge);
            match links[end.other().index()] {
                Some(next) if next != start => end = next,
                Some(_) => break,
                None => {
                    chain.vertices.push(ends[1 - end.at]);
                    break;
                }
            }
        }
        chains.push(chain);
    }
    chains
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
fn links(mesh: &Mesh, segments: &[Segment]) -> Vec<Option<End>> {
    let mut ends: Vec<End> =
        (0..segments.len()).flat_map(|segment| [0, 1].map(|at| End { segment, at })).collect();
    let vertex = |end: &End| segments[end.segment].ends[end.at];
    ends.sort_by_key(|end| (vertex(end), segments[end.segment].edge, end.at));
    let mut links = vec![None; ends.len()];
    let mut link = |a: End, b: End| {
        links[a.index()] = Some(b);
        links[b.index()] = Some(a);
    };
    for around in ends.chunk_by(|a, b| vertex(a) == vertex(b)) {
        match around {
            [a, b] => link(*a, *b),
            _ if around.len() > MAX_PAIRED => {}
            _ => pair_straightest(mesh, segments, around, &mut link),
        }
    }
    links
}

/// Pairs the ends around one vertex, straightest first.
fn pair_straightest(
    mesh: &Mesh,
    segments: &[Segment],
    around: &[End],
    mut link: impl FnMut(End, End),
) {
    let leaving = |end: &End| -> DVec3 {
        let ends = segments[end.segment].ends;
        let [here, there] = [ends[end.at], ends[1 - end.at]].map(|v| mesh.position(v).as_dvec3());
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
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;

    /// Positions around a circle, so that no two directions are the same.
    fn points(count: usize) -> Mesh {
        let angle = |i: usize| i as f32 * 2.4;
        let positions =
            (0..count).map(|i| Vec3::new(angle(i).cos(), angle(i).sin(), i as f32 * 0.1));
        Mesh::new(positions.collect(), vec![]).unwrap()
    }

    fn segments(ends: &[[u32; 2]]) -> Vec<Segment> {
        (0..).zip(ends).map(|(i, &ends)| Segment { ends, edge: EdgeId(10 * i) }).collect()
    }

    #[track_caller]
    fn check(mesh: &Mesh, ends: &[[u32; 2]], expected: &[(&[u32], bool)]) {
        let chains = chain(mesh, &segments(ends));
        let found: Vec<(&[u32], bool)> =
            chains.iter().map(|chain| (&chain.vertices[..], chain.closed)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn lines_are_joined_and_rings_closed() {
        let mesh = points(6);
        check(&mesh, &[], &[]);
        check(&mesh, &[[3, 1]], &[(&[3, 1], false)]);
        check(&mesh, &[[1, 2], [0, 1], [3, 2]], &[(&[0, 1, 2, 3], false)]);
        check(&mesh, &[[1, 2], [0, 2], [1, 0]], &[(&[1, 2, 0], true)]);
        check(&mesh, &[[0, 1], [4, 5], [2, 1]], &[(&[0, 1, 2], false), (&[4, 5], false)]);
    }

    #[test]
    fn the_straightest_line_goes_on() {
        let at = |x, y| Vec3::new(x, y, 0.0);
        let cross = [at(0.0, 0.0), at(1.0, 0.0), at(-1.0, 0.1), at(0.0, 1.0), at(0.1, -1.0)];
        let mesh = Mesh::new(cross.to_vec(), vec![]).unwrap();
        let spokes = [[0, 1], [0, 3], [0, 2], [4, 0]];
        check(&mesh, &spokes, &[(&[2, 0, 1], false), (&[4, 0, 3], false)]);
        check(&mesh, &spokes[..3], &[(&[2, 0, 1], false), (&[0, 3], false)]);
    }

    #[test]
    fn at_a_hub_of_very_many_lines_all_end() {
        let mesh = points(40);
        let spokes: Vec<[u32; 2]> = (1..40).map(|i| [0, i]).collect();
        assert_eq!(chain(&mesh, &segments(&spokes)).len(), 39);
        assert_eq!(chain(&mesh, &segments(&spokes[..32])).len(), 16);
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
            let (mesh, segments) = (points(12), segments(&ends));
            let chains = chain(&mesh, &segments);
            let mut found = Vec::new();
            for chain in &chains {
                let extra = usize::from(!chain.closed);
                prop_assert_eq!(chain.vertices.len(), chain.edges.len() + extra);
                prop_assert!(!chain.closed || chain.edges.len() > 2);
                found.extend(chain.segments());
            }
            // Joints share vertices, because each segment is found with its own ends.
            let sorted = |segments: &[Segment]| {
                let mut all: Vec<_> = segments
                    .iter()
                    .map(|&Segment { ends: [a, b], edge }| (edge, a.min(b), a.max(b)))
                    .collect();
                all.sort_unstable();
                all
            };
            prop_assert_eq!(sorted(&found), sorted(&segments));
            // Below the limit, at most one line ends at a vertex for want of a partner.
            let mut ending = [0; 12];
            for chain in chains.iter().filter(|chain| !chain.closed) {
                ending[chain.vertices[0] as usize] += 1;
                ending[chain.vertices[chain.vertices.len() - 1] as usize] += 1;
            }
            prop_assert!(ending.iter().all(|&count| count < 2));
            // The order of the input is no order of the output.
            let mut reversed = segments.clone();
            reversed.reverse();
            prop_assert_eq!(super::chain(&mesh, &reversed), chains);
        }
    }
}
