//! Values as text: a row is a line.

use super::Values;
use super::header::{Element, Scalar};
use crate::io::error::{Fault, Place, lossy};
use crate::io::text::{self, Lines, Words};

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

    fn rows_left(&self, element: &Element) -> u64 {
        // Each value takes a digit and a separator, but for the last separator.
        (self.lines.rest().len() as u64 + 1) / (2 * element.properties.len() as u64)
    }
}
