//! Budgets: lines of a file, of a function, of a shader, and parameters.

use super::Finding;
use super::tree::{File, Tree, is_test_only};
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Block, FnArg, Signature};

/// Lines of a Rust file without its test modules; tests and examples are exempt.
const FILE: usize = 400;
/// Lines of any Rust file, tests and all.
const FILE_STOP: usize = 700;
/// Lines from `fn` to the closing brace.
const FUNCTION: usize = 60;
/// Not counting `self`.
const PARAMETERS: usize = 5;
/// Lines of a WGSL file.
const SHADER: usize = 150;

pub(crate) fn files(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for file in tree.with_extension("rs") {
        let all = file.text.lines().count();
        let tested = all - test_lines(file);
        if all > FILE_STOP {
            found.push(file.finding(1, format!("{all} lines, at most {FILE_STOP} with tests")));
        } else if tested > FILE && !file.is_test {
            found.push(file.finding(1, format!("{tested} lines without tests, at most {FILE}")));
        }
    }
    found
}

pub(crate) fn shaders(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for file in tree.with_extension("wgsl") {
        let lines = file.text.lines().count();
        if lines > SHADER {
            found.push(file.finding(1, format!("{lines} lines, at most {SHADER}")));
        }
    }
    found
}

pub(crate) fn functions(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for (file, function) in every_function(tree) {
        let lines = function.last_line + 1 - function.line;
        if lines > FUNCTION && !explains_length(&file.text, &function) {
            let what = format!("`{}` has {lines} lines, at most {FUNCTION}", function.name);
            found.push(file.finding(function.line, what));
        }
    }
    found
}

pub(crate) fn parameters(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for (file, function) in every_function(tree) {
        if function.parameters > PARAMETERS {
            let Function { name, parameters, .. } = &function;
            let what = format!("`{name}` takes {parameters} parameters, at most {PARAMETERS}");
            found.push(file.finding(function.line, what));
        }
    }
    found
}

/// Lines within `#[cfg(test)] mod … { }` at the top of the file, attributes included.
fn test_lines(file: &File) -> usize {
    let items = file.rust.iter().flat_map(|rust| &rust.items);
    let spans = items.filter_map(|item| match item {
        syn::Item::Mod(module) if is_test_only(module) => {
            let (brace, _) = module.content.as_ref()?;
            let first = first_line(&module.attrs).unwrap_or(brace.span.open().start().line);
            Some(brace.span.close().end().line + 1 - first)
        }
        _ => None,
    });
    spans.sum()
}

/// A function with a body, wherever it stands.
struct Function {
    name: String,
    /// Of its first attribute or doc comment, else of `fn`.
    first_line: usize,
    /// Of the word `fn`.
    line: usize,
    /// Of the closing brace.
    last_line: usize,
    parameters: usize,
}

/// A line `// Long because …` in the function or in the comments and attributes above it.
fn explains_length(text: &str, function: &Function) -> bool {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let above = lines[..function.first_line - 1].iter().rev();
    let comment = above.take_while(|line| line.starts_with("//") || line.starts_with("#["));
    let own = &lines[function.first_line - 1..function.last_line];
    comment.chain(own).any(|line| line.starts_with("// Long because "))
}

fn every_function(tree: &Tree) -> Vec<(&File, Function)> {
    let mut all = Vec::new();
    for (file, rust) in tree.rust() {
        let mut functions = Functions::default();
        rust.items.iter().for_each(|item| functions.visit_item(item));
        all.extend(functions.found.into_iter().map(|function| (file, function)));
    }
    all
}

#[derive(Default)]
struct Functions {
    found: Vec<Function>,
}

impl Functions {
    fn add(&mut self, attributes: &[Attribute], signature: &Signature, body: &Block) {
        let line = signature.fn_token.span.start().line;
        let is_typed = |argument: &&FnArg| matches!(argument, FnArg::Typed(_));
        self.found.push(Function {
            name: signature.ident.to_string(),
            first_line: first_line(attributes).unwrap_or(line),
            line,
            last_line: body.brace_token.span.close().end().line,
            parameters: signature.inputs.iter().filter(is_typed).count(),
        });
    }

    /// Functions within a macro call, such as `proptest!`, are known by their tokens only:
    /// `fn`, a name, and the next braces. Their parameters are the macro's own matter.
    fn add_from_macro(&mut self, tokens: TokenStream) {
        let mut open: Option<(usize, Ident)> = None;
        let mut after_fn = None;
        for token in tokens {
            match token {
                TokenTree::Ident(word) if word == "fn" => after_fn = Some(word.span().start().line),
                TokenTree::Ident(name) => {
                    if let Some(line) = after_fn.take() {
                        open = Some((line, name));
                    }
                }
                TokenTree::Group(group) => {
                    after_fn = None;
                    if group.delimiter() == Delimiter::Brace
                        && let Some((line, name)) = open.take()
                    {
                        let last_line = group.span_close().end().line;
                        let name = name.to_string();
                        self.found.push(Function {
                            name,
                            first_line: line,
                            line,
                            last_line,
                            parameters: 0,
                        });
                    }
                    self.add_from_macro(group.stream());
                }
                TokenTree::Punct(_) | TokenTree::Literal(_) => after_fn = None,
            }
        }
    }
}

