//! Rules on the words of a Rust file, comments and strings left out.

use super::Finding;
use super::tree::{File, Tree};
use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use syn::spanned::Spanned;
use syn::{Attribute, Item, Meta, Visibility};

/// `lib.rs` is docs, `mod` and `pub use`. What only doc tests see is let pass: a README is tested so.
pub(crate) fn lib_rs(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for (file, rust) in tree.rust().filter(|(file, _)| file.name() == "lib.rs") {
        for item in &rust.items {
            let attributes = match item {
                Item::Mod(module) if module.content.is_none() => continue,
                Item::Use(used) if !matches!(used.vis, Visibility::Inherited) => continue,
                Item::Struct(item) => &item.attrs,
                Item::Fn(item) => &item.attrs,
                Item::Mod(item) => &item.attrs,
                _ => &[][..],
            };
            if !attributes.iter().any(is_for_doc_tests) {
                found.push(file.finding(line(item.span()), "neither `mod name;` nor `pub use`"));
            }
        }
    }
    found
}

pub(crate) fn unsafe_code(tree: &Tree) -> Vec<Finding> {
    let may_be_unsafe =
        |file: &File| file.path.starts_with("crates/ash/") || file.name().starts_with("simd");
    let mut found = Vec::new();
    for (file, rust) in tree.rust().filter(|(file, _)| !may_be_unsafe(file)) {
        each_level(&rust.tokens, &mut |tokens| {
            let words = tokens.iter().filter(|token| is_word(token, "unsafe"));
            found.extend(words.map(|word| file.finding(line(word.span()), "`unsafe`")));
        });
    }
    found
}

/// Macros that stand for missing or forgotten code, and tests that do not run.
pub(crate) fn unfinished(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for (file, rust) in tree.rust() {
        each_level(&rust.tokens, &mut |tokens| {
            for pair in tokens.windows(2) {
                if let Some(what) = unfinished_pair(&pair[0], &pair[1]) {
                    found.push(file.finding(line(pair[0].span()), what));
                }
            }
        });
    }
    found
}

fn unfinished_pair(first: &TokenTree, second: &TokenTree) -> Option<String> {
    match (first, second) {
        (TokenTree::Ident(name), TokenTree::Punct(mark)) if mark.as_char() == '!' => {
            let is_left = ["todo", "unimplemented", "dbg"].iter().any(|left| name == left);
            is_left.then(|| format!("`{name}!`"))
        }
        (TokenTree::Punct(mark), TokenTree::Group(group))
            if mark.as_char() == '#' && group.delimiter() == Delimiter::Bracket =>
        {
            is_ignore(group.stream()).then(|| "a test that does not run".to_owned())
        }
        _ => None,
    }
}

/// `ignore`, `ignore = "…"` or `cfg_attr(…, ignore)`.
fn is_ignore(attribute: TokenStream) -> bool {
    let mut tokens = attribute.into_iter();
    let Some(name) = tokens.next() else { return false };
    let is_in_condition = |token: TokenTree| match token {
        TokenTree::Group(group) => group.stream().into_iter().any(|t| is_word(&t, "ignore")),
        _ => false,
    };
    is_word(&name, "ignore") || is_word(&name, "cfg_attr") && tokens.any(is_in_condition)
}

/// Hands over the tokens of each nesting level, outer levels first.
fn each_level(tokens: &TokenStream, visit: &mut impl FnMut(&[TokenTree])) {
    let level: Vec<TokenTree> = tokens.clone().into_iter().collect();
    visit(&level);
    for token in level {
        if let TokenTree::Group(group) = token {
            each_level(&group.stream(), visit);
        }
    }
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(name) if name == word)
}

fn line(span: Span) -> usize {
    span.start().line
}

fn is_for_doc_tests(attribute: &Attribute) -> bool {
    match &attribute.meta {
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "doctest",
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::check;

    const LIB: &str = "crates/mesh/src/lib.rs";
    const A: &str = "crates/mesh/src/a.rs";

    #[test]
    fn lib_rs_is_a_table_of_contents() {
        check(&[(LIB, "//! Docs.\n\n#![warn(missing_docs)]\n\npub mod a;\npub use a::A;\n")], &[]);
        check(&[(LIB, "//! Docs.\n\n#[doc = \"\"]\n#[cfg(doctest)]\npub struct Readme;\n")], &[]);
        let found = &["crates/mesh/src/lib.rs:2 lib-rs"];
        check(&[(LIB, "//! Docs.\npub fn a() {}\n")], found);
        check(&[(LIB, "//! Docs.\nuse a::A;\n")], found);
        check(&[(LIB, "//! Docs.\nmod a {}\n")], found);
        check(&[(LIB, "//! Docs.\nconst A: u8 = 0;\n")], found);
        check(&[(A, "pub fn a() {}\n")], &[]);
    }

    #[test]
    fn unsafe_has_its_places() {
        let block = "fn a() {\n    unsafe { b() }\n}\n";
        check(&[(A, block)], &["crates/mesh/src/a.rs:2 unsafe"]);
        check(
            &[(A, "macro_call! {\n    { unsafe { b() } }\n}\n")],
            &["crates/mesh/src/a.rs:2 unsafe"],
        );
        check(&[(A, "//! Nothing unsafe.\n#![forbid(unsafe_code)]\n")], &[]);
        check(&[("crates/ash/src/a.rs", block), ("crates/cpu/src/simd_avx2.rs", block)], &[]);
    }

    #[test]
    fn nothing_is_unfinished() {
        let found = &["crates/mesh/src/a.rs:2 unfinished"];
        check(&[(A, "fn a() {\n    todo!()\n}\n")], found);
        check(&[(A, "fn a() {\n    std::unimplemented!()\n}\n")], found);
        check(&[(A, "fn a() {\n    b(dbg!(1))\n}\n")], found);
        check(&[(A, "#[test]\n#[ignore]\nfn a() {}\n")], found);
        check(&[(A, "#[test]\n#[cfg_attr(windows, ignore)]\nfn a() {}\n")], found);
        check(&[(A, "proptest! {\n    #[ignore = \"slow\"]\n    fn a() {}\n}\n")], found);
        check(&[(A, "/// Not `todo!`.\nfn a() -> &'static str {\n    \"dbg!\"\n}\n")], &[]);
    }
}
