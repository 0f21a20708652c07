//! Links between files: each leads to a file, and each anchor to a heading. Links to other sites are
//! not followed, because a check that needs a network fails for reasons that are not ours.

use super::Finding;
use super::tree::{File, Tree};
use crate::manifest::line_of;
use pulldown_cmark::{BrokenLink, CowStr, Event, LinkType, Options, Parser, Tag, TagEnd};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

/// A link as it is written, and its line.
struct Link {
    line: usize,
    target: String,
}

/// What one Markdown file offers and asks for.
#[derive(Default)]
struct Page {
    links: Vec<Link>,
    /// `[text][name]` without a `[name]: target`.
    undefined: Vec<Link>,
    anchors: BTreeSet<String>,
}

pub(crate) fn links(tree: &Tree) -> Vec<Finding> {
    let files = || tree.with_extension("md");
    let pages: BTreeMap<&str, Page> =
        files().map(|f| (f.path.as_str(), Page::read(&f.text))).collect();
    let mut found = Vec::new();
    for file in files() {
        let page = &pages[file.path.as_str()];
        for link in &page.undefined {
            found.push(file.finding(link.line, format!("`[{}]` is not defined", link.target)));
        }
        for link in &page.links {
            if let Err(what) = follow(tree, &pages, file, &link.target) {
                found.push(file.finding(link.line, format!("`{}`: {what}", link.target)));
            }
        }
    }
    found
}

fn follow(
    tree: &Tree,
    pages: &BTreeMap<&str, Page>,
    file: &File,
    target: &str,
) -> Result<(), &'static str> {
    let is_elsewhere =
        ["http://", "https://", "mailto:"].iter().any(|start| target.starts_with(start));
    if is_elsewhere {
        return Ok(());
    }
    let (path, anchor) = target.split_once('#').map_or((target, None), |(path, a)| (path, Some(a)));
    let path = path.split('?').next().unwrap_or_default().replace("%20", " ");
    let path = if path.is_empty() {
        file.path.clone()
    } else {
        let folder = file.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        resolve(folder, &path).ok_or("leads out of the repository")?
    };
    if !tree.root.join(&path).exists() {
        return Err("no such file");
    }
    match (anchor, pages.get(path.as_str())) {
        (Some(anchor), Some(page)) if !page.anchors.contains(anchor) => Err("no such heading"),
        _ => Ok(()),
    }
}

/// `path` as seen from `folder`, without `.` and `..`; `None` if it leads above the root.
fn resolve(folder: &str, path: &str) -> Option<String> {
    if path.starts_with('/') {
        return None;
    }
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

impl Page {
    fn read(text: &str) -> Self {
        let undefined = RefCell::new(Vec::new());
        let mut note_undefined = |link: BrokenLink<'_>| {
            // A single `[word]` is as likely an interval or a task as a link.
            if !matches!(link.link_type, LinkType::Shortcut | LinkType::ShortcutUnknown) {
                let line = line_of(text, link.span.start);
                undefined.borrow_mut().push(Link { line, target: link.reference.to_string() });
            }
            None::<(CowStr<'_>, CowStr<'_>)>
        };
        let options =
            Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES | Options::ENABLE_STRIKETHROUGH;
        let parser =
            Parser::new_with_broken_link_callback(text, options, Some(&mut note_undefined));
        let mut page = Self::default();
        let mut heading: Option<String> = None;
        for (event, span) in parser.into_offset_iter() {
            let line = line_of(text, span.start);
            match event {
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::End(TagEnd::Heading(_)) => {
                    page.add_heading(&heading.take().unwrap_or_default())
                }
                Event::Text(text) | Event::Code(text) => {
                    heading.iter_mut().for_each(|h| h.push_str(&text))
                }
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(Link { line, target: dest_url.to_string() });
                }
                Event::Html(html) | Event::InlineHtml(html) => page.add_html(&html, line),
                _ => {}
            }
        }
        page.undefined = undefined.take();
        page
    }

    /// Adds the anchor that GitHub gives a heading: lower case, hyphens for spaces, no punctuation,
    /// and a number if the anchor is taken.
    fn add_heading(&mut self, heading: &str) {
        let keep = |c: char| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
            _ => None,
        };
        let anchor: String = heading.trim().to_lowercase().chars().filter_map(keep).collect();
        let numbered = (1..).map(|n| format!("{anchor}-{n}"));
        let free =
            std::iter::once(anchor.clone()).chain(numbered).find(|a| !self.anchors.contains(a));
        self.anchors.extend(free);
    }

    fn add_html(&mut self, html: &str, line: usize) {
        for attribute in ["href", "src", "srcset"] {
            let values = values_of(html, attribute);
            self.links.extend(values.map(|target| Link { line, target: target.to_owned() }));
        }
        for attribute in ["id", "name"] {
            self.anchors.extend(values_of(html, attribute).map(str::to_owned));
        }
    }
}

/// The values of `attribute="value"` in a piece of HTML.
fn values_of<'h>(html: &'h str, attribute: &str) -> impl Iterator<Item = &'h str> {
    let start = format!(" {attribute}=\"");
    html.match_indices(&start)
        .map(|(at, found)| html[at + found.len()..].split('"').next().unwrap_or_default())
        .collect::<Vec<_>>()
        .into_iter()
}

#[cfg(test)]
mod tests {
    use super::super::testing::check;

    /// A page in docs/ with this text breaks the rule in its third line, or not at all.
    #[track_caller]
    fn check_page(text: &str, is_broken: bool) {
        let page = format!("# Page\n\n{text}\n");
        let expected: &[&str] = if is_broken { &["docs/page.md:3 link"] } else { &[] };
        check(&[("docs/page.md", &page)], expected);
    }

    #[test]
    fn a_link_leads_to_a_file() {
        check_page(
            "[a](words.md) [b](../README.md) [c](../crates/mesh) [d](./words.md?raw=true)",
            false,
        );
        check_page("[a](https://example.org/none) <mailto:a@example.org>", false);
        check_page("[a](none.md)", true);
        check_page("![a](picture.svg)", true);
        check_page("[a]\n\n[a]: none.md", true);
        check_page("| a |\n|---|\n| [a](words.md) |", false);
        check_page("[a](../../README.md)", true);
        check_page("[a](/docs/words.md)", true);
        check_page("`[a](none.md)`", false);
    }

    #[test]
    fn an_anchor_leads_to_a_heading() {
        check_page("[a](#page) [b](words.md#edge-and-wing)", false);
        check_page("[a](#pages)", true);
        check_page("[a](words.md#edge)", true);
        check_page("[a](../crates/mesh/src/lib.rs#L3)", false);
        check_page("[a](#twice-1)\n\n## Twice\n\n## Twice!", false);
        check_page("[a](#twice-2)\n\n## Twice\n\n## Twice!", true);
        check_page("[a](#here) <a id=\"here\"></a>", false);
    }

    #[test]
    fn html_is_read_too() {
        check_page("<img width=\"9\" src=\"words.md\">", false);
        check_page("<img width=\"9\" src=\"none.svg\">", true);
        check_page("See <a href=\"none.md\">a</a>.", true);
    }

    #[test]
    fn a_reference_is_defined() {
        check_page("[a][words]\n\n[words]: words.md", false);
        check_page("[a][none]", true);
        check_page("In [0, 1].", false);
    }
}
