//! Plots as SVG, after Figures 4 to 7 of TB24.

use plotters::prelude::*;

use super::claims::{CONES, MESHLETS, OURS, SNCH, TB24, TWO_LEVELS};
use super::tables::count;
use super::{Counts, Decomposition, GpuTime, MeshReport, PATCH_TEST, Sample};
use crate::viewpoints::DISTANCES;

type Failed = DrawingAreaErrorKind<<SVGBackend<'static> as DrawingBackend>::ErrorType>;

/// Colors that can be told apart in print (Okabe and Ito).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(90, 90, 90),
];

/// What is drawn along the spiral: no more lines than there are colors, with contour edges.
const ALONG: [&str; 6] = [OURS, TWO_LEVELS, TB24, SNCH, CONES, MESHLETS];

/// A picture, and what it shows.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    pub(crate) caption: String,
    pub(crate) svg: String,
}

/// Those of a mesh that there are counts for.
///
/// # Errors
/// What the library that draws them fails with.
pub(crate) fn plots(mesh: &MeshReport) -> Result<Vec<Plot>, String> {
    let edges = mesh.edges.max(1) as f64;
    let shares = |sample: &dyn Fn(&Decomposition) -> Sample| -> Vec<(String, Vec<f64>)> {
        let share = |each: &Decomposition| {
            let counts = sample(each).counts.into_iter();
            (each.name.clone(), counts.map(|count| 100.0 * f64::from(count) / edges).collect())
        };
        mesh.decompositions.iter().map(share).collect()
    };
    let spiral = |value: &dyn Fn(&Counts) -> Vec<f64>| -> Vec<Line> {
        let line = |each: &Decomposition| (each.name.clone(), numbered(value(&each.tested.spiral)));
        let drawn = ALONG.iter().filter_map(|name| mesh.decomposition(name));
        drawn.map(line).collect()
    };
    let mut edges_along = spiral(&|counts| numbers(&counts.edges));
    edges_along.push(("contour edges".to_owned(), numbered(numbers(&mesh.contours.spiral))));
    let cost = |counts: &Counts| -> Vec<f64> {
        let bounds = counts.bounds.counts.iter();
        let both = bounds.zip(&counts.edges.counts);
        both.map(|(&bounds, &edges)| PATCH_TEST * f64::from(bounds) + f64::from(edges)).collect()
    };
    let drawn = [
        (
            "Edges tested, per cent of all, over the 252 viewpoints: boxes are quartiles, and whiskers reach 1.5 \
             times their distance beyond, whether or not there are views (after TB24, Figure 4).",
            boxes("edges tested, %", &shares(&|each| each.tested.far.edges.clone())),
        ),
        (
            "Edges tested along a spiral of viewpoints from pole to pole, ten half-lengths away, and the \
             contour edges among them (after TB24, Figure 5).",
            lines(["viewpoint", "edges"], &edges_along),
        ),
        (
            "Cost along the same spiral: 1.363 for each bound tested, and 1 for each edge (after TB24, \
             Figure 6).",
            lines(["viewpoint", "cost"], &spiral(&cost)),
        ),
        (
            "Edges tested, per cent of all, from viewpoints on, in and beside the surface.",
            boxes("edges tested, %", &shares(&|each| each.tested.near.edges.clone())),
        ),
        (
            "Time of extraction on the GPU for the 42 instances of each distance, in half-lengths (after TB24, \
             Figure 7).",
            lines(["distance", "ms"], &by_distance(mesh)),
        ),
    ];
    let finish = |(caption, svg): (&str, Result<Option<String>, Failed>)| match svg {
        Ok(svg) => svg.map(|svg| Ok(Plot { caption: caption.to_owned(), svg })),
        Err(error) => Some(Err(error.to_string())),
    };
    drawn.into_iter().filter_map(finish).collect()
}

/// A name, and points.
type Line = (String, Vec<(f64, f64)>);

/// With the numbers of viewpoints.
fn numbered(values: Vec<f64>) -> Vec<(f64, f64)> {
    values.into_iter().enumerate().map(|(number, value)| (number as f64, value)).collect()
}

