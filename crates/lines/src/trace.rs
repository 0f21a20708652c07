//! Chains to runs: what of a chain is on the page, and what of that is visible.

use glam::{DVec2, DVec3};

use crate::camera::Clipped;
use crate::{Camera, Chain, Segment};

/// Most samples of a segment, whatever the step: a bad parameter costs time, but ends.
const MAX_SAMPLES: f64 = 1e6;

/// Pixels below which bisection would run out of bits.
const MIN_PRECISION: f64 = 1e-6;

/// How finely visibility is found and how its noise is cleaned, all in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilityParams {
    /// Longest distance between samples along a line, above 0. What hides less of a line than this
    /// can be missed. The cost of long lines goes with its inverse.
    pub step: f64,
    /// How exactly the ends of visible runs are found, above 0. Halving it costs one more line of
    /// sight per end.
    pub precision: f64,
    /// Shorter hidden stretches between visible ones of one chain are drawn, 0 or more. They are
    /// the width of a hair, where a contour passes behind a fold of its own surface.
    pub close_gaps: f64,
    /// Visible runs shorter than this, alone or in sum with those they touch, are not drawn unless
    /// they touch a longer one or are all that is visible; 0 or more. They are true contours of the
    /// noise of scanned surfaces.
    pub drop_specks: f64,
}

impl Default for VisibilityParams {
    fn default() -> Self {
        Self { step: 1.0, precision: 0.005, close_gaps: 0.75, drop_specks: 6.0 }
    }
}

/// A stretch of a chain on the page, all of it visible or all of it hidden.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Pixels from the upper left corner of the page, y down. At least two.
    pub points: Vec<DVec2>,
    /// The segment between each point and the next, in the direction of the run; of a closed run also
    /// from the last to the first.
    pub segments: Vec<Segment>,
    /// The last point is joined to the first.
    pub closed: bool,
    /// Nothing is in front of it.
    pub visible: bool,
    /// What it belongs to, as an index into [`Drawing::labels`](crate::Drawing::labels), if that was
    /// asked for.
    pub label: Option<u32>,
}

impl Run {
    /// Pixels along the run.
    pub fn length(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).zip(&self.segments).map(|((a, b), _)| a.distance(*b)).sum()
    }
}

/// A part of one segment of a chain that is on the page.
struct Piece {
    segment: Segment,
    clipped: Clipped,
    /// Goes on where the piece before ends.
    joined: bool,
}

/// A part of a piece, all of it visible or all of it hidden.
#[derive(Clone, Copy)]
struct Span {
    piece: usize,
    /// Fractions of what of the piece is on the page.
    from: f64,
    to: f64,
    visible: bool,
}

/// Spans of one visibility in a row.
struct Stretch {
    spans: Vec<Span>,
    visible: bool,
    /// Pixels.
    length: f64,
}

/// Answers whether the point at this fraction of a segment is hidden.
pub(crate) type IsHidden<'a> = dyn FnMut(&Segment, f64) -> bool + 'a;

/// The runs of a chain in its order. What is off the page is in none.
pub(crate) fn runs(
    position: impl Fn(u32) -> DVec3,
    chain: &Chain,
    camera: &Camera,
    params: &VisibilityParams,
    is_hidden: &mut IsHidden<'_>,
) -> Vec<Run> {
    let pieces = pieces(position, chain, camera);
    let is_ring = pieces.iter().all(|piece| piece.joined);
    let mut spans = spans(&pieces, params, is_hidden);
    if is_ring {
        let turn = (1..spans.len()).find(|&i| spans[i].visible != spans[i - 1].visible);
        spans.rotate_left(turn.unwrap_or(0));
    }
    let mut runs = Vec::new();
    let starts = |span: &Span| span.from == 0.0 && !pieces[span.piece].joined;
    for strand in spans.chunk_by(|_, next| !starts(next)) {
        let mut stretches = close_gaps(stretches(&pieces, strand), is_ring, params.close_gaps);
        let closed = is_ring && stretches.len() == 1;
        if closed {
            // Where a gap was closed the ring may start within an edge.
            let spans = &mut stretches[0].spans;
            let start = spans.iter().position(|span| span.from == 0.0);
            spans.rotate_left(start.unwrap_or(0));
        }
        runs.extend(stretches.iter().filter_map(|stretch| run(&pieces, stretch, closed)));
    }
    runs
}

/// The parts of the chain's segments that are on the page. All are joined only in a closed chain
/// that is on the page as a whole; else the first is not.
fn pieces(position: impl Fn(u32) -> DVec3, chain: &Chain, camera: &Camera) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::with_capacity(chain.segments.len());
    let mut goes_on = false;
    for &segment in &chain.segments {
        let [a, b] = segment.ends.map(&position);
        let Some(clipped) = camera.clip(a, b) else {
            goes_on = false;
            continue;
        };
        let joined = goes_on && clipped.range[0] == 0.0;
        goes_on = clipped.range[1] == 1.0;
        pieces.push(Piece { segment, clipped, joined });
    }
    if let Some(first) = pieces.first_mut() {
        let is_start = first.segment == chain.segments[0] && first.clipped.range[0] == 0.0;
        first.joined = chain.closed && goes_on && is_start;
    }
    let start = pieces.iter().position(|piece| !piece.joined).unwrap_or(0);
    pieces.rotate_left(start);
    pieces
}

