//! How much is in a file, without reading it.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use super::Format;
#[cfg(feature = "ply")]
use super::ply;
#[cfg(any(feature = "obj", feature = "stl"))]
use super::text::{Lines, Words};

/// Bytes from which a text is judged, in this many places spread evenly over the file.
const SAMPLE: usize = 1 << 16;
const SAMPLES: u64 = 16;

/// About how much a file holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Bytes of the file.
    pub bytes: u64,
    /// Vertices.
    pub vertices: u64,
    /// Triangles, once polygons are cut.
    pub triangles: u64,
}

/// About how many vertices and triangles a file holds, to judge beforehand whether it fits in memory.
///
/// Of binary PLY and STL what their headers say, but no more than there are bytes for; of a text what a
/// megabyte of its lines lets expect: within a tenth where each kind is alike, and the order of size
/// anywhere. `None` for glTF, whose JSON would have to be read, for what is no regular file, and for what
/// is not understood: the reader will say what is wrong.
///
/// # Errors
/// The file cannot be read.
pub fn estimate(path: &Path) -> io::Result<Option<Estimate>> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
    let about = path.metadata()?;
    if !about.is_file() {
        return Ok(None);
    }
    let (mut file, bytes) = (File::open(path)?, about.len());
    let found = match Format::of_extension(&extension) {
        #[cfg(feature = "obj")]
        Some(Format::Obj) => Some(by_lines(&mut file, bytes, &statement)?),
        #[cfg(feature = "ply")]
        Some(Format::Ply) => ply::estimate(&sample(&mut file, 0)?, bytes),
        #[cfg(feature = "stl")]
        Some(Format::Stl) => Some(stl(&mut file, bytes)?),
        _ => None,
    };
    Ok(found.map(|[vertices, triangles]| Estimate { bytes, vertices, triangles }))
}

/// Vertices and triangles of one line of OBJ.
#[cfg(feature = "obj")]
fn statement(line: &[u8]) -> [u64; 2] {
    let mut words = Words(line);
    match words.next() {
        Some(b"v") => [1, 0],
        Some(b"f") => [0, (words.count() as u64).saturating_sub(2)],
        _ => [0, 0],
    }
}

#[cfg(feature = "stl")]
fn stl(file: &mut File, bytes: u64) -> io::Result<[u64; 2]> {
    let start = sample(file, 0)?;
    if super::format::is_ascii_stl(&start) {
        let is_vertex = |line: &[u8]| {
            let word = Words(line).next().unwrap_or_default();
            [u64::from(word.eq_ignore_ascii_case(b"vertex")), 0]
        };
        let [vertices, _] = by_lines(file, bytes, &is_vertex)?;
        return Ok([vertices, vertices / 3]);
    }
    let count = start.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let triangles = u64::from(count.unwrap_or(0)).min(bytes / 50);
    Ok([3 * triangles, triangles])
}

/// Vertices and triangles of a text, from some of its lines.
#[cfg(any(feature = "obj", feature = "stl"))]
fn by_lines(
    file: &mut File,
    bytes: u64,
    of_line: &dyn Fn(&[u8]) -> [u64; 2],
) -> io::Result<[u64; 2]> {
    let (mut seen, mut found) = (0u64, [0u64; 2]);
    let places =
        if bytes <= SAMPLES * SAMPLE as u64 { bytes.div_ceil(SAMPLE as u64) } else { SAMPLES };
    for place in 0..places {
        let from = bytes / places * place;
        let text = sample(file, from)?;
        let mut lines = Lines::new(&text);
        // But for the first sample, the first line is likely to be the end of one; the last line the
        // beginning of one, but at the end of the file.
        if place > 0 {
            lines.next_line();
        }
        let whole = lines.rest();
        let is_last = from + text.len() as u64 >= bytes;
        let end = whole.iter().rposition(|&byte| byte == b'\n').filter(|_| !is_last);
        let end = end.map_or(whole.len(), |end| end + 1);
        let mut lines = Lines::new(&whole[..end]);
        while let Some(line) = lines.next_line() {
            let more = of_line(line);
            found = [found[0] + more[0], found[1] + more[1]];
        }
        seen += end as u64;
    }
    let scale = |count: u64| {
        let all = u128::from(count) * u128::from(bytes) / u128::from(seen.max(1));
        u64::try_from(all).unwrap_or(u64::MAX)
    };
    Ok(found.map(scale))
}

/// Up to [`SAMPLE`] bytes from a place in a file.
fn sample(file: &mut File, from: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(from))?;
    let mut bytes = Vec::with_capacity(SAMPLE);
    file.take(SAMPLE as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}
