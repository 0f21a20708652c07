//! Everything that is on the page, and how to ink it.

use drypoint_mesh::Mesh;
use glam::{DVec2, DVec3};
#[cfg(feature = "visibility")]
use rayon::prelude::*;

use crate::specks::specks;
use crate::trace;
use crate::{Camera, Chain, Color, Label, LineClass, Page, Run, Segments, VisibilityParams, chain};

/// The lines of one view, projected, by class.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The paper.
    pub page: Page,
    /// One entry per [`LineClass`], in the order of [`LineClass::ALL`].
    pub layers: Vec<Layer>,
    /// Under the lines, in the order in which they are inked.
    pub areas: Vec<Area>,
    /// What runs belong to: of [`Drawing::label`].
    pub labels: Vec<Label>,
}

/// The lines of one class.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What they are.
    pub class: LineClass,
    /// Polylines on the mesh.
    pub chains: usize,
    /// Edges in them, or pairs of faces that cross.
    pub segments: usize,
    /// What of them is on the page, visible or hidden, chain by chain.
    pub runs: Vec<Run>,
}

impl Layer {
    /// Pixels of line that nothing hides.
    pub fn visible_length(&self) -> f64 {
        self.length(true)
    }

    /// Pixels of line on the page that is hidden.
    pub fn hidden_length(&self) -> f64 {
        self.length(false)
    }

    fn length(&self, visible: bool) -> f64 {
        // From 0.0, because the sum of nothing is -0.
        self.runs
            .iter()
            .filter(|run| run.visible == visible)
            .fold(0.0, |sum, run| sum + run.length())
    }
}

impl Drawing {
    /// Chains and projects `segments`, which are lines of `mesh`. Nothing hides anything: a view
    /// through glass.
    pub fn through_glass(mesh: &Mesh, segments: &Segments, camera: &Camera) -> Self {
        // A single sample per segment, which sees everything.
        let params =
            VisibilityParams { step: f64::INFINITY, drop_specks: 0.0, ..Default::default() };
        let position = |end| segments.position(mesh, end);
        Self::trace(segments, camera, &params, position, |chains| {
            let seen = |chain| trace::runs(position, chain, camera, &params, &mut |_, _| false);
            chains.iter().flat_map(seen).collect()
        })
    }

    /// Chains and projects `segments`, and finds what of them is visible, on all threads. About two
    /// lines of sight per segment and one per pixel, of a microsecond or two each.
    #[cfg(feature = "visibility")]
    pub fn new(
        occluders: &crate::Occluders<'_>,
        segments: &Segments,
        camera: &Camera,
        params: &VisibilityParams,
    ) -> Self {
        let position = |end| segments.position(occluders.mesh(), end);
        Self::trace(segments, camera, params, position, |chains| {
            let sightlines = || occluders.sightlines(camera.viewpoint());
            let runs = chains.par_iter().map_init(sightlines, |sightlines, chain| {
                trace::runs(position, chain, camera, params, &mut |segment, fraction| {
                    sightlines.set_segment(segment.ends, segment.ends.map(position));
                    sightlines.is_hidden(fraction)
                })
            });
            runs.collect::<Vec<_>>().into_iter().flatten().collect()
        })
    }

    fn trace(
        segments: &Segments,
        camera: &Camera,
        params: &VisibilityParams,
        position: impl Fn(u32) -> DVec3 + Copy,
        runs_of: impl Fn(&[Chain]) -> Vec<Run>,
    ) -> Self {
        let mut layers = LineClass::ALL.map(|class| {
            let segments = segments.of(class);
            let chains = chain(position, segments);
            let runs = runs_of(&chains);
            Layer { class, chains: chains.len(), segments: segments.len(), runs }
        });
        let runs: Vec<&Run> = layers.iter().flat_map(|layer| &layer.runs).collect();
        let mut is_speck = specks(&runs, params.drop_specks).into_iter();
        for layer in &mut layers {
            layer.runs.retain(|_| !is_speck.next().unwrap_or(false));
        }
        let page = camera.page();
        Self { page, layers: layers.into(), areas: Vec::new(), labels: Vec::new() }
    }

    /// The layers and runs in the order in which they are inked: hidden lines first, and of
    /// the classes the last first, so that contours are on top.
    #[cfg(any(feature = "svg", feature = "png"))]
    pub(crate) fn inked(&self, style: &Style) -> impl Iterator<Item = (&Layer, bool, Vec<&Run>)> {
        let hidden = (style.hidden != HiddenLines::None).then_some(false);
        hidden
            .into_iter()
            .chain([true])
            .flat_map(|visible| self.layers.iter().rev().map(move |layer| (layer, visible)))
            .map(|(layer, visible)| {
                (layer, visible, layer.runs.iter().filter(|r| r.visible == visible).collect())
            })
    }
}

/// How to ink areas that have it in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Tint {
    /// A word for scripts: the class of its area in an SVG.
    pub name: String,
    /// Of the area.
    pub color: Color,
    /// Pixels by which the area is drawn larger than it is, at least 0, to be seen where it is
    /// narrow.
    pub spread: f64,
}

#[cfg(any(feature = "svg", feature = "png"))]
impl Tint {
    /// Width of the stroke along the outlines: at least so much that no paper shines through between
    /// two areas.
    pub(crate) fn outline(&self) -> f64 {
        2.0 * self.spread.max(0.25)
    }
}

/// All that is visible of one tint.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// How to ink it.
    pub tint: Tint,
    /// Closed outlines in pixels from the upper left corner of the page, y down, in hundredths. Outer
    /// ones and holes run in opposite directions, so that either fill rule gives the same.
    pub rings: Vec<Vec<DVec2>>,
}

/// How to ink a [`Drawing`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Stroke width in pixels, above 0. Hidden lines are half as wide.
    pub width: f64,
    /// Of the lines.
    pub color: Color,
    /// Fills the page. `None` is what the medium has: nothing behind an SVG, white in a PNG.
    pub background: Option<Color>,
    /// What to do with hidden lines.
    pub hidden: HiddenLines,
}

impl Default for Style {
    fn default() -> Self {
        Self { width: 1.5, color: Color::BLACK, background: None, hidden: HiddenLines::None }
    }
}

/// What to do with lines that are hidden.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HiddenLines {
    /// They are not drawn.
    #[default]
    None,
    /// Dashed, 4 stroke widths on and 3 off.
    Dashed,
    /// As thin lines.
    Solid,
}

#[cfg(any(feature = "svg", feature = "png"))]
impl Style {
    /// Stroke width of visible or of hidden lines.
    pub(crate) fn width_of(&self, visible: bool) -> f64 {
        if visible { self.width } else { 0.5 * self.width }
    }

    /// Lengths of dash and gap, if there are any.
    pub(crate) fn dashes(&self, visible: bool) -> Option<[f64; 2]> {
        let dashed = !visible && self.hidden == HiddenLines::Dashed;
        dashed.then(|| [4.0, 3.0].map(|widths| widths * self.width))
    }
}
