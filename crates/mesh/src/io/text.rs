//! Lines, words and numbers of text files.

use std::ops::ControlFlow;

use memchr::memchr;

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
        Self::after(0, bytes)
    }

    /// The lines of a text that so many come before.
    pub(super) fn after(number: u64, bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, number }
    }

    /// The next line, without its end.
    pub(super) fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let length = memchr(b'\n', rest).unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        self.number += 1;
        let line = &rest[..length];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Takes the next line as far as `plain` understands it, which must then be to its end.
    pub(super) fn take_plain(&mut self, plain: impl FnOnce(&mut Plain<'a>) -> Option<()>) -> bool {
        let mut start = Plain { bytes: self.bytes, at: self.at };
        let is_understood = plain(&mut start).is_some();
        if is_understood {
            self.at = start.at;
            self.number += 1;
        }
        is_understood
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

/// A place in a text, from which what nearly all lines are made of is read in one go: some five times
/// as fast as line by line and word by word. Each step is `None` where the text is any other, though
/// it may be as good; the general way then reads the line anew.
pub(super) struct Plain<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Plain<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Passes over spaces and tabs, if there are any.
    pub(super) fn spaces(&mut self) {
        while let Some(b' ' | b'\t') = self.peek() {
            self.at += 1;
        }
    }

    /// Passes over a word and the spaces after it, of which there must be one.
    pub(super) fn keyword(&mut self, word: &[u8]) -> Option<()> {
        self.bytes[self.at..]
            .strip_prefix(word)
            .filter(|rest| matches!(rest, [b' ' | b'\t', ..]))?;
        self.at += word.len();
        self.spaces();
        Some(())
    }

    /// A number, and the spaces after it.
    pub(super) fn real(&mut self) -> Option<f32> {
        let (value, length) = fast_float2::parse_partial(&self.bytes[self.at..]).ok()?;
        self.at += length;
        self.end_word()?;
        Some(value)
    }

    /// Three numbers, and the spaces after them.
    pub(super) fn position(&mut self) -> Option<[f32; 3]> {
        Some([self.real()?, self.real()?, self.real()?])
    }

    /// Up to nine digits; what comes after them stays.
    pub(super) fn digits(&mut self) -> Option<u32> {
        let start = self.at;
        let mut value = 0;
        while let Some(digit @ b'0'..=b'9') = self.peek() {
            if self.at - start == 9 {
                return None;
            }
            value = 10 * value + u32::from(digit - b'0');
            self.at += 1;
        }
        (self.at > start).then_some(value)
    }

    /// A whole number of up to nine digits, and the spaces after it.
    pub(super) fn whole(&mut self) -> Option<u32> {
        let value = self.digits()?;
        self.end_word()?;
        Some(value)
    }

    /// Passes over what follows a vertex in a corner of an OBJ face, `/2/3` if anything, and the
    /// spaces after it.
    pub(super) fn skip_reference(&mut self) -> Option<()> {
        if self.peek() == Some(b'/') {
            while let Some(b'/' | b'-' | b'0'..=b'9') = self.peek() {
                self.at += 1;
            }
        }
        self.end_word()
    }

    /// Passes over so many words that are no comments, and the spaces after them.
    pub(super) fn skip_words(&mut self, count: usize) -> Option<()> {
        for _ in 0..count {
            if self.is_at_end() {
                return None;
            }
            while self.peek().is_some_and(|byte| !byte.is_ascii_whitespace()) {
                self.at += 1;
            }
            self.end_word()?;
        }
        Some(())
    }

    /// Whether this is the end of the line.
    pub(super) fn is_at_end(&self) -> bool {
        matches!(self.bytes[self.at..], [] | [b'\n', ..] | [b'\r', b'\n', ..])
    }

    /// The end of the line.
    pub(super) fn end_line(&mut self) -> Option<()> {
        self.at += match self.bytes[self.at..] {
            [] => 0,
            [b'\n', ..] => 1,
            [b'\r', b'\n', ..] => 2,
            _ => return None,
        };
        Some(())
    }

    /// Passes over the rest of the line, unless it ends with `\`.
    pub(super) fn skip_line(&mut self) -> Option<()> {
        if self.end_line().is_some() {
            return Some(());
        }
        let rest = &self.bytes[self.at..];
        let length = memchr(b'\n', rest).unwrap_or(rest.len());
        let line = &rest[..length];
        if line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\") {
            return None;
        }
        self.at += (length + 1).min(rest.len());
        Some(())
    }

    /// The end of a word, and the spaces after it.
    fn end_word(&mut self) -> Option<()> {
        if let Some(b' ' | b'\t') = self.peek() {
            self.spaces();
            return Some(());
        }
        self.is_at_end().then_some(())
    }
}

/// Cuts a text into pieces of some `size` bytes, each of whole lines, where `may_cut` holds of the text
/// before and after a line's end. Never none: an empty text is one piece.
pub(super) fn pieces(
    text: &[u8],
    size: usize,
    may_cut: impl Fn(&[u8], &[u8]) -> bool,
) -> Vec<&[u8]> {
    let mut pieces = Vec::with_capacity(text.len() / size + 1);
    let mut rest = text;
    while rest.len() > size {
        let mut cuts = memchr::memchr_iter(b'\n', &rest[size - 1..]).map(|end| size + end);
        let cut = cuts.try_for_each(|cut| {
            let (piece, after) = rest.split_at(cut);
            if may_cut(piece, after) { ControlFlow::Break(cut) } else { ControlFlow::Continue(()) }
        });
        let ControlFlow::Break(cut) = cut else { break };
        let (piece, after) = rest.split_at(cut);
        pieces.push(piece);
        rest = after;
    }
    if !rest.is_empty() || pieces.is_empty() {
        pieces.push(rest);
    }
    pieces
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
    fast_float2::parse(word).map_err(|_| Fault::NotANumber { text: lossy(word) })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_whole_lines() {
        let text = b"one\ntwo\\\nthree\r\n\nfour";
        let no_matter = |_: &[u8], _: &[u8]| true;
        for size in 1..30 {
            let found = pieces(text, size, no_matter);
            assert_eq!(found.concat(), text);
            let (_, others) = found.split_last().unwrap();
            assert!(others.iter().all(|piece| piece.ends_with(b"\n") && piece.len() >= size));
            assert!(
                others.iter().all(|piece| !piece[..piece.len() - 1][size - 1..].contains(&b'\n'))
            );
            let joined = pieces(text, size, |before, _| !before.ends_with(b"\\\n"));
            assert!(joined.iter().all(|piece| !piece.ends_with(b"two\\\n")), "{size}");
        }
        assert_eq!(pieces(b"", 9, no_matter), [b""]);
    }

    #[test]
    fn plain_words_end_where_others_begin() {
        let plain = |text: &'static str| Plain { bytes: text.as_bytes(), at: 0 };
        assert_eq!(plain("-1.5e1 \t2").real(), Some(-15.0));
        assert_eq!(plain("1.5\r\n").real(), Some(1.5));
        for other in ["1.5x", "1,5", "", " 1", "1\r2", "1\x0c"] {
            assert_eq!(plain(other).real(), None, "{other:?}");
        }
        assert_eq!(plain("012 ").whole(), Some(12));
        for other in ["-1", "1.", "1234567890", "x", "", "1/2"] {
            assert_eq!(plain(other).whole(), None, "{other:?}");
        }
        assert_eq!(plain("f\t1").keyword(b"f"), Some(()));
        for other in ["f", "f\n1", "fo 1", "of 1"] {
            assert_eq!(plain(other).keyword(b"f"), None, "{other:?}");
        }
    }
}
