//! The figures in the documents are those that were measured.

use std::fs;
use std::path::Path;

use drypoint_tests::report::{DOCUMENTS, Report, SUMMARY, blocks, page, replace_blocks};

fn read(document: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(document);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn report() -> Report {
    serde_json::from_str(&read(SUMMARY)).unwrap()
}

#[test]
fn documents_say_what_was_measured() {
    let blocks = blocks(&report());
    for document in DOCUMENTS {
        let text = read(document);
        let measured = replace_blocks(&text, &blocks).unwrap();
        assert!(text.contains("<!-- measured: "), "{document} has no measured table");
        let lines = text.lines().zip(measured.lines());
        let other = lines.filter(|(written, measured)| written != measured);
        assert_eq!(
            other.collect::<Vec<_>>(),
            [],
            "{document}: `cargo xtask bench --docs .` writes it"
        );
        assert_eq!(text, measured);
    }
}

#[test]
fn what_is_written_is_read_back() {
    let report = report();
    let json = serde_json::to_string(&report).unwrap();
    assert_eq!(serde_json::from_str::<Report>(&json).unwrap(), report);
    assert_eq!(report.clone().summary(), report);
}

#[test]
fn the_page_needs_no_other_file() {
    let page = page(&report()).unwrap();
    for reference in ["src=", "href=", "@import", "url("] {
        assert!(!page.contains(reference), "the page has {reference}");
    }
}
