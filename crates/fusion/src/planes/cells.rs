//! Parts of the space of planes that are worked on one by one.

use std::ops::Range;

/// Splits the numbers of `places` into cells of at most `most`, each as compact as can be: the
/// longest side is cut, `share` of the way through its places in their order. The same places
/// always give the same cells.
pub(crate) fn split(places: &[[f32; 4]], most: usize, share: f64) -> (Vec<u32>, Vec<Range<usize>>) {
    #[expect(clippy::cast_possible_truncation, reason = "edges are numbered by u32")]
    let mut order: Vec<u32> = (0..places.len() as u32).collect();
    let cells = cut(places, &mut order, most.max(1), share);
    let mut start = 0;
    let ranges = cells.into_iter().map(|length| {
        start += length;
        start - length..start
    });
    let ranges = ranges.collect();
    (order, ranges)
}

/// Lengths of the cells.
fn cut(places: &[[f32; 4]], order: &mut [u32], most: usize, share: f64) -> Vec<usize> {
    if order.len() <= most {
        return if order.is_empty() { Vec::new() } else { vec![order.len()] };
    }
    let side = longest_side(places, order);
    let place = |number: u32| places[number as usize][side];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
    let middle = ((share * order.len() as f64) as usize).clamp(1, order.len() - 1);
    order.select_nth_unstable_by(middle, |&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
    let (low, high) = order.split_at_mut(middle);
    let (mut low, high) =
        rayon::join(|| cut(places, low, most, share), || cut(places, high, most, share));
    low.extend(high);
    low
}

fn longest_side(places: &[[f32; 4]], order: &[u32]) -> usize {
    let mut least = [f32::MAX; 4];
    let mut most = [f32::MIN; 4];
    for &number in order {
        let place = places[number as usize];
        for side in 0..4 {
            least[side] = least[side].min(place[side]);
            most[side] = most[side].max(place[side]);
        }
    }
    (0..4).fold(
        0,
        |best, side| {
            if most[side] - least[side] > most[best] - least[best] { side } else { best }
        },
    )
}
