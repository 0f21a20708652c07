//! Wavefront OBJ.
//!
//! Read here rather than by a crate, because each of those at hand breaks a promise of ours: `tobj`
//! renumbers vertices per object and says no line, `obj-rs` panics on free-form keywords and fails
//! on unknown ones, `obj` does not check indices, `wavefront_obj` renumbers. Of the format only
//! positions, faces and names are read.

use glam::Vec3;

use super::error::{Fault, Place, ReadError, lossy};
use super::parts::{self, Model, Parts};
use super::polygon::Faces;
use super::text::{self, Lines, Words};

/// Reads an OBJ file: `v`, `f`, `o`, `g` and `usemtl` statements; all others are ignored.
pub(super) fn parse(bytes: &[u8]) -> Result<Model, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if let Some(byte) = bytes.iter().position(|&byte| byte == 0) {
        return Err(Fault::NotText.at(Place::Byte(byte as u64)));
    }
    let mut reader = Reader::default();
    let mut lines = Lines::new(bytes);
    let mut joined = Vec::new();
    while let Some(line) = lines.next_line() {
        let number = lines.number();
        let line = join(line, &mut lines, &mut joined);
        reader.statement(line, number).map_err(|fault| fault.on_line(number))?;
    }
    reader.finish()
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

#[derive(Default)]
struct Reader {
    positions: Vec<Vec3>,
    faces: Faces,
    parts: Parts,
    materials: Parts,
    /// Faces that use a vertex not seen yet, each with that vertex, from 1, and its line; only
    /// those that reach further than all before them.
    ahead: Vec<(u64, u64)>,
    corners: Vec<u32>,
}

impl Reader {
    fn statement(&mut self, line: &[u8], number: u64) -> Result<(), Fault> {
        let mut words = Words(line);
        match words.next() {
            Some(b"v") => self.vertex(words),
            Some(b"f") => self.face(words, number),
            Some(b"o" | b"g") => {
                let name = lossy(words.0.trim_ascii());
                self.parts.begin(name, self.faces.triangle_count());
                Ok(())
            }
            Some(b"usemtl") => {
                let name = lossy(words.0.trim_ascii());
                self.materials.begin(name, self.faces.triangle_count());
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// After x, y and z may come a weight or a colour.
    fn vertex(&mut self, words: Words<'_>) -> Result<(), Fault> {
        let position = text::position(words.take_while(|word| word[0] != b'#'))?;
        self.positions.push(position.into());
        if position.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(Fault::NotFinite { vertex: self.positions.len() as u64, position })
        }
    }

    fn face(&mut self, words: Words<'_>, line: u64) -> Result<(), Fault> {
        self.corners.clear();
        for word in words.take_while(|word| word[0] != b'#') {
            let vertex = self.corner(word, line)?;
            self.corners.push(vertex);
        }
        if self.corners.len() < 3 {
            return Err(Fault::TooFewCorners { corners: self.corners.len() });
        }
        self.faces.push(&self.corners);
        Ok(())
    }

    /// The vertex, from 0, of `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: &[u8], line: u64) -> Result<u32, Fault> {
        let end = word.iter().position(|&byte| byte == b'/').unwrap_or(word.len());
        let not_an_index = || Fault::NotAnIndex { text: lossy(word) };
        let vertex: i64 = text::integer(&word[..end]).ok_or_else(not_an_index)?;
        let seen = self.positions.len() as u64;
        let index = match vertex {
            0 => return Err(Fault::ZeroIndex),
            1.. => vertex.unsigned_abs() - 1,
            _ => seen
                .checked_sub(vertex.unsigned_abs())
                .ok_or(Fault::RelativeOutOfRange { vertex, vertex_count: seen })?,
        };
        let short = u32::try_from(index).unwrap_or(u32::MAX);
        let furthest = self.ahead.last().map_or(0, |&(furthest, _)| furthest);
        if (index >= seen || short == u32::MAX) && index >= furthest {
            self.ahead.push((index + 1, line));
        }
        Ok(short)
    }

    fn finish(self) -> Result<Model, ReadError> {
        let vertex_count = self.positions.len() as u64;
        let reachable = vertex_count.min(u64::from(u32::MAX));
        if let Some(&(vertex, line)) = self.ahead.iter().find(|(vertex, _)| *vertex > reachable) {
            let vertex = i64::try_from(vertex).unwrap_or(i64::MAX);
            return Err(Fault::VertexOutOfRange { vertex, vertex_count }.on_line(line));
        }
        let triangles = self.faces.into_triangles(&self.positions);
        parts::model(self.positions, triangles, self.parts, self.materials)
    }
}
