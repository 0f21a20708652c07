//! Tables in Markdown, in documents that say where: between `<!-- measured: NAME -->` and
//! `<!-- end -->`.

use super::gpu_tables::SOFTWARE;
use super::tables::Table;
use super::{GpuRun, Report, Run, claims, tables};

const START: &str = "<!-- measured: ";
const END: &str = "<!-- end -->";

/// What belongs between marks, by name: a table for each of [`tables`], `machine`, `claims`, and
/// `reading`, `gpu` and `vulkan` if there were such.
pub fn blocks(report: &Report) -> Vec<(String, String)> {
    let mut blocks: Vec<(String, String)> =
        tables(report).iter().map(|table| (table.name.clone(), markdown(table))).collect();
    let reading = report.reading.iter().map(|r| ("reading", &r.machine, &r.run));
    for (name, machine, run) in reading.chain([("machine", &report.machine, &report.run)]) {
        let text = format!(
            "{}, {} threads, {} kernels, {:.0} GB, {}; {}\n",
            machine.processor,
            machine.threads,
            machine.instructions,
            machine.memory,
            machine.system,
            of_run(run),
        );
        blocks.push((name.to_owned(), text));
    }
    for (name, gpu) in [("gpu", &report.gpu), ("vulkan", &report.vulkan)] {
        blocks.extend(
            gpu.iter()
                .map(|gpu| (name.to_owned(), format!("{}; {}\n", device(gpu), of_run(&gpu.run)))),
        );
    }
    let claim = |claim: &super::Claim| {
        let (holds, why) =
            if claim.holds { ("holds", "") } else { ("does not hold", &claim.why[..]) };
        format!("- {}: {} ({holds}). {why}", claim.what, claim.measured).trim_end().to_owned()
    };
    let lines: Vec<String> = claims(report).iter().map(claim).collect();
    blocks.push(("claims".to_owned(), lines.join("\n") + "\n"));
    blocks
}

fn of_run(Run { version, commit, command, rounds, .. }: &Run) -> String {
    format!("Drypoint {version} at commit {commit}, `{command}`, {rounds} rounds.")
}

/// A GPU, with what has to be said of one that is none.
pub(super) fn device(gpu: &GpuRun) -> String {
    if gpu.is_software { format!("{}: {SOFTWARE}", gpu.device) } else { gpu.device.clone() }
}

fn markdown(table: &Table) -> String {
    let mut text =
        format!("| {} |\n|{}\n", table.head.join(" | "), "---|".repeat(table.head.len()));
    for row in &table.rows {
        text += &format!("| {} |\n", row.join(" | "));
    }
    text
}

/// The names of the marks in `document`.
pub fn marks(document: &str) -> impl Iterator<Item = &str> {
    document.split(START).skip(1).filter_map(|marked| Some(marked.split_once(" -->")?.0))
}

/// `document` with every marked block made anew.
///
/// # Errors
/// A mark that is not closed, or names no block.
pub fn replace_blocks(document: &str, blocks: &[(String, String)]) -> Result<String, String> {
    let mut text = String::new();
    let mut rest = document;
    while let Some(start) = rest.find(START) {
        let (before, marked) = rest.split_at(start);
        let (mark, inside) = marked
            .split_once(" -->\n")
            .ok_or_else(|| format!("a mark that does not end: {}", first_line(marked)))?;
        let name = &mark[START.len()..];
        let (_, content) = blocks
            .iter()
            .find(|(block, _)| block == name)
            .ok_or_else(|| format!("nothing was measured for the mark {name:?}"))?;
        let end = inside.find(END).filter(|&end| inside.find(START).is_none_or(|next| end < next));
        let end = end.ok_or_else(|| format!("the mark {name:?} has no {END}"))?;
        text += &format!("{before}{START}{name} -->\n{content}");
        rest = &inside[end..];
    }
    Ok(text + rest)
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(document: &str, expected: Result<&str, &str>) {
        let blocks = [("a".to_owned(), "new\n".to_owned()), ("b".to_owned(), "B\n".to_owned())];
        let replaced = replace_blocks(document, &blocks);
        assert_eq!(replaced.as_deref().map_err(String::as_str), expected);
    }

    #[test]
    fn what_is_marked_is_replaced() {
        check("nothing\n", Ok("nothing\n"));
        check(
            "x\n<!-- measured: a -->\nold\n<!-- end -->\ny <!-- measured: b -->\n<!-- end -->\n",
            Ok(
                "x\n<!-- measured: a -->\nnew\n<!-- end -->\ny <!-- measured: b -->\nB\n<!-- end -->\n",
            ),
        );
    }

    #[test]
    fn marks_without_a_measurement_or_an_end_are_errors() {
        check(
            "<!-- measured: c -->\n<!-- end -->\n",
            Err("nothing was measured for the mark \"c\""),
        );
        check("<!-- measured: a -->\nold\n", Err("the mark \"a\" has no <!-- end -->"));
        check(
            "<!-- measured: a -->\nold\n<!-- measured: b -->\n<!-- end -->\n",
            Err("the mark \"a\" has no <!-- end -->"),
        );
        check("<!-- measured: a\nold\n", Err("a mark that does not end: <!-- measured: a"));
    }
}
