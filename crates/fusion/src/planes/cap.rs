//! The smallest cap around unit normals, known by the two or three that hold it up.

use glam::Vec3;

/// A cap of the unit sphere, and the normals on its rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cap {
    /// Unit length, up to rounding.
    pub(crate) axis: Vec3,
    /// Square of the chord from the axis to the rim: 2 − 2 cos α, without its cancellation.
    pub(crate) chord_squared: f32,
    support: [Vec3; 3],
    count: u8,
}

impl Cap {
    /// A cap that holds one direction.
    pub(crate) fn of(normal: Vec3) -> Self {
        Self { axis: normal, chord_squared: 0.0, support: [normal; 3], count: 1 }
    }

    /// The smallest cap that holds two; `None` if they are opposite.
    pub(crate) fn of_two(a: Vec3, b: Vec3) -> Option<Self> {
        let axis = (a + b).try_normalize()?;
        let chord_squared = a.distance_squared(axis).max(b.distance_squared(axis));
        Some(Self { axis, chord_squared, support: [b, a, a], count: 2 })
    }

    /// This, reaching as far as that.
    pub(crate) fn reaching(self, chord_squared: f32) -> Self {
        Self { chord_squared, ..self }
    }

    /// One to three normals that hold it up.
    pub(crate) fn support(&self) -> &[Vec3] {
        &self.support[..usize::from(self.count)]
    }

    /// The smallest cap around this one's support and one more normal: of all caps held up by the
    /// new one and one or two others, the one whose axis is nearest to its farthest normal. `None`
    /// if no two or three of them have one axis.
    pub(crate) fn taking_in(&self, normal: Vec3) -> Option<Self> {
        let old = self.support();
        let mut smallest: Option<Self> = None;
        let mut consider = |center: Vec3, support: [Vec3; 3], count: u8| {
            let Some(axis) = center.try_normalize() else { return };
            let farthest = |chord: f32, n: &Vec3| chord.max(n.distance_squared(axis));
            let chord_squared = old.iter().fold(normal.distance_squared(axis), farthest);
            if smallest.is_none_or(|cap| chord_squared < cap.chord_squared) {
                smallest = Some(Self { axis, chord_squared, support, count });
            }
        };
        for (i, &a) in old.iter().enumerate() {
            consider(a + normal, [normal, a, a], 2);
            for &b in &old[i + 1..] {
                consider(circumcenter(normal, a, b), [normal, a, b], 3);
            }
        }
        smallest
    }
}

/// The center of the circle through three points; NaN if they are collinear.
fn circumcenter(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let offset = u.length_squared() * v.cross(normal) + v.length_squared() * normal.cross(u);
    a + offset / (2.0 * normal.length_squared())
}
