//! The tables of a report, for a page and for Markdown.

use super::claims::{FAST, OURS};
use super::paper::FIGURES;
use super::{
    Calibration, Decomposition, FileRead, MeshReport, Partition, Quartiles, ReaderTime, Report,
    gpu_tables,
};

/// A table of text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// The mesh; none for what is of all.
    pub mesh: Option<String>,
    /// A name without spaces: of the mesh, and of what is in it.
    pub name: String,
    /// A heading.
    pub title: String,
    /// What it shows, in sentences.
    pub note: &'static str,
    /// Of the columns.
    pub head: Vec<&'static str>,
    /// Each as long as the head.
    pub rows: Vec<Vec<String>>,
}

/// All tables that have a row.
pub fn tables(report: &Report) -> Vec<Table> {
    let of_meshes =
        report.meshes.iter().flat_map(|mesh| of_mesh(mesh).chain(gpu_tables::tables(report, mesh)));
    let tables = [headline(report), readers(report)].into_iter().chain(of_meshes);
    tables.filter(|table| !table.rows.is_empty()).collect()
}

/// A row for each mesh whose views were timed.
fn headline(report: &Report) -> Table {
    let row = |mesh: &MeshReport| {
        let patches = format!("patches, ids, {}", report.machine.instructions);
        let patches = mesh.times.iter().find(|time| time.name == patches)?;
        let (naive, brute_force) = (mesh.times.first()?, mesh.best_brute_force()?);
        let against = |other: &super::Time, ratio: &Quartiles| {
            format!("{} µs ({:.1} ×)", micros(other.micros), ratio.median)
        };
        let build = |name| {
            mesh.decomposition(name).map_or(String::new(), |each| format!("{:.2} s", each.seconds))
        };
        Some(vec![
            mesh.name.clone(),
            count(mesh.edges as f64),
            format!("{} µs", micros(patches.micros)),
            against(brute_force, &patches.over_brute_force),
            against(naive, &patches.speed_up),
            build(FAST),
            build(OURS),
        ])
    };
    Table {
        mesh: None,
        name: "headline".to_owned(),
        title: "A view through patches".to_owned(),
        note: "Mean time of a view over 252 viewpoints, median of rounds, one thread, edge ids; how many \
               times as fast patches are; and how long they take to build, on all threads.",
        head: vec![
            "mesh",
            "edges",
            "patches",
            "best brute force",
            "naive loop",
            "`FAST`",
            "`DEFAULT`",
        ],
        rows: report.meshes.iter().filter_map(row).collect(),
    }
}

/// A row for each file and each reader that reads the same from it.
fn readers(report: &Report) -> Table {
    let of_file = |file: &FileRead| {
        let megabytes = file.bytes as f64 / 1e6;
        let row = |reader: &ReaderTime| {
            vec![
                file.name.clone(),
                format!("{megabytes:.1}"),
                count(file.faces as f64),
                reader.name.clone(),
                format!("{:.1} ms", 1e3 * reader.seconds),
                count(megabytes / reader.seconds),
                format!("{:.1} ×", reader.over_ours.median),
            ]
        };
        file.readers.iter().map(row).collect::<Vec<_>>()
    };
    let files = report.reading.iter().flat_map(|reading| &reading.files);
    Table {
        mesh: None,
        name: "readers".to_owned(),
        title: "Reading files".to_owned(),
        note: "Median of rounds, each reader in turn, from the system's cache to positions and triangles, on \
               all threads where a reader uses them. Readers that refuse a file, or find other triangles in \
               it, are left out.",
        head: vec!["file", "MB", "triangles", "reader", "time", "MB/s", "as long as ours"],
        rows: files.flat_map(of_file).collect(),
    }
}

fn of_mesh(mesh: &MeshReport) -> impl Iterator<Item = Table> {
    counted(mesh).into_iter().chain(timed(mesh))
}

