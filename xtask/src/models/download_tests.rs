//! Downloads, from a server on the loopback address.

use super::catalogue::{Download, Mesh};
use super::get::{Outcome, all, one};
use super::{check, fetch};
use flate2::{Compression, write::GzEncoder};
use sha2::{Digest, Sha256};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use tempfile::TempDir;
use ureq::Agent;

#[derive(Clone, Copy)]
enum Manner {
    Ranges,
    IgnoresRanges,
    /// Promises everything, sends no more than this.
    BreaksOff(usize),
    NotFound,
}

/// Serves `content` at every address, until the test is over.
struct Server {
    url: &'static str,
    /// For each request, where its range begins and how many bytes were sent.
    requests: Receiver<(Option<usize>, usize)>,
}

impl Server {
    fn start(content: Vec<u8>, manner: Manner) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("it is bound");
        let (sender, requests) = channel();
        thread::spawn(move || {
            for stream in listener.incoming() {
                let answered = answer(&stream.expect("a connection"), &content, manner);
                if sender.send(answered).is_err() {
                    break;
                }
            }
        });
        Self { url: format!("http://{address}/mesh.obj").leak(), requests }
    }

    fn requests(&self) -> Vec<(Option<usize>, usize)> {
        self.requests.try_iter().collect()
    }
}

fn answer(mut stream: &TcpStream, content: &[u8], manner: Manner) -> (Option<usize>, usize) {
    let lines = BufReader::new(stream).lines().map(|line| line.expect("a line of the request"));
    let range = lines
        .take_while(|line| !line.is_empty())
        .find_map(|line| line.to_lowercase().strip_prefix("range: bytes=").map(str::to_owned));
    let range = range.map(|r| r.trim_end_matches('-').parse().expect("a range without an end"));
    let (status, begin) = match (manner, range) {
        (Manner::NotFound, _) => ("404 Not Found", content.len()),
        (Manner::Ranges, Some(begin)) => ("206 Partial Content", begin),
        _ => ("200 OK", 0),
    };
    let body = &content[begin..];
    let sent = if let Manner::BreaksOff(length) = manner { &body[..length] } else { body };
    let mut head =
        format!("HTTP/1.1 {status}\r\nConnection: close\r\nContent-Length: {}\r\n", body.len());
    if status.starts_with("206") {
        let (last, length) = (content.len() - 1, content.len());
        head += &format!("Content-Range: bytes {begin}-{last}/{length}\r\n");
    }
    // A client that has seen enough may close first.
    let _ =
        stream.write_all(format!("{head}\r\n").as_bytes()).and_then(|()| stream.write_all(sent));
    (range, sent.len())
}

fn content() -> Vec<u8> {
    (0..300_000_u32).flat_map(u32::to_le_bytes).collect()
}

fn sha256(content: &[u8]) -> &'static str {
    check::hex(&Sha256::digest(content)).leak()
}

fn mesh(content: &[u8], download: Option<Download>) -> Mesh {
    Mesh {
        name: "mesh.obj",
        faces: 1,
        good_for: "tests",
        terms: "none",
        source: "http://source.invalid/",
        page: "http://page.invalid/",
        file: "the-file.obj",
        size: content.len() as u64,
        sha256: sha256(content),
        download,
    }
}

