//! `cargo xtask models`: which meshes there are, which are at hand, and how to get the others.

use super::catalogue::{MESHES, Mesh, find};
use super::check::{State, state};
use super::{VARIABLE, fetch, get, named_folder};
use indicatif::{DecimalBytes, HumanCount};
use std::path::{self, Path, PathBuf};

const HELP: &str = "\
Usage: cargo xtask models [NAME...]
       cargo xtask models --download [--to DIR] [NAME...]

Lists the meshes that the figures in docs/ and the tests are made with: whether the folder
DRYPOINT_MODELS has them, their terms and where they come from. Any other mesh in that folder
is used as well.

  --download   get those that are missing and have an address, or say which file to put where;
               a file that is there is never overwritten, a download that broke off is resumed
  --to DIR     download into DIR; otherwise into the folder DRYPOINT_MODELS
";

#[derive(Debug, Default, PartialEq)]
struct Options {
    download: bool,
    to: Option<PathBuf>,
    names: Vec<String>,
}

pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    if arguments.iter().any(|argument| argument == "--help" || argument == "-h") {
        print!("{HELP}");
        return Ok(());
    }
    let options = parse(arguments)?;
    let meshes = find(&options.names)?;
    if !options.download {
        print!("{}", listing(&meshes, named_folder().as_deref()));
        return Ok(());
    }
    let folder = options.to.or_else(named_folder);
    let folder = folder.ok_or_else(|| format!("where to? Set {VARIABLE} or give --to DIR"))?;
    let folder = path::absolute(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    get::all(&fetch::patience().build().into(), &meshes, &folder, !options.names.is_empty())
}

fn parse(arguments: &[String]) -> Result<Options, String> {
    let mut options = Options::default();
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--download" => options.download = true,
            "--to" => {
                let folder = arguments.next().filter(|folder| !folder.is_empty());
                options.to = Some(folder.ok_or("`--to` needs a folder")?.into());
            }
            other if other.starts_with('-') => {
                return Err(format!(
                    "`models` takes no `{other}`; see `cargo xtask models --help`"
                ));
            }
            name => options.names.push(name.to_owned()),
        }
    }
    if options.to.is_some() && !options.download {
        return Err("`--to` goes with `--download`".to_owned());
    }
    Ok(options)
}

fn listing(meshes: &[&Mesh], folder: Option<&Path>) -> String {
    let mut present = 0;
    let mut entries = String::new();
    for mesh in meshes {
        let state = folder.map_or(State::Missing, |folder| state(mesh, &folder.join(mesh.name)));
        present += usize::from(state == State::Present);
        entries += &entry(mesh, &state, folder);
    }
    let looked = match folder {
        None => format!("looked nowhere, because {VARIABLE} is not set"),
        Some(folder) if folder.is_dir() => format!("looked in {VARIABLE}={}", folder.display()),
        Some(folder) => format!("looked in {VARIABLE}={}, which is no folder", folder.display()),
    };
    let mut text = format!("{present} of {} meshes present; {looked}\n{entries}", meshes.len());
    let others = folder.map(others).unwrap_or_default();
    if !others.is_empty() && meshes.len() == MESHES.len() {
        text += &format!("\nother meshes there: {}\n", others.join(", "));
    }
    text
}

fn entry(mesh: &Mesh, state: &State, folder: Option<&Path>) -> String {
    let path = folder.map_or_else(|| mesh.name.into(), |folder| folder.join(mesh.name));
    let path = path.display();
    let found = match state {
        State::Present => format!("present: {path}, size and hash are right"),
        State::Differs(how) => format!("differs: {path}, {how}"),
        State::Unreadable(why) => format!("unreadable: {path}: {why}"),
        State::Missing if mesh.download.is_some() => {
            let to = if folder.is_some() { "" } else { "--to DIR " };
            format!("missing: `cargo xtask models --download {to}{}` gets it", mesh.name)
        }
        State::Missing => {
            let to = folder.map_or_else(|| format!("${VARIABLE}").into(), Path::to_path_buf);
            format!("missing, without an address; {}", get::by_hand(mesh, &to))
        }
    };
    format!(
        "\n{}: {} faces, {}; {}\n  {found}\n  terms: {}\n  source: {}\n",
        mesh.name,
        HumanCount(mesh.faces.into()),
        DecimalBytes(mesh.size),
        mesh.good_for,
        mesh.terms,
        mesh.source,
    )
}

/// Names of meshes in the folder that the catalogue does not have.
fn others(folder: &Path) -> Vec<String> {
    let paths = super::meshes_in(folder).unwrap_or_default().into_iter();
    let names = paths.filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let mut names: Vec<_> = names.filter(|n| MESHES.iter().all(|mesh| mesh.name != n)).collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[track_caller]
    fn check(arguments: &[&str], expected: Result<Options, &str>) {
        let arguments: Vec<String> = arguments.iter().map(|&a| a.to_owned()).collect();
        assert_eq!(parse(&arguments), expected.map_err(str::to_owned));
    }

    #[test]
    fn arguments_are_understood_or_refused() {
        check(&[], Ok(Options::default()));
        let names = vec!["cow.obj".to_owned()];
        check(
            &["--download", "cow.obj", "--to", "x"],
            Ok(Options { download: true, to: Some("x".into()), names }),
        );
        check(&["--download", "--to"], Err("`--to` needs a folder"));
        check(&["--to", "x"], Err("`--to` goes with `--download`"));
        check(&["--fetch"], Err("`models` takes no `--fetch`; see `cargo xtask models --help`"));
    }

    #[test]
    fn the_listing_tells_missing_from_different_and_says_where_it_looked() {
        let meshes = find(&[]).expect("all");
        let text = listing(&meshes, None);
        assert!(text.starts_with("0 of 13 meshes present; looked nowhere, because"), "{text}");

        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["cow.obj", "b.ply", "A.STL", "notes.txt"] {
            fs::write(folder.path().join(name), "v 0 0 0\n").expect("it can be written");
        }
        let text = listing(&meshes, Some(folder.path()));
        assert!(text.contains(&folder.path().display().to_string()), "{text}");
        assert!(text.contains("cow.obj, it has 8 bytes, not 180177\n"), "{text}");
        assert!(text.contains("`cargo xtask models --download teapot.obj` gets it\n"), "{text}");
        assert!(text.ends_with("\nother meshes there: A.STL, b.ply\n"), "{text}");

        let missing = folder.path().join("missing");
        assert!(listing(&meshes, Some(&missing)).contains("missing, which is no folder"));
    }
}