fn table(
    mesh: &MeshReport,
    [name, title]: [&str; 2],
    note: &'static str,
    head: &[&'static str],
    rows: Vec<Vec<String>>,
) -> Table {
    Table {
        mesh: Some(mesh.name.clone()),
        name: format!("{}-{name}", mesh.name),
        title: format!("{}: {title}", mesh.name),
        note,
        head: head.to_vec(),
        rows,
    }
}

const GROUPED: &[&str] = &[
    "edges grouped by",
    "bounds",
    "mean r",
    "mean α",
    "bounds tested",
    "edges tested",
    "of all",
    "cost",
    "measured cost",
    "near: bounds",
    "near: edges",
    "s",
];

const GROUPED_NOTE: &str = "Means of the 252 viewpoints of TB24 §4.3, and of those near the surface. r in units \
    of half the longest side; for a bound without a sphere it is t cos α, which is r where there is one. \
    Cost: 1.363 for each bound tested and 1 for each edge (TB24 §4.2); the measured cost is the same with \
    what the test of a bound takes here, on the reference path with exact predicates. Seconds of wall time; \
    patches are built on all threads, hierarchies and meshlets on one. After TB24, Table 2.";

/// What views test.
fn counted(mesh: &MeshReport) -> [Table; 3] {
    [
        table(
            mesh,
            ["partitions", "the published method, by the size of its groups"],
            "At most c_max edges are fused as one group (TB24 §3.3, Table 1). Reduced Spheres.",
            &["c_max", "patches", "bounds tested", "edges tested", "cost", "s"],
            mesh.partitions.iter().map(partition).collect(),
        ),
        table(
            mesh,
            ["decompositions", "patches, meshlets and hierarchies"],
            GROUPED_NOTE,
            GROUPED,
            mesh.decompositions.iter().map(|each| grouped(each, mesh, mesh.edges)).collect(),
        ),
        table(
            mesh,
            ["all-edges", "all edges, concave ones too"],
            GROUPED_NOTE,
            GROUPED,
            mesh.of_all_edges.iter().map(|each| grouped(each, mesh, mesh.all_edges)).collect(),
        ),
    ]
}

/// What that takes, and what papers say of both.
fn timed(mesh: &MeshReport) -> [Table; 4] {
    let stage =
        |(stage, seconds): &(String, f64)| vec![stage.clone(), format!("{:.1}", 1e3 * seconds)];
    let figures = FIGURES.iter().filter(|figure| figure.mesh == mesh.name);
    [
        table(
            mesh,
            ["calibration", "what the cost model is made of"],
            "Medians and quartiles over 51 of the viewpoints, exact predicates throughout (TB24 §4.2, Table 3).",
            &["t_e", "t_P / t_e", "t_A / t_e"],
            mesh.calibration.iter().map(calibration).collect(),
        ),
        table(
            mesh,
            ["times", "time of a view"],
            "One after the other in each round. Medians of the mean over the 252 viewpoints, and of its ratios, \
             with quartiles over rounds. The floor only reads and writes what the patches of the kernels have \
             to. After TB24, Table 4.",
            &["extractor", "µs", "over the first", "over the best brute force"],
            times(mesh),
        ),
        table(
            mesh,
            ["drawing", "a drawing, stage by stage"],
            "As `drypoint draw` makes it, 1000 × 1000 pixels.",
            &["stage", "ms"],
            mesh.drawing.iter().map(stage).collect(),
        ),
        table(
            mesh,
            ["papers", "what papers report"],
            "TB24: Tsiapkolis and Bénard, CGF 43(4), 2024. S00: Sander et al., SIGGRAPH 2000.",
            &["figure", "value", "source", "how it differs"],
            figures
                .map(|f| [f.what, f.value, f.source, f.differs].map(str::to_owned).to_vec())
                .collect(),
        ),
    ]
}

fn partition(partition: &Partition) -> Vec<String> {
    vec![
        count(f64::from(partition.edges)),
        count(partition.patches as f64),
        count(partition.tested.bounds.mean),
        count(partition.tested.edges.mean),
        count(partition.tested.cost()),
        seconds(partition.seconds),
    ]
}

fn grouped(grouped: &Decomposition, mesh: &MeshReport, edges: usize) -> Vec<String> {
    let (far, near) = (&grouped.tested.far, &grouped.tested.near);
    let measured = mesh.calibration.as_ref().map_or(String::new(), |calibration| {
        count(calibration.patch_test.median * far.bounds.mean + far.edges.mean)
    });
    vec![
        grouped.name.clone(),
        count(grouped.bounds as f64),
        grouped.radius.map_or(String::new(), |radius| format!("{radius:.4}")),
        format!("{:.2}°", grouped.half_angle.to_degrees()),
        count(far.bounds.mean),
        count(far.edges.mean),
        format!("{:.1} %", 100.0 * far.edges.mean / edges.max(1) as f64),
        count(far.cost()),
        measured,
        count(near.bounds.mean),
        count(near.edges.mean),
        seconds(grouped.seconds),
    ]
}

fn calibration(calibration: &Calibration) -> Vec<String> {
    let Calibration { edge, patch_test, accepted_patch } = calibration;
    vec![
        format!("{:.1} ns [{:.1}, {:.1}]", edge.median, edge.low, edge.high),
        three_digits(patch_test),
        three_digits(accepted_patch),
    ]
}

fn times(mesh: &MeshReport) -> Vec<Vec<String>> {
    let row = |time: &super::Time| {
        vec![
            time.name.clone(),
            micros(time.micros),
            ratio(time.speed_up),
            ratio(time.over_brute_force),
        ]
    };
    mesh.times.iter().map(row).collect()
}

/// How many times as fast.
pub(super) fn ratio(Quartiles { low, median, high }: Quartiles) -> String {
    match median {
        ..10.0 => format!("{median:.2} [{low:.2}, {high:.2}]"),
        _ => format!("{median:.1} [{low:.1}, {high:.1}]"),
    }
}

fn three_digits(Quartiles { low, median, high }: &Quartiles) -> String {
    format!("{median:.3} [{low:.3}, {high:.3}]")
}

/// One digit behind the point where there are fewer than three before it.
fn micros(micros: f64) -> String {
    if micros < 100.0 { format!("{micros:.1}") } else { count(micros) }
}

fn seconds(seconds: f64) -> String {
    if seconds < 10.0 { format!("{seconds:.2}") } else { format!("{seconds:.0}") }
}

/// A whole number, with commas between thousands.
pub(crate) fn count(number: f64) -> String {
    let digits = format!("{number:.0}");
    let first = digits.len() % 3;
    let mut text = digits[..first].to_owned();
    for (index, three) in digits.as_bytes()[first..].chunks(3).enumerate() {
        if index > 0 || first > 0 {
            text.push(',');
        }
        text.extend(three.iter().map(|&digit| char::from(digit)));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        let cases = [
            (0.0, "0"),
            (7.4, "7"),
            (999.5, "1,000"),
            (1_000.0, "1,000"),
            (61_997.0, "61,997"),
            (123_456_789.0, "123,456,789"),
        ];
        for (number, text) in cases {
            assert_eq!(count(number), text);
        }
    }
}