/// Times on the GPU.
fn by_distance(mesh: &MeshReport) -> Vec<Line> {
    let times = mesh.gpu.iter().flat_map(|gpu| &gpu.times);
    let line = |time: &GpuTime| {
        let points = DISTANCES.into_iter().zip(time.by_distance.iter().copied());
        (time.name.clone(), points.collect())
    };
    times.map(line).collect()
}

fn numbers(sample: &Sample) -> Vec<f64> {
    sample.counts.iter().copied().map(f64::from).collect()
}

/// One horizontal box for each; none without numbers.
fn boxes(axis: &str, samples: &[(String, Vec<f64>)]) -> Result<Option<String>, Failed> {
    let samples: Vec<_> = samples.iter().filter(|(_, values)| !values.is_empty()).collect();
    let upper_end = |values: &[f64]| plotters::data::Quartiles::new(values).values()[4];
    let most = samples.iter().map(|(_, values)| upper_end(values)).fold(0.0, f32::max);
    if most == 0.0 {
        return Ok(None);
    }
    let names: Vec<&str> = samples.iter().rev().map(|(name, _)| name.as_str()).collect();
    let mut svg = String::new();
    {
        #[expect(clippy::cast_possible_truncation, reason = "a few")]
        let area = SVGBackend::with_string(&mut svg, (820, 70 + 34 * names.len() as u32));
        let area = area.into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin(8)
            .x_label_area_size(38)
            .y_label_area_size(190)
            .build_cartesian_2d(0.0..1.05 * most, names[..].into_segmented())?;
        let name = |value: &SegmentValue<&&str>| match value {
            SegmentValue::CenterOf(name) => (**name).to_string(),
            SegmentValue::Exact(_) | SegmentValue::Last => String::new(),
        };
        chart
            .configure_mesh()
            .disable_y_mesh()
            .x_desc(axis)
            .y_labels(names.len() + 1)
            .y_label_formatter(&name)
            .x_label_formatter(&|number| format!("{number:.0}"))
            .light_line_style(WHITE)
            .draw()?;
        for (index, (name, values)) in samples.iter().enumerate() {
            let color = COLORS[index % COLORS.len()];
            let name = names.iter().find(|other| **other == name.as_str());
            let place = SegmentValue::CenterOf(name.expect("it is one of them"));
            let quartiles = plotters::data::Quartiles::new(values);
            let drawn = Boxplot::new_horizontal(place, &quartiles).width(16).style(color);
            chart.draw_series([drawn])?;
        }
        area.present()?;
    }
    Ok(Some(svg))
}

/// Each in its color; none without points.
fn lines(axes: [&str; 2], series: &[Line]) -> Result<Option<String>, Failed> {
    let points = || series.iter().flat_map(|(_, points)| points);
    let most = points().map(|(_, y)| *y).fold(0.0, f64::max);
    let last = points().map(|(x, _)| *x).fold(0.0, f64::max);
    if most == 0.0 {
        return Ok(None);
    }
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (820, 380)).into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin(8)
            .x_label_area_size(38)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..last, 0.0..1.75 * most)?;
        chart
            .configure_mesh()
            .x_desc(axes[0])
            .y_desc(axes[1])
            .x_label_formatter(&|number| count(*number))
            .y_label_formatter(&|number| {
                if most < 10.0 { format!("{number:.2}") } else { count(*number) }
            })
            .light_line_style(WHITE)
            .draw()?;
        for (index, (name, points)) in series.iter().enumerate() {
            let color = COLORS[index % COLORS.len()];
            let style = color.stroke_width(1);
            let points = points.iter().copied();
            let swatch =
                move |(x, y)| Rectangle::new([(x, y - 4), (x + 14, y + 4)], color.filled());
            chart.draw_series(LineSeries::new(points, style))?.label(name).legend(swatch);
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .draw()?;
        area.present()?;
    }
    Ok(Some(svg))
}
