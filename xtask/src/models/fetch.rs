//! One address into one file: resumed if it was begun, believed only if its hash is right.

use super::check::differs;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;
use std::time::Duration;
use ureq::{Agent, Error, config::ConfigBuilder, http::header, typestate::AgentScope};

/// What is to be had, and how it is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'a> {
    pub(crate) url: &'a str,
    /// In bytes.
    pub(crate) size: u64,
    pub(crate) sha256: &'a str,
}

/// Waits long enough for a slow server, and not for ever for a silent one. Proxies are those of the
/// environment.
pub(crate) fn patience() -> ConfigBuilder<AgentScope> {
    Agent::config_builder()
        .timeout_connect(Some(Duration::from_secs(30)))
        .timeout_recv_response(Some(Duration::from_secs(60)))
        .timeout_per_read(Some(Duration::from_secs(60)))
}

/// Downloads to `part`, going on from what is there.
///
/// # Errors
/// In words. `part` stays only if it is a beginning that the next call can go on from.
pub(crate) fn fetch(agent: &Agent, wanted: Wanted<'_>, part: &Path) -> Result<(), String> {
    let of_file = |e: io::Error| format!("{}: {e}", part.display());
    let mut have = fs::metadata(part).map_or(0, |found| found.len());
    let full = have >= wanted.size;
    if let Some(how) = check_if(full, wanted, part).map_err(of_file)? {
        println!("deleted {}: {how}", part.display());
        fs::remove_file(part).map_err(of_file)?;
        have = 0;
    }
    if have < wanted.size {
        receive(agent, wanted, part, have)?;
    }
    match differs(part, wanted.size, wanted.sha256).map_err(of_file)? {
        None => Ok(()),
        Some(how) => {
            fs::remove_file(part).map_err(of_file)?;
            Err(format!("not the file that was expected: {how}; it is deleted"))
        }
    }
}

fn check_if(full: bool, wanted: Wanted<'_>, part: &Path) -> io::Result<Option<String>> {
    if full { differs(part, wanted.size, wanted.sha256) } else { Ok(None) }
}

/// Appends to the `have` bytes of `part`, or starts again if the server sends everything.
fn receive(agent: &Agent, wanted: Wanted<'_>, part: &Path, have: u64) -> Result<(), String> {
    let of_file = |e: io::Error| format!("{}: {e}", part.display());
    // A compressed answer would be counted and resumed in other bytes than those of the file.
    let mut request = agent.get(wanted.url).header(header::ACCEPT_ENCODING, "identity");
    if have > 0 {
        request = request.header(header::RANGE, format!("bytes={have}-"));
    }
    let response = match request.call() {
        Err(Error::StatusCode(416)) => {
            fs::remove_file(part).map_err(of_file)?;
            return Err(format!("the server has no more than {have} bytes; the part is deleted"));
        }
        other => other.map_err(|e| e.to_string())?,
    };
    let range = response.headers().get(header::CONTENT_RANGE).and_then(|r| r.to_str().ok());
    let resumes = range.is_some_and(|range| range.starts_with(&format!("bytes {have}-")));
    let (begin, mut file) = match response.status().as_u16() {
        206 if resumes => (have, OpenOptions::new().append(true).open(part).map_err(of_file)?),
        200 => (0, File::create(part).map_err(of_file)?),
        status => return Err(format!("unexpected answer: status {status}, range {range:?}")),
    };
    let bar = bar(wanted.size, begin);
    // One byte more than expected is enough to know that the file is another one.
    let rest = response.into_body().into_reader().take(wanted.size - begin + 1);
    let copied = io::copy(&mut bar.wrap_read(rest), &mut file);
    bar.finish_and_clear();
    let reached = file.metadata().map_err(of_file)?.len();
    if reached >= wanted.size {
        return Ok(());
    }
    let why = copied.err().map_or_else(|| "the answer ended".to_owned(), |e| e.to_string());
    Err(format!("{why} after {reached} of {} bytes; the next run goes on from there", wanted.size))
}

/// Hidden if standard error is no terminal.
fn bar(size: u64, begin: u64) -> ProgressBar {
    let template = "  {wide_bar} {bytes} of {total_bytes}, {bytes_per_sec}, {eta} left";
    let style = ProgressStyle::with_template(template);
    let bar = ProgressBar::new(size).with_position(begin);
    bar.set_style(style.expect("the template is constant and right"));
    bar.reset_eta();
    bar
}
