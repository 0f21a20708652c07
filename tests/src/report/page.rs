//! The report as one page that needs no other file.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::markdown::device;
use super::plots::{Plot, plots};
use super::{Claim, Report, Table, claims, tables};

const STYLE: &str = "
body { font: 15px/1.5 system-ui, sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; }
th, td { padding: 0.2em 0.7em; text-align: right; border-bottom: 1px solid #ddd; }
th:first-child, td:first-child { text-align: left; }
figure { margin: 1.5em 0; } figcaption, .note { color: #555; font-size: 13px; }
svg { max-width: 100%; height: auto; }
.fails { color: #b00020; font-weight: bold; }
code { background: #f4f4f4; padding: 0 0.2em; }
";

/// HTML with its style and its plots inside.
///
/// # Errors
/// If a plot cannot be drawn.
pub fn page(report: &Report) -> Result<String, String> {
    let tables = tables(report);
    let mut meshes = Vec::new();
    for mesh in &report.meshes {
        meshes.push((mesh, plots(mesh)?));
    }
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Drypoint: measurements" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "Drypoint: measurements" }
                (provenance(report))
                p {
                    "Contour edges are those that the exact definition gives: every extractor was compared with \
                     it, from each of its viewpoints, before it was counted or timed, but for the naive loop, \
                     which is inexact, and the floor. Lengths are in units of half the longest side of a \
                     mesh's box."
                }
                p class="note" {
                    "Bounds are those of patches and super-patches, of nodes of a hierarchy, or of meshlets. FAST, \
                     DEFAULT, BEST and NEAR are presets of patches; TB24 is the published method, of Tsiapkolis and \
                     Bénard, CGF 43(4), 2024; SNCH is the hierarchy of Johnson and Cohen, I3D 2001; anchored cones \
                     are the forest of Sander et al., SIGGRAPH 2000 (S00); meshlets are those of meshoptimizer. \
                     Only the rows that say \"exact predicates\" compare methods like for like: none but patches \
                     and brute force has kernels."
                }
                @for each in tables.iter().filter(|table| table.name == "headline") { (table(each)) }
                (claimed(&claims(report)))
                @for (mesh, plots) in &meshes {
                    h2 { (mesh.name) }
                    p {
                        (mesh.faces) " faces, " (mesh.all_edges) " edges, of which " (mesh.edges)
                        " may be visible contours; "
                        (format!("{:.0}", mesh.contours.far.mean)) " contour edges in a view."
                    }
                    @for each in tables.iter().filter(|table| table.mesh.as_ref() == Some(&mesh.name)) {
                        (table(each))
                    }
                    @for each in plots { (figure(each)) }
                }
            }
        }
    };
    Ok(markup.into_string())
}

fn provenance(Report { machine, run, gpu, vulkan, .. }: &Report) -> Markup {
    html! {
        p {
            "Drypoint " (run.version) ", commit " (run.commit) ", " code { (run.command) } ", "
            (run.rounds) " rounds"
            @if run.is_quick { " (quick: small meshes and cheap methods only)" }
            ". Machine: " (machine.processor) ", " (machine.threads) " threads, "
            (machine.instructions) " kernels, " (format!("{:.0}", machine.memory)) " GB, "
            (machine.system) "."
            @if let Some(gpu) = gpu { " GPU: " (device(gpu)) "." }
            @if let Some(vulkan) = vulkan { " Vulkan: " (device(vulkan)) "." }
        }
    }
}

fn claimed(claims: &[Claim]) -> Markup {
    html! {
        @if !claims.is_empty() {
            h2 { "What is claimed" }
            ul {
                @for claim in claims {
                    li {
                        (claim.what) ": " (claim.measured) " "
                        @if claim.holds { "(holds)" } @else { span class="fails" { "(does not hold)" } " " (claim.why) }
                    }
                }
            }
        }
    }
}

fn table(table: &Table) -> Markup {
    html! {
        h3 id=(table.name) { (table.title) }
        p class="note" { (table.note) }
        table {
            thead { tr { @for column in &table.head { th { (column) } } } }
            tbody { @for row in &table.rows { tr { @for cell in row { td { (cell) } } } } }
        }
    }
}

fn figure(plot: &Plot) -> Markup {
    html! { figure { (PreEscaped(&plot.svg)) figcaption { (plot.caption) } } }
}

#[cfg(test)]
mod tests {
    use super::super::*;
    use super::page;
    use crate::judges::Tested;

    /// Two groupings of a mesh of that name, the first with 100 and the second with 250 edges tested.
    fn report(name: &str) -> Report {
        let counts = |edges| {
            let tested = |view: usize| Tested { bounds: 10, edges: edges + view % 7 };
            Counts::of(&(0..50).map(tested).collect::<Vec<_>>())
        };
        let decomposition = |name: &str, edges| Decomposition {
            name: name.to_owned(),
            seconds: 0.5,
            bounds: 10,
            radius: Some(0.25),
            half_angle: 0.5,
            tested: Views { far: counts(edges), near: counts(edges), spiral: counts(edges) },
        };
        let contours = || Sample::of((0..50).map(|view| 30 + view % 5));
        Report {
            machine: Machine {
                processor: "<any> & all".to_owned(),
                threads: 2,
                instructions: "Avx2".to_owned(),
                memory: 8.0,
                system: "Linux".to_owned(),
            },
            run: Run {
                version: "0".to_owned(),
                commit: "unknown".to_owned(),
                command: "bench".to_owned(),
                rounds: 2,
                is_quick: true,
            },
            meshes: vec![MeshReport {
                name: name.to_owned(),
                faces: 700,
                edges: 1000,
                all_edges: 1050,
                contours: Views { far: contours(), near: contours(), spiral: contours() },
                partitions: Vec::new(),
                decompositions: vec![decomposition(OURS, 100), decomposition(MESHLETS, 250)],
                of_all_edges: Vec::new(),
                calibration: None,
                times: Vec::new(),
                drawing: Vec::new(),
                gpu: None,
                gpu_calibration: Vec::new(),
                vulkan: Vec::new(),
            }],
            gpu: None,
            vulkan: None,
            reading: None,
        }
    }

    #[test]
    fn tables_plots_and_claims_are_on_the_page() {
        let page = page(&report("stanford-bunny")).unwrap();
        for text in [
            "&lt;any&gt; &amp; all",
            "<td>103</td>",
            "patches (DEFAULT) test fewer edges than meshlets",
            "What is claimed",
        ] {
            assert!(page.contains(text), "no {text} in {page}");
        }
        assert_eq!(page.matches("<svg").count(), 4);
        // In each plot by name, and contour edges in one.
        assert_eq!(page.matches("\nmeshlets\n</text>").count(), 4);
        assert_eq!(page.matches("\ncontour edges\n</text>").count(), 1);
    }

    #[test]
    fn a_summary_has_the_same_tables_and_no_plots() {
        let report = report("cube");
        let summary = report.clone().summary();
        assert_eq!(tables(&summary), tables(&report));
        assert!(!page(&summary).unwrap().contains("<svg"));
        assert!(claims(&report).is_empty());
    }

    /// With times of a GPU: patches are six times as fast as brute force, which takes twice as long as
    /// what it reads.
    fn report_on_gpu(is_software: bool) -> Report {
        let mut report = report("stanford-bunny");
        let one = |median| Quartiles { low: median, median, high: median };
        let time = |name: &str, faster: f64| GpuTime {
            name: name.to_owned(),
            millis: one(12.0 / faster),
            over_brute_force: one(faster),
            tested: (name != FLOOR).then(GpuTested::default),
            by_distance: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|millis| millis / faster).to_vec(),
        };
        let frame = |name: &str| GpuFrame {
            name: name.to_owned(),
            lines: 1234,
            extraction: one(2.0),
            drawing: one(1.0),
            both: one(3.0),
            over_brute_force: one(1.0),
            recording: one(55.0),
        };
        report.gpu = Some(GpuRun {
            device: "A GPU".to_owned(),
            is_software,
            run: Run { rounds: 9, ..report.run.clone() },
        });
        report.meshes[0].gpu = Some(GpuReport {
            width: 64,
            times: vec![time(BRUTE_FORCE, 1.0), time(OURS, 6.0), time(FLOOR, 2.0)],
            frames: vec![frame(BRUTE_FORCE), frame(OURS)],
        });
        let costs =
            Calibration { edge: one(0.0123), patch_test: one(1.5), accepted_patch: one(-9.0) };
        let (brute_force, patches) = (one(6.0), one(1.0));
        report.meshes[0].gpu_calibration =
            vec![GpuCalibration { width: 32, costs, brute_force, patches }];
        report
    }

    /// Three times as fast as without culling, and half as much again as the compute pipeline.
    fn vulkan_frame() -> VulkanFrame {
        let one = |median| Quartiles { low: median, median, high: median };
        let counts = VulkanCounts { lines: 1234, primitives: 1234, ..VulkanCounts::default() };
        VulkanFrame {
            name: OURS.to_owned(),
            is_mesh: true,
            millis: one(2.0),
            over_brute_force: one(3.5),
            of_compute: one(1.5),
            counts,
        }
    }

    #[test]
    fn frames_in_vulkan_are_on_the_page_and_held_against_what_was_promised() {
        for is_software in [false, true] {
            let mut report = report_on_gpu(is_software);
            report.vulkan = report.gpu.take();
            report.meshes[0].gpu = None;
            report.meshes[0].vulkan = vec![vulkan_frame()];
            let text = page(&report).unwrap();
            assert!(text.contains("Vulkan: A GPU") && text.contains("<td>task and mesh</td>"));
            let table = tables(&report).into_iter().find(|t| t.name.ends_with("-vulkan")).unwrap();
            assert!(table.rows.iter().all(|row| row.len() == table.head.len()));
            assert_eq!(table.title.contains("they say nothing about GPUs"), is_software);
            let of_vulkan = |claim: &&Claim| claim.what.contains("mesh shaders");
            let all = claims(&report);
            let held: Vec<bool> = all.iter().filter(of_vulkan).map(|claim| claim.holds).collect();
            assert_eq!(held, if is_software { vec![] } else { vec![false, true] });
        }
    }

    #[test]
    fn a_gpu_is_named_and_claims_are_held_against_it() {
        let report = report_on_gpu(false);
        let text = page(&report).unwrap();
        let cells = [
            "A GPU",
            "<td>12.0 [12.0, 12.0]</td>",
            "<td>0.0123 [0.0123, 0.0123] ns</td>",
            "<td>−9.00 ",
        ];
        for text_of in cells.into_iter().chain(["<td>1,234</td>", "<td>off</td>"]) {
            assert!(text.contains(text_of), "no {text_of} in {text}");
        }
        assert!(!text.contains("software"));
        assert_eq!(text.matches("<svg").count(), 5);
        let on_gpu = |claim: &&Claim| claim.what.contains("GPU") || claim.what.contains("bunnies");
        let all = claims(&report);
        let held: Vec<bool> = all.iter().filter(on_gpu).map(|claim| claim.holds).collect();
        assert_eq!(held, [true, false, true]);
    }

    #[test]
    fn software_is_called_so_in_each_table_and_claims_nothing() {
        let report = report_on_gpu(true);
        assert_eq!(claims(&report), claims(&self::report("stanford-bunny")));
        let of_gpu = |table: &&Table| table.name.contains("-gpu");
        let tables = tables(&report);
        assert_eq!(tables.iter().filter(of_gpu).count(), 4);
        for table in tables.iter().filter(of_gpu) {
            assert!(table.title.contains("they say nothing about GPUs"), "{}", table.title);
            assert!(table.head.iter().any(|head| head.contains("(software)")), "{:?}", table.head);
            assert!(table.rows.iter().all(|row| row.len() == table.head.len()), "{}", table.name);
        }
        let block = blocks(&report).into_iter().find(|(name, _)| name == "gpu").unwrap().1;
        assert!(block.contains("nothing about GPUs") && block.contains("9 rounds"), "{block}");
    }

    #[test]
    fn what_was_measured_on_a_gpu_is_put_into_another_report() {
        let (other, mut on_gpu) = (report("stanford-bunny"), report_on_gpu(false));
        let both = other.clone().with_gpu_of(&on_gpu);
        assert_eq!(both, on_gpu);
        // What was not measured again stays.
        assert_eq!(both.clone().with_gpu_of(&other), both);
        assert!(!both.is_on_gpu_alone() && !other.is_on_gpu_alone());
        on_gpu.meshes[0].decompositions.clear();
        assert!(on_gpu.is_on_gpu_alone());
        assert_eq!(other.with_gpu_of(&on_gpu), both);
        let mut in_vulkan = on_gpu.clone();
        in_vulkan.gpu = None;
        in_vulkan.vulkan.clone_from(&on_gpu.gpu);
        in_vulkan.meshes[0].vulkan = vec![vulkan_frame()];
        assert!(in_vulkan.is_on_gpu_alone());
        let all = both.clone().with_gpu_of(&in_vulkan);
        assert_eq!((&all.gpu, &all.vulkan), (&both.gpu, &in_vulkan.vulkan));
        assert_eq!(all.meshes[0].vulkan.len(), 1);
        assert_eq!(all.meshes[0].gpu, both.meshes[0].gpu);
        on_gpu.meshes[0].name = "another".to_owned();
        let both = all.with_gpu_of(&on_gpu);
        assert_eq!((&both.meshes[0].gpu, both.meshes[0].vulkan.len()), (&None, 1));
    }

    #[test]
    fn a_claim_that_does_not_hold_is_said_not_to() {
        let mut report = report("stanford-bunny");
        report.meshes[0].decompositions[0].tested.far.edges.mean = 300.0;
        let failed: Vec<Claim> = claims(&report).into_iter().filter(|claim| !claim.holds).collect();
        assert_eq!(failed.len(), 2, "{failed:?}");
        assert!(page(&report).unwrap().contains("(does not hold)"));
    }
}
