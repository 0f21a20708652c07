//! Which lines are drawn, and what they belong to.

use std::collections::BTreeMap;

use clap::{Args, ValueEnum};
use drypoint_lines::{Drawing, FaceNames, Intersections, Layer, LineClass, LineOptions};
use drypoint_mesh::{MeshAdjacency, Viewpoint, io};
use serde::Serialize;

use crate::args::number;
use crate::source::Source;

/// Degrees from which an edge is a crease, unless the user says otherwise.
const CREASE_ANGLE: f64 = 30.0;

/// Classes of lines that are drawn, unless the user says otherwise.
const CLASSES: &[Class] = &[Class::Contour, Class::Boundary];

#[derive(Debug, Args)]
#[command(next_help_heading = "Lines")]
pub(crate) struct LineArgs {
    /// Classes of lines to draw [default: contour,boundary; contour with --method wgpu or ash]
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(crate) lines: Option<Vec<Class>>,
    /// With --lines crease: draw edges that bend by this angle or more, in degrees [default: 30]
    #[arg(long, value_name = "DEGREES", value_parser = number, allow_hyphen_values = true)]
    pub(crate) crease_angle: Option<f64>,
    /// What to do with hidden lines
    #[arg(long, value_enum, default_value = "none")]
    pub(crate) hidden: Hidden,
    /// Leave out visible pieces shorter than this that touch no longer line, in pixels: the noise
    /// of scans. 0 draws all [default: 6; 0 with --method wgpu or ash]
    #[arg(long, value_name = "PIXELS", value_parser = number, allow_hyphen_values = true)]
    pub(crate) specks: Option<f64>,
    /// Width of the lines in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1.5, value_parser = number)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) width: f64,
    /// Color of the lines, as in CSS: black, #1a2b3c, rgb(10 20 30)
    #[arg(long, value_name = "COLOR", default_value = "black")]
    pub(crate) color: String,
    /// Color of the page, as in CSS, or none [default: none in an SVG, white in a PNG]
    #[arg(long, value_name = "COLOR")]
    pub(crate) background: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Class {
    /// Where the surface turns away from the viewer
    Contour,
    /// Where the surface ends
    Boundary,
    /// Where two materials meet
    Material,
    /// Where the surface bends sharply
    Crease,
    /// Where surfaces pass through each other, with no edge there
    Intersection,
    /// All of these
    All,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Hidden {
    /// Left out
    None,
    /// Dashed and thin
    Dashed,
    /// Thin
    Solid,
}

impl LineArgs {
    /// Whether lines of a class are asked for.
    pub(crate) fn holds(&self, class: LineClass) -> bool {
        self.lines.as_deref().unwrap_or(CLASSES).iter().any(|&asked| match asked {
            Class::Contour => class == LineClass::Contour,
            Class::Boundary => class == LineClass::Boundary,
            Class::Material => class == LineClass::Material,
            Class::Crease => class == LineClass::Crease,
            Class::Intersection => class == LineClass::Intersection,
            Class::All => true,
        })
    }

    /// Refuses options of lines that make no sense.
    pub(crate) fn check(&self) -> Result<(), String> {
        match self.crease_angle {
            Some(angle) if !(0.0..=180.0).contains(&angle) => {
                Err(format!("--crease-angle: {angle} is not within 0 and 180"))
            }
            Some(_) if !self.holds(LineClass::Crease) => {
                Err("--crease-angle: no creases are drawn without --lines crease".to_owned())
            }
            _ => Ok(()),
        }
    }
}

/// What of the lines of a model is the same from wherever it is looked at.
#[derive(Debug)]
pub(crate) struct Lines {
    parts: FaceNames,
    materials: FaceNames,
    intersections: Option<Intersections>,
}

impl Lines {
    /// Finds it, without progress: maybe one of many.
    pub(crate) fn new(source: &Source, adjacency: &MeshAdjacency, args: &LineArgs) -> Self {
        let model = &source.model;
        let names = |runs: &[io::Part]| {
            FaceNames::new(runs.iter().map(|run| (run.name.as_str(), run.triangles.clone())))
        };
        let finds = args.holds(LineClass::Intersection);
        Self {
            parts: names(&model.parts),
            materials: names(&model.materials),
            intersections: finds.then(|| Intersections::new(&model.mesh, adjacency)),
        }
    }

    pub(crate) fn options(&self, args: &LineArgs) -> LineOptions<'_> {
        let least = args.crease_angle.unwrap_or(CREASE_ANGLE).to_radians();
        LineOptions {
            boundary: args.holds(LineClass::Boundary),
            crease_angle: args.holds(LineClass::Crease).then_some(least),
            materials: args.holds(LineClass::Material).then_some(&self.materials),
            intersections: self.intersections.as_ref(),
        }
    }

    /// Leaves classes out of a drawing that are not asked for, and names the parts and materials that
    /// lines belong to, if there are any to name.
    pub(crate) fn finish(
        &self,
        drawing: &mut Drawing,
        source: &Source,
        viewpoint: Viewpoint,
        args: &LineArgs,
    ) {
        drawing.layers.retain(|layer| args.holds(layer.class));
        if self.names_owners(source) {
            drawing.label(source.mesh(), viewpoint, &self.parts, &self.materials);
        }
    }

    /// Whether there are parts to tell apart, or names of materials.
    pub(crate) fn names_owners(&self, source: &Source) -> bool {
        source.model.parts.len() > 1 || self.materials.names().len() > 1
    }
}

/// What is on the page of one class of lines, in the shape that scripts read.
#[derive(Debug, Serialize)]
pub(crate) struct Drawn {
    chains: usize,
    segments: usize,
    /// In pixels.
    visible_length: f64,
    /// In pixels.
    hidden_length: f64,
}

/// What is on the page, by class.
pub(crate) fn drawn(drawing: &Drawing) -> BTreeMap<&'static str, Drawn> {
    let count = |layer: &Layer| Drawn {
        chains: layer.chains,
        segments: layer.segments,
        visible_length: layer.visible_length(),
        hidden_length: layer.hidden_length(),
    };
    drawing.layers.iter().map(|layer| (layer.class.name(), count(layer))).collect()
}

/// By the name of a part or a material the pixels of visible line of each class that belong to it.
pub(crate) type Lengths = BTreeMap<String, BTreeMap<&'static str, f64>>;

/// The visible lines of each part and of each material, as far as the drawing says which belong to which.
pub(crate) fn lengths(drawing: &Drawing) -> [Lengths; 2] {
    let (mut of_parts, mut of_materials) = (Lengths::new(), Lengths::new());
    for layer in &drawing.layers {
        for run in layer.runs.iter().filter(|run| run.visible) {
            let Some(label) = drawing.label_of(run) else { continue };
            for (lengths, name) in
                [(&mut of_parts, &label.part), (&mut of_materials, &label.material)]
            {
                let lengths = lengths.entry(name.clone()).or_default();
                *lengths.entry(layer.class.name()).or_default() += run.length();
            }
        }
    }
    [of_parts, of_materials]
}