/// Loopback needs no proxy, whatever the environment says.
fn agent() -> Agent {
    fetch::patience().proxy(None).build().into()
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("it exists").map(|entry| entry.expect("an entry"));
    let mut names: Vec<_> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Downloads with `part` there already, and gives the result and the requests that were made.
#[track_caller]
fn check_download(
    part: Option<&[u8]>,
    manner: Manner,
    expected_requests: &[(Option<usize>, usize)],
) {
    let (content, folder) = (content(), folder());
    let server = Server::start(content.clone(), manner);
    let mesh = mesh(&content, Some(Download::File { url: server.url }));
    if let Some(part) = part {
        fs::write(folder.path().join("mesh.obj.part"), part).expect("it can be written");
    }
    assert_eq!(one(&agent(), &mesh, folder.path()), Outcome::Downloaded);
    assert_eq!(names(folder.path()), ["mesh.obj"]);
    assert_eq!(fs::read(folder.path().join("mesh.obj")).expect("it is there"), content);
    assert_eq!(one(&agent(), &mesh, folder.path()), Outcome::WasThere);
    // The server reports a request when it has sent the answer, which is before we have read it.
    let mut requests = server.requests();
    while requests.len() < expected_requests.len() {
        requests.push(server.requests.recv().expect("the server runs"));
    }
    assert_eq!(requests, expected_requests);
}

#[track_caller]
fn check_failure(outcome: Outcome, folder: &Path, why: &str) {
    let Outcome::Failed(message) = outcome else { panic!("{outcome:?}") };
    assert!(message.contains(why), "{message}");
    let path = folder.join("mesh.obj");
    let way_out = format!(
        "by hand: from http://page.invalid/ get the-file.obj, put it at {}",
        path.display()
    );
    assert!(message.ends_with(&way_out) && !message.contains('\n'), "{message}");
    assert!(!path.exists());
}

#[test]
fn a_download_is_whole_and_only_what_is_missing_is_sent() {
    let (all, size) = (content(), content().len());
    check_download(None, Manner::Ranges, &[(None, size)]);
    check_download(Some(&[]), Manner::Ranges, &[(None, size)]);
    check_download(Some(&all[..1_000_000]), Manner::Ranges, &[(Some(1_000_000), 200_000)]);
    check_download(Some(&all), Manner::Ranges, &[]);
}

#[test]
fn a_server_without_ranges_starts_again() {
    let (all, size) = (content(), content().len());
    check_download(Some(&all[..1000]), Manner::IgnoresRanges, &[(Some(1000), size)]);
}

#[test]
fn a_part_that_cannot_become_the_file_is_dropped() {
    let size = content().len();
    check_download(Some(&vec![7; size]), Manner::Ranges, &[(None, size)]);
    check_download(Some(&vec![7; size + 1]), Manner::Ranges, &[(None, size)]);
}

#[test]
fn what_broke_off_is_resumed() {
    let (content, folder) = (content(), folder());
    let server = Server::start(content.clone(), Manner::BreaksOff(700_000));
    let first = mesh(&content, Some(Download::File { url: server.url }));
    check_failure(one(&agent(), &first, folder.path()), folder.path(), "after 700000 of 1200000");
    assert_eq!(names(folder.path()), ["mesh.obj.part"]);

    let server = Server::start(content.clone(), Manner::Ranges);
    let second = mesh(&content, Some(Download::File { url: server.url }));
    assert_eq!(one(&agent(), &second, folder.path()), Outcome::Downloaded);
    assert_eq!(server.requests.recv(), Ok((Some(700_000), 500_000)));
}

#[test]
fn another_file_is_not_kept() {
    let folder = folder();
    let check = |wanted: &[u8], why: &str| {
        let server = Server::start(content(), Manner::Ranges);
        let mesh = mesh(wanted, Some(Download::File { url: server.url }));
        check_failure(one(&agent(), &mesh, folder.path()), folder.path(), why);
    };
    let mut wanted = content();
    wanted[5] ^= 1;
    check(&wanted, "its SHA-256 is ");
    assert!(names(folder.path()).is_empty());
    // A wrong part is found out at the end.
    fs::write(folder.path().join("mesh.obj.part"), &wanted[..10]).expect("it can be written");
    wanted[20] ^= 1;
    check(&wanted, "its SHA-256 is ");
    assert!(names(folder.path()).is_empty());
    check(&content()[1..], "it has 1200000 bytes, not 1199999");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_failure_says_which_file_to_put_where() {
    let folder = folder();
    let server = Server::start(content(), Manner::NotFound);
    let not_found = mesh(&content(), Some(Download::File { url: server.url }));
    check_failure(one(&agent(), &not_found, folder.path()), folder.path(), "404");
    assert!(all(&agent(), &[&not_found], folder.path(), false).is_err());

    // A port that was free a moment ago.
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let url = format!("http://{}/", listener.local_addr().expect("it is bound")).leak();
    drop(listener);
    let refused = mesh(&content(), Some(Download::File { url }));
    check_failure(one(&agent(), &refused, folder.path()), folder.path(), "");

    let by_hand = mesh(&content(), None);
    let outcome = one(&agent(), &by_hand, folder.path());
    assert!(matches!(outcome, Outcome::ByHand(what) if what.contains("get the-file.obj, put it")));
    assert_eq!(all(&agent(), &[&by_hand], folder.path(), false), Ok(()));
    assert!(all(&agent(), &[&by_hand], folder.path(), true).is_err());
}

#[test]
fn a_file_that_is_there_is_left_alone() {
    let (content, folder) = (content(), folder());
    let server = Server::start(content.clone(), Manner::Ranges);
    let mesh = mesh(&content, Some(Download::File { url: server.url }));
    let path = folder.path().join("mesh.obj");
    fs::write(&path, &content).expect("it can be written");
    assert_eq!(one(&agent(), &mesh, folder.path()), Outcome::WasThere);
    fs::write(&path, "mine").expect("it can be written");
    let outcome = one(&agent(), &mesh, folder.path());
    assert!(
        matches!(outcome, Outcome::ByHand(what) if what.contains("it has 4 bytes, not 1200000"))
    );
    assert_eq!(all(&agent(), &[&mesh], folder.path(), false), Ok(()));
    assert_eq!(all(&agent(), &[&mesh], folder.path(), true), Err("1 of 1 not obtained".to_owned()));
    assert_eq!(fs::read(&path).expect("it is there"), b"mine");
    assert_eq!(server.requests(), []);
}

#[test]
fn a_mesh_is_taken_out_of_its_archive() {
    let mut builder = tar::Builder::new(GzEncoder::new(Vec::new(), Compression::fast()));
    for (path, content) in [("a/other.obj", &b"other"[..]), ("a/mesh.obj", &content())] {
        let mut header = tar::Header::new_gnu();
        header.set_size(content.len() as u64);
        header.set_mode(0o644);
        builder.append_data(&mut header, path, content).expect("memory is there");
    }
    let archive = builder.into_inner().and_then(GzEncoder::finish).expect("memory is there");
    let server = Server::start(archive.clone(), Manner::Ranges);
    let (size, sha256, folder) = (archive.len() as u64, sha256(&archive), folder());
    let check = |member, outcome: fn(&Outcome) -> bool, left: &[&str]| {
        let download = Download::Member { url: server.url, size, sha256, member };
        let result = one(&agent(), &mesh(&content(), Some(download)), folder.path());
        assert!(outcome(&result), "{result:?}");
        assert_eq!(names(folder.path()), left);
    };
    check("a/other.obj", |result| matches!(result, Outcome::Failed(_)), &[]);
    // The archive stays: it is right, and what is wrong is the path.
    let archive = "mesh.obj.tar.gz.part";
    check("mesh.obj", |result| matches!(result, Outcome::Failed(_)), &[archive]);
    check("a/mesh.obj", |result| *result == Outcome::Downloaded, &["mesh.obj"]);
    assert_eq!(fs::read(folder.path().join("mesh.obj")).expect("it is there"), content());
}
