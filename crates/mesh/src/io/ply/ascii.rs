//! Values as text: a row is a line.

use memchr::memchr_iter;
use rayon::prelude::*;

use super::header::{Element, Header, Kind, Scalar};
use super::row::{Rows, Values};
use crate::io::error::{Fault, Place, lossy};
use crate::io::text::{self, Lines, Plain, Words};

/// Whole lines of a file.
pub(super) struct Piece<'a> {
    pub(super) lines: Lines<'a>,
    /// Rows before it, of all elements.
    pub(super) first_row: u64,
    /// Rows in it.
    pub(super) rows: u64,
    /// Rows that are not in it are nowhere.
    pub(super) is_last: bool,
}

/// Cuts what comes after the header into pieces of some `size` bytes.
pub(super) fn pieces<'a>(header: &Header, lines: Lines<'a>, size: usize) -> Vec<Piece<'a>> {
    let texts = text::pieces(lines.rest(), size, |_, _| true);
    let counts: Vec<[u64; 2]> = texts.par_iter().map(|text| lines_and_rows(text)).collect();
    let (mut line, mut first_row) = (lines.number(), 0u64);
    let rows_wanted = header.tables().fold(0u64, |sum, table| sum.saturating_add(table.count));
    let mut pieces = Vec::with_capacity(texts.len());
    for (text, [line_count, rows]) in texts.into_iter().zip(counts) {
        pieces.push(Piece { lines: Lines::after(line, text), first_row, rows, is_last: false });
        line += line_count;
        first_row += rows;
        // What comes after the last row is nobody's.
        if first_row >= rows_wanted {
            break;
        }
    }
    if let Some(last) = pieces.last_mut() {
        last.is_last = true;
    }
    pieces
}

/// How many lines a text has, and on how many of them there is something.
fn lines_and_rows(text: &[u8]) -> [u64; 2] {
    let (mut lines, mut rows, mut start) = (0, 0, 0);
    for end in memchr_iter(b'\n', text).chain((!text.ends_with(b"\n")).then_some(text.len())) {
        let line = &text[start..end];
        // The last line of a text without an end is none if there is nothing on it.
        lines += u64::from(start < text.len());
        rows += u64::from(line.iter().any(|byte| !byte.is_ascii_whitespace()));
        start = end + 1;
    }
    [lines, rows]
}

pub(super) struct Ascii<'a> {
    lines: Lines<'a>,
    /// What is left of the current row.
    words: Words<'a>,
    /// Values read from it.
    found: usize,
}

impl<'a> Ascii<'a> {
    pub(super) fn new(lines: Lines<'a>) -> Self {
        Self { lines, words: Words(&[]), found: 0 }
    }

    fn next(&mut self) -> Result<&'a [u8], Fault> {
        let found = self.found;
        self.found += 1;
        self.words.next().ok_or_else(|| Fault::TooFewNumbers { found, expected: found + 1 })
    }
}

impl Values for Ascii<'_> {
    fn begin_row(&mut self) -> bool {
        self.found = 0;
        loop {
            let Some(line) = self.lines.next_line() else { return false };
            self.words = Words(line);
            if self.words.clone().next().is_some() {
                return true;
            }
        }
    }

    fn real(&mut self, _: Scalar) -> Result<f32, Fault> {
        text::real(self.next()?)
    }

    fn integer(&mut self, _: Scalar) -> Result<i64, Fault> {
        let word = self.next()?;
        text::integer(word).ok_or_else(|| Fault::NotAnIndex { text: lossy(word) })
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Result<(), Fault> {
        (0..count).try_for_each(|_| self.next().map(drop))
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        let next = self.words.next();
        next.map_or(Ok(()), |word| Err(Fault::LeftOver { text: lossy(word) }))
    }

    fn place(&self, _: &str, _: u64) -> Place {
        Place::Line(self.lines.number())
    }

    /// Vertices that begin with x, y and z and have no lists, and triangles of which nothing more is
    /// said.
    fn plain(&mut self, element: &Element, rows: &mut Rows<'_>) -> Option<()> {
        let vertex = |line: &mut Plain<'_>, rows: &mut Rows<'_>| {
            line.spaces();
            let position = line.position()?;
            line.skip_words(element.properties.len() - 3)?;
            line.end_line()?;
            rows.plain_vertex(position)
        };
        let triangle = |line: &mut Plain<'_>, rows: &mut Rows<'_>| {
            line.spaces();
            if line.whole()? != 3 {
                return None;
            }
            let corners = [line.whole()?, line.whole()?, line.whole()?];
            line.end_line()?;
            rows.plain_triangle(corners)
        };
        let is_understood = match element.kind {
            Kind::Vertex { xyz: [0, 1, 2] } if element.row_size.is_some() => {
                self.lines.take_plain(|line| vertex(line, rows))
            }
            Kind::Face { .. } if element.properties.len() == 1 => {
                self.lines.take_plain(|line| triangle(line, rows))
            }
            _ => false,
        };
        is_understood.then_some(())
    }
}
