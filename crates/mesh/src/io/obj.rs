//! Wavefront OBJ.
//!
//! Read here rather than by a crate, because each of those at hand breaks a promise of ours: `tobj`
//! renumbers vertices per object and says no line, `obj-rs` panics on free-form keywords and fails
//! on unknown ones, `obj` does not check indices, `wavefront_obj` renumbers. Of the format only
//! positions, faces and names are read.
//!
//! A file is read in pieces, by all threads. What is wrong is found by reading it once more from its
//! beginning: only good files need to be fast.

use memchr::memchr;
use rayon::prelude::*;

use super::ReadOptions;
use super::content::Content;
use super::error::{Fault, Place, ReadError, lossy};
use super::parts::Model;
use super::text::{self, Lines, Plain, Words};

/// Reads an OBJ file: `v`, `f`, `o`, `g` and `usemtl` statements; all others are ignored.
pub(super) fn parse(bytes: &[u8], size: usize, options: &ReadOptions) -> Result<Model, ReadError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if let Some(content) = in_pieces(text, size, options) {
        return content.into_model();
    }
    match memchr(0, bytes) {
        Some(byte) => Err(Fault::NotText.at(Place::Byte(byte as u64))),
        None => in_one(text, options)?.into_model(),
    }
}

/// The content of a file that is good; of others `None`.
fn in_pieces(bytes: &[u8], size: usize, options: &ReadOptions) -> Option<Content> {
    // Where a line goes on it must not be cut. Comments do not go on, but may be longer pieces.
    let goes_on = |text: &[u8]| text.ends_with(b"\\\n") || text.ends_with(b"\\\r\n");
    let pieces = text::pieces(bytes, size, |before, _| !goes_on(before));
    let read = |text: &[u8], before: Option<u64>| {
        let mut reader = Reader { before, options: *options, ..Reader::default() };
        if memchr(0, text).is_some() { None } else { reader.read(text).ok().map(|()| reader) }
    };
    let first_is_known = |index: usize| (index == 0).then_some(0);
    let readers = pieces.par_iter().enumerate().map(|(i, text)| read(text, first_is_known(i)));
    let mut readers: Vec<Reader> = readers.collect::<Option<_>>()?;
    let counts = readers.iter().map(|reader| reader.content.positions.len() as u64);
    let befores: Vec<u64> =
        counts.scan(0, |sum, n| Some(std::mem::replace(sum, *sum + n))).collect();
    readers.par_iter_mut().zip(befores).zip(&pieces).try_for_each(|((reader, before), text)| {
        if reader.looks_back {
            *reader = read(text, Some(before))?;
        }
        Some(())
    })?;
    let furthest = readers.iter().map(|reader| reader.furthest).max().unwrap_or(0);
    let content = Content::joined(readers.into_iter().map(|reader| reader.content));
    (furthest <= reachable(content.positions.len() as u64)).then_some(content)
}

/// The same, or the first thing that is wrong.
fn in_one(bytes: &[u8], options: &ReadOptions) -> Result<Content, ReadError> {
    let start = Reader { before: Some(0), options: *options, ..Reader::default() };
    let mut reader = start.clone();
    reader.read(bytes)?;
    let vertex_count = reader.content.positions.len() as u64;
    if reader.furthest > reachable(vertex_count) {
        // Once more, now that it is known which vertices there are.
        reader = Reader { vertex_count: Some(vertex_count), ..start };
        reader.read(bytes)?;
    }
    Ok(reader.content)
}

/// How many of so many vertices a triangle can name.
fn reachable(vertex_count: u64) -> u64 {
    vertex_count.min(u64::from(u32::MAX))
}

/// Reads a piece of a file.
#[derive(Clone, Default)]
struct Reader {
    options: ReadOptions,
    /// Vertices before this piece, once they are counted.
    before: Option<u64>,
    /// Vertices of the file, if it is known that faces name others.
    vertex_count: Option<u64>,
    content: Content,
    /// The vertex named that is furthest from the first, counted from 1.
    furthest: u64,
    /// Counts vertices back from where it does not know how many there are: to be read once more.
    looks_back: bool,
    corners: Vec<u32>,
}

impl Reader {
    fn read(&mut self, text: &[u8]) -> Result<(), ReadError> {
        let mut lines = Lines::new(text);
        let mut joined = Vec::new();
        loop {
            if lines.take_plain(|line| self.plain(line)) {
                continue;
            }
            let Some(line) = lines.next_line() else { return Ok(()) };
            let number = lines.number();
            let line = join(line, &mut lines, &mut joined);
            self.statement(line).map_err(|fault| fault.on_line(number))?;
        }
    }

    /// Reads `v` and `f` as they are nearly always written.
    fn plain(&mut self, line: &mut Plain<'_>) -> Option<()> {
        if line.keyword(b"v").is_some() {
            let position = line.position()?;
            line.skip_line()?;
            return self.vertex(position).ok();
        }
        line.keyword(b"f")?;
        self.corners.clear();
        while !line.is_at_end() {
            let vertex = line.digits()?.checked_sub(1)?;
            line.skip_reference()?;
            self.corners.push(vertex);
        }
        line.end_line()?;
        let furthest = self.corners.iter().fold(self.furthest, |f, &v| f.max(u64::from(v) + 1));
        if self.corners.len() < 3 || self.vertex_count.is_some_and(|count| furthest > count) {
            return None;
        }
        self.furthest = furthest;
        self.content.faces.push(&self.corners);
        Some(())
    }

