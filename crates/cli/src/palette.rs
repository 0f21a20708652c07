//! Colours that tell neighbours apart, the same for the same patches.

use drypoint_lines::Color;

/// Hues in a row, in turns, that come to lie far from those before: the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A colour as the eye measures it.
#[derive(Clone, Copy, Debug)]
struct Shade {
    lightness: f64,
    chroma: f64,
    /// In turns.
    hue: f64,
}

impl Shade {
    /// Lightness and the two opponent axes, in which distances are as they look.
    fn place(self) -> [f64; 3] {
        let (sin, cos) = (std::f64::consts::TAU * self.hue).sin_cos();
        [self.lightness, self.chroma * cos, self.chroma * sin]
    }

    fn distance(self, other: Self) -> f64 {
        let (a, b) = (self.place(), other.place());
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
    }

    #[expect(clippy::cast_possible_truncation, reason = "a colour has a few digits")]
    fn color(self) -> Color {
        let turn = (std::f64::consts::TAU * self.hue) as f32;
        let (lightness, chroma) = (self.lightness as f32, self.chroma as f32);
        let color = csscolorparser::Color::from_oklcha(lightness, chroma, turn, 1.0);
        let [red, green, blue, _] = color.to_rgba8();
        Color::opaque(red, green, blue)
    }
}

/// What a patch may look like: any hue, or with a family one of its own.
fn candidates(family: Option<usize>) -> Vec<Shade> {
    const LIGHTNESS: [f64; 3] = [0.62, 0.72, 0.82];
    let hues: Vec<f64> = match family {
        None => (0..16).map(|i| f64::from(i) / 16.0).collect(),
        Some(family) => {
            let hue = (GOLDEN * family as f64).fract();
            [-0.03, 0.0, 0.03].map(|turn| hue + turn).into()
        }
    };
    let shades = |hue: f64| LIGHTNESS.map(|lightness| Shade { lightness, chroma: 0.12, hue });
    hues.into_iter().flat_map(shades).collect()
}

/// A colour for each of `families`, which is `None` for any hue; `neighbors` are pairs of indices.
///
/// In order, each takes what is farthest from the colours its neighbours have already.
pub(crate) fn colors(families: &[Option<usize>], neighbors: &[[u32; 2]]) -> Vec<Color> {
    let mut before: Vec<Vec<u32>> = vec![Vec::new(); families.len()];
    for [a, b] in neighbors {
        before[*a.max(b) as usize].push(*a.min(b));
    }
    let mut shades: Vec<Shade> = Vec::with_capacity(families.len());
    for (index, (family, taken)) in families.iter().zip(&before).enumerate() {
        let candidates = candidates(*family);
        // Where several are as good, or none is taken, each begins elsewhere.
        let turned = candidates.iter().cycle().skip(7 * index % candidates.len());
        let turned = turned.take(candidates.len());
        let apart = |shade: &Shade| {
            let distances = taken.iter().map(|&other| shade.distance(shades[other as usize]));
            // What is far enough is not looked for farther.
            distances.fold(0.02, f64::min)
        };
        let mut best = (f64::NEG_INFINITY, candidates[0]);
        for shade in turned {
            let distance = apart(shade);
            if distance > best.0 {
                best = (distance, *shade);
            }
        }
        shades.push(best.1);
    }
    shades.into_iter().map(Shade::color).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbors_differ() {
        // Each touches the four before it.
        let neighbors: Vec<[u32; 2]> = (0..60u32)
            .flat_map(|i| (1..5).map(move |k| [i, i + k]))
            .filter(|p| p[1] < 60)
            .collect();
        for families in [vec![None; 60], (0..60).map(|i| Some(i / 10)).collect()] {
            let colors = colors(&families, &neighbors);
            let far = |[a, b]: &[u32; 2]| {
                let [a, b] = [a, b].map(|&i| colors[i as usize]);
                let parts = [(a.red, b.red), (a.green, b.green), (a.blue, b.blue)];
                parts.iter().map(|(a, b)| u32::from(a.abs_diff(*b))).sum::<u32>() > 20
            };
            assert!(neighbors.iter().all(far));
        }
    }

    #[test]
    fn nothing_has_no_colors() {
        assert_eq!(colors(&[], &[]), []);
    }
}