impl<'ast> Visit<'ast> for Functions {
    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        self.add(&function.attrs, &function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        self.add(&function.attrs, &function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast syn::TraitItemFn) {
        if let Some(body) = &function.default {
            self.add(&function.attrs, &function.sig, body);
        }
        visit::visit_trait_item_fn(self, function);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.add_from_macro(call.tokens.clone());
    }
}

fn first_line(attributes: &[Attribute]) -> Option<usize> {
    attributes.iter().map(|attribute| attribute.pound_token.span.start().line).min()
}

#[cfg(test)]
mod tests {
    use super::super::testing::check;

    const A: &str = "crates/mesh/src/a.rs";

    fn lines(count: usize) -> String {
        "// A line.\n".repeat(count)
    }

    /// A function of `count` lines.
    fn function(count: usize) -> String {
        format!("fn a() {{\n{}}}\n", "    // A line.\n".repeat(count - 2))
    }

    #[test]
    fn a_file_has_400_lines_without_its_tests() {
        let tests = format!("#[cfg(test)]\nmod tests {{\n{}}}\n", lines(100));
        check(&[(A, &lines(400))], &[]);
        check(&[(A, &lines(401))], &["crates/mesh/src/a.rs:1 file-length"]);
        check(&[(A, &(lines(400) + &tests))], &[]);
        check(&[(A, &(lines(401) + &tests))], &["crates/mesh/src/a.rs:1 file-length"]);
        let not_tests = tests.replace("cfg(test)", "cfg(not(test))");
        check(&[(A, &(lines(400) + &not_tests))], &["crates/mesh/src/a.rs:1 file-length"]);
    }

    #[test]
    fn a_file_of_tests_may_be_longer_up_to_700() {
        check(&[("crates/mesh/tests/a.rs", &lines(700))], &[]);
        check(
            &[("crates/mesh/examples/a.rs", &lines(701))],
            &["crates/mesh/examples/a.rs:1 file-length"],
        );
        let parent = ("crates/mesh/src/a.rs", "#[cfg(all(test, unix))]\nmod b;\n");
        check(&[parent, ("crates/mesh/src/a/b.rs", &lines(500))], &[]);
        let tests = format!("#[cfg(test)]\nmod tests {{\n{}}}\n", lines(600));
        check(&[(A, &(lines(98) + &tests))], &["crates/mesh/src/a.rs:1 file-length"]);
    }

    #[test]
    fn a_function_has_60_lines_or_a_reason() {
        check(&[(A, &function(60))], &[]);
        check(&[(A, &(lines(3) + &function(61)))], &["crates/mesh/src/a.rs:4 function-length"]);
        check(
            &[(
                A,
                &format!("// Long because of its cases.\n/// Docs.\n#[inline]\n{}", function(61)),
            )],
            &[],
        );
        check(
            &[(A, &format!("a! {{\n// Long because it is.\n#[test]\n{}}}\n", function(61)))],
            &[],
        );
        check(&[(A, &function(61).replacen("// A line.", "// Long because it is.", 1))], &[]);
    }

    #[test]
    fn a_reason_serves_the_next_function_only() {
        let two = format!("// Long because it is.\n{}{}", function(61), function(61));
        check(&[(A, &two)], &["crates/mesh/src/a.rs:63 function-length"]);
    }

    #[test]
    fn functions_are_found_wherever_they_stand() {
        let long = function(61);
        let found = &["crates/mesh/src/a.rs:2 function-length"];
        check(&[(A, &format!("impl A {{\n{long}}}\n"))], found);
        check(&[(A, &format!("trait A {{\n{long}}}\n"))], found);
        check(&[(A, &format!("mod a {{\n{long}}}\n"))], found);
        check(&[(A, &format!("proptest! {{\n{long}}}\n"))], found);
        check(
            &[(A, &format!("fn b() {{\n{}}}\n", long.replace('a', "c")))],
            &["crates/mesh/src/a.rs:1 function-length", "crates/mesh/src/a.rs:2 function-length"],
        );
    }

    #[test]
    fn a_function_takes_five_parameters_and_self() {
        check(&[(A, "fn a(a: u8, b: u8, c: u8, d: u8, e: u8) {}\n")], &[]);
        check(&[(A, "impl A {\n    fn a(&self, a: u8, b: u8, c: u8, d: u8, e: u8) {}\n}\n")], &[]);
        let six = "\nfn a(a: u8, b: u8, c: u8, d: u8, e: u8, f: u8) {}\n";
        check(&[(A, six)], &["crates/mesh/src/a.rs:2 parameters"]);
    }

    #[test]
    fn a_shader_has_150_lines() {
        check(&[("shaders/a.wgsl", &lines(150))], &[]);
        check(&[("shaders/a.wgsl", &lines(151))], &["shaders/a.wgsl:1 shader-length"]);
    }
}