/// Samples each piece and finds where visibility changes.
fn spans(pieces: &[Piece], params: &VisibilityParams, is_hidden: &mut IsHidden<'_>) -> Vec<Span> {
    let precision = params.precision.max(MIN_PRECISION);
    let mut is_hidden_at = |piece: &Piece, on_page: f64| {
        is_hidden(&piece.segment, piece.clipped.fraction_in_space(on_page))
    };
    // First every piece by itself, at the middles of equal steps: never at a vertex, where what
    // hides the line is a matter of the direction one comes from.
    let mut samples: Vec<Vec<(f64, bool)>> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let count = (piece.clipped.length() / params.step).ceil().clamp(1.0, MAX_SAMPLES);
        let middles = (0..).map(|i| (f64::from(i) + 0.5) / count).take_while(|&s| s < 1.0);
        samples.push(middles.map(|s| (s, is_hidden_at(piece, s))).collect());
    }
    let last_of = |piece: usize| samples[piece].last().map(|s| s.1);
    let first_of = |piece: usize| samples[piece].first().map(|s| s.1);
    let count = pieces.len();
    let before = |i: usize| pieces[i].joined.then(|| last_of((i + count - 1) % count)).flatten();
    let after = |i: usize| {
        let next = (i + 1) % count;
        pieces[next].joined.then(|| first_of(next)).flatten()
    };
    let mut spans = Vec::with_capacity(count);
    for (index, piece) in pieces.iter().enumerate() {
        let length = piece.clipped.length();
        let mut ticks = samples[index].clone();
        // Then near the vertices where the next piece says otherwise, and at ends of the line.
        let near = (0.5 * precision / length).min(0.1 / ticks.len() as f64);
        if before(index) != first_of(index) {
            ticks.insert(0, (near, is_hidden_at(piece, near)));
        }
        if after(index) != last_of(index) {
            ticks.push((1.0 - near, is_hidden_at(piece, 1.0 - near)));
        }
        let mut from = 0.0;
        for pair in ticks.windows(2) {
            let [(mut low, hidden), (mut high, then)] = [pair[0], pair[1]];
            if hidden == then {
                continue;
            }
            while (high - low) * length > precision {
                let middle = 0.5 * (low + high);
                if is_hidden_at(piece, middle) == hidden { low = middle } else { high = middle }
            }
            let to = 0.5 * (low + high);
            spans.push(Span { piece: index, from, to, visible: !hidden });
            from = to;
        }
        let visible = ticks.last().is_none_or(|last| !last.1);
        spans.push(Span { piece: index, from, to: 1.0, visible });
    }
    spans
}

/// Groups spans in a row by visibility.
fn stretches(pieces: &[Piece], spans: &[Span]) -> Vec<Stretch> {
    let length = |span: &Span| (span.to - span.from) * pieces[span.piece].clipped.length();
    let group = |spans: &[Span]| Stretch {
        visible: spans[0].visible,
        length: spans.iter().map(length).sum(),
        spans: spans.to_vec(),
    };
    spans.chunk_by(|a, b| a.visible == b.visible).map(group).collect()
}

/// Closes gaps. The last stretch of a ring is followed by the first.
fn close_gaps(mut stretches: Vec<Stretch>, is_ring: bool, limit: f64) -> Vec<Stretch> {
    let count = stretches.len();
    // Neighbours differ, so whatever has one on either side lies between its opposites.
    let is_between = |i: usize| if is_ring { count > 1 } else { 0 < i && i + 1 < count };
    for (i, stretch) in stretches.iter_mut().enumerate() {
        stretch.visible |= stretch.length < limit && is_between(i);
    }
    let mut merged: Vec<Stretch> = Vec::with_capacity(count);
    for stretch in stretches {
        match merged.last_mut() {
            Some(last) if last.visible == stretch.visible => last.append(stretch),
            _ => merged.push(stretch),
        }
    }
    if is_ring
        && merged.len() > 1
        && merged[0].visible == merged[merged.len() - 1].visible
        && let Some(mut last) = merged.pop()
    {
        std::mem::swap(&mut last, &mut merged[0]);
        merged[0].append(last);
    }
    merged
}

impl Stretch {
    fn append(&mut self, next: Self) {
        self.spans.extend(next.spans);
        self.length += next.length;
    }
}

/// The points of a stretch; none if it is a single point on the page.
fn run(pieces: &[Piece], stretch: &Stretch, closed: bool) -> Option<Run> {
    let at = |piece: usize, s: f64| {
        let [a, b] = pieces[piece].clipped.page;
        a.lerp(b, s)
    };
    let first = stretch.spans.first()?;
    let mut run = Run {
        points: vec![at(first.piece, first.from)],
        segments: vec![],
        closed,
        visible: stretch.visible,
        label: None,
    };
    for spans in stretch.spans.chunk_by(|a, b| a.piece == b.piece) {
        let last = &spans[spans.len() - 1];
        run.points.push(at(last.piece, last.to));
        run.segments.push(pieces[last.piece].segment);
    }
    if closed {
        run.points.pop();
    }
    (run.length() > 0.0).then_some(run)
}
