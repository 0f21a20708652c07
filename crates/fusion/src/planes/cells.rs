//! Parts of the space of planes that are worked on one by one.

use std::ops::Range;

/// A place, and whose it is: side by side, since cutting looks at them again and again.
#[derive(Clone, Copy)]
struct Placed {
    place: [f32; 4],
    number: u32,
}

/// Splits the numbers of `places` into cells of at most `most`, each as compact as can be: the
/// longest side is cut, `share` of the way through its places in their order. The same places
/// always give the same cells.
pub(crate) fn split(places: &[[f32; 4]], most: usize, share: f64) -> (Vec<u32>, Vec<Range<usize>>) {
    let mut placed: Vec<Placed> =
        (0..).zip(places).map(|(number, &place)| Placed { place, number }).collect();
    let cells = cut(&mut placed, most.max(1), share);
    let mut start = 0;
    let ranges = cells.into_iter().map(|length| {
        start += length;
        start - length..start
    });
    let ranges = ranges.collect();
    (placed.into_iter().map(|placed| placed.number).collect(), ranges)
}

/// Lengths of the cells.
fn cut(placed: &mut [Placed], most: usize, share: f64) -> Vec<usize> {
    if placed.len() <= most {
        return if placed.is_empty() { Vec::new() } else { vec![placed.len()] };
    }
    let side = longest_side(placed);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share")]
    let middle = ((share * placed.len() as f64) as usize).clamp(1, placed.len() - 1);
    let key = |placed: &Placed| placed.place[side];
    placed.select_nth_unstable_by(middle, |a, b| {
        key(a).total_cmp(&key(b)).then(a.number.cmp(&b.number))
    });
    let (low, high) = placed.split_at_mut(middle);
    let (mut low, high) = rayon::join(|| cut(low, most, share), || cut(high, most, share));
    low.extend(high);
    low
}

fn longest_side(placed: &[Placed]) -> usize {
    let mut least = [f32::MAX; 4];
    let mut most = [f32::MIN; 4];
    for Placed { place, .. } in placed {
        // Not `min` and `max`, which heed NaN and take four times as long.
        for side in 0..4 {
            least[side] = if place[side] < least[side] { place[side] } else { least[side] };
            most[side] = if place[side] > most[side] { place[side] } else { most[side] };
        }
    }
    (0..4).fold(
        0,
        |best, side| {
            if most[side] - least[side] > most[best] - least[best] { side } else { best }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_in_one_small_cell() {
        let places: Vec<[f32; 4]> = (0..1000u16)
            .map(|i| [f32::from(i * 37 % 101), f32::from(i % 7), 0.5, f32::NAN])
            .collect();
        let (mut order, ranges) = split(&places, 16, 0.4);
        assert!(ranges.iter().all(|range| (1..=16).contains(&range.len())));
        let ends: Vec<usize> = ranges.iter().map(|range| range.end).collect();
        let starts: Vec<usize> = ranges.iter().map(|range| range.start).collect();
        assert_eq!(starts[1..], ends[..ends.len() - 1]);
        assert_eq!((starts[0], ends.last()), (0, Some(&1000)));
        order.sort_unstable();
        assert!(order.into_iter().eq(0..1000));
        assert_eq!(split(&[], 16, 0.4), (Vec::new(), Vec::new()));
    }
}
