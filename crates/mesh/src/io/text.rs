//! Lines, words and numbers of text files.

use super::error::{Fault, lossy};

/// Goes through a text line by line and counts.
#[derive(Debug)]
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    /// Offset of the next line.
    at: usize,
    /// Number of the line last returned, from 1.
    number: u64,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, number: 0 }
    }

    /// The next line, without its end.
    pub(super) fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        self.number += 1;
        let line = &rest[..length];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// What comes after the line last returned.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Number of the line last returned, from 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }
}

/// The words of a line, split at white space.
#[derive(Clone, Debug)]
pub(super) struct Words<'a>(pub(super) &'a [u8]);

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.0.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.0[start..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(length);
        self.0 = rest;
        Some(word)
    }
}

/// A number as the nearest f32, rounded once.
pub(super) fn real(word: &[u8]) -> Result<f32, Fault> {
    parse(word).ok_or_else(|| Fault::NotANumber { text: lossy(word) })
}

/// The first three of these words as coordinates.
pub(super) fn position<'a>(words: impl Iterator<Item = &'a [u8]>) -> Result<[f32; 3], Fault> {
    let mut position = [0.0; 3];
    let mut found = 0;
    for (coordinate, word) in position.iter_mut().zip(words) {
        *coordinate = real(word)?;
        found += 1;
    }
    if found < 3 { Err(Fault::TooFewNumbers { found, expected: 3 }) } else { Ok(position) }
}

/// A whole number; `None` if this is none.
pub(super) fn integer(word: &[u8]) -> Option<i64> {
    // So many digits cannot overflow. Most words of most files are such numbers, and the general
    // way looks at each digit three times.
    if (1..=18).contains(&word.len()) && word.iter().all(u8::is_ascii_digit) {
        return Some(word.iter().fold(0, |sum, digit| 10 * sum + i64::from(digit - b'0')));
    }
    parse(word)
}

/// Whatever can be parsed from text; `None` if this is not.
pub(super) fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