    fn statement(&mut self, line: &[u8]) -> Result<(), Fault> {
        let mut words = Words(line);
        let triangle_count = self.content.faces.triangle_count();
        match words.next() {
            // After x, y and z may come a weight or a colour.
            Some(b"v") => self.vertex(text::position(words.take_while(|word| word[0] != b'#'))?),
            Some(b"f") => self.face(words),
            Some(b"o" | b"g") => {
                let name = lossy(words.0.trim_ascii());
                self.content.parts.begin(name, triangle_count);
                Ok(())
            }
            Some(b"usemtl") => {
                let name = lossy(words.0.trim_ascii());
                self.content.materials.begin(name, triangle_count);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn vertex(&mut self, position: [f32; 3]) -> Result<(), Fault> {
        if self.options.strict && position.iter().any(|x| !x.is_finite()) {
            let vertex = self.content.positions.len() as u64 + 1;
            return Err(Fault::NotFinite { vertex, position });
        }
        self.content.positions.push(position.into());
        Ok(())
    }

    fn face(&mut self, words: Words<'_>) -> Result<(), Fault> {
        self.corners.clear();
        for word in words.take_while(|word| word[0] != b'#') {
            let vertex = self.corner(word)?;
            self.corners.push(vertex);
        }
        if self.corners.len() < 3 {
            return Err(Fault::TooFewCorners { corners: self.corners.len() });
        }
        self.content.faces.push(&self.corners);
        Ok(())
    }

    /// The vertex, from 0, of `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: &[u8]) -> Result<u32, Fault> {
        let end = word.iter().position(|&byte| byte == b'/').unwrap_or(word.len());
        let not_an_index = || Fault::NotAnIndex { text: lossy(word) };
        let vertex: i64 = text::integer(&word[..end]).ok_or_else(not_an_index)?;
        let index = match (vertex, self.before) {
            (0, _) => return Err(Fault::ZeroIndex),
            (1.., _) => vertex.unsigned_abs() - 1,
            (_, None) => {
                self.looks_back = true;
                return Ok(0);
            }
            (_, Some(before)) => {
                let seen = before + self.content.positions.len() as u64;
                seen.checked_sub(vertex.unsigned_abs())
                    .ok_or(Fault::RelativeOutOfRange { vertex, vertex_count: seen })?
            }
        };
        self.furthest = self.furthest.max(index + 1);
        if let Some(vertex_count) = self.vertex_count.filter(|&count| index >= reachable(count)) {
            return Err(Fault::VertexOutOfRange { vertex, vertex_count });
        }
        Ok(u32::try_from(index).unwrap_or(u32::MAX))
    }
}

/// The line with those that follow it after a `\`. Comments are not continued: they hold paths.
fn join<'a>(line: &'a [u8], lines: &mut Lines<'_>, joined: &'a mut Vec<u8>) -> &'a [u8] {
    if !line.ends_with(b"\\") || line.trim_ascii_start().starts_with(b"#") {
        return line;
    }
    joined.clear();
    let mut last = line;
    while let Some(start) = last.strip_suffix(b"\\") {
        joined.extend_from_slice(start);
        joined.push(b' ');
        last = lines.next_line().unwrap_or_default();
    }
    joined.extend_from_slice(last);
    joined
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;

    /// Lines of files, good and bad.
    const LINES: [&str; 24] = [
        "v 1 2 3",
        "v -1.5 2e1 .25 1 0 0.5",
        "v 3 1 4 \\",
        "v nan 1 2",
        "v 0 1e99 2 # far",
        "v 1 2",
        "v\t1\t2  7 ",
        "vn 0 0 1",
        "f 1 2 3",
        "f 1/2/3 2//1 3/1 1",
        "f 3 2 1 4 5",
        "f -1 -2 -3",
        "f 1 2 \\",
        "f 1 2 3 # face",
        "f 1 2",
        "f 0 1 2",
        "f 4 5 9",
        "o body",
        "g arm",
        "usemtl red",
        "usemtl",
        "# a path \\",
        "\\",
        "",
    ];

    fn outcome(content: Result<Content, ReadError>) -> Result<Model, String> {
        content.and_then(Content::into_model).map_err(|error| error.to_string())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn pieces_of_any_size_are_the_whole(
            lines in vec((select(&LINES[..]), select(&["\n", "\r\n"][..])), 0..40),
            good in any::<bool>(), size in 1usize..90, strict in any::<bool>(),
        ) {
            // So that not every file is bad, most have vertices first.
            let start = if good { "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 1 0\nv 0 0 5\n" } else { "" };
            let is_good = |line: &str| !good || !["v 1 2", "f 1 2", "f 0 1 2", "\\"].contains(&line);
            let lines = lines.iter().filter(|(line, _)| is_good(line));
            let text: String = lines.fold(start.to_owned(), |text, (line, end)| text + line + end);
            let options = ReadOptions { strict };
            let whole = in_one(text.as_bytes(), &options);
            let pieces = in_pieces(text.as_bytes(), size, &options);
            prop_assert_eq!(pieces.is_some(), whole.is_ok(), "{:?}", text);
            let expected = outcome(whole);
            if let Some(pieces) = pieces {
                prop_assert_eq!(&outcome(Ok(pieces)), &expected);
            }
            // No statement with a space before it is plain.
            let text = format!(" {}", text.replace('\n', "\n "));
            prop_assert_eq!(outcome(in_one(text.as_bytes(), &options)), expected);
        }
    }
}
