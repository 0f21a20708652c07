//! Values as bytes, without gaps.

use super::header::{Element, Encoding, Header, Kind, Scalar};
use super::row::{Rows, Values};
use crate::io::error::{Fault, Place};

/// Rows of one element.
pub(super) struct Piece<'a> {
    pub(super) element: &'a Element,
    pub(super) first_row: u64,
    pub(super) rows: u64,
    /// From the first row to the end of the file.
    pub(super) bytes: &'a [u8],
}

/// Cuts what comes after the header into pieces of some `size` bytes. The last one may have rows for
/// which there are no bytes, or that cannot be read, and is then to be told of.
pub(super) fn pieces<'a>(header: &'a Header, bytes: &'a [u8], size: usize) -> Vec<Piece<'a>> {
    let mut pieces = Vec::with_capacity(bytes.len() / size + header.elements.len());
    let mut at = 0;
    for element in header.tables() {
        let mut first_row = 0;
        while first_row < element.count {
            let bytes = &bytes[at..];
            let most = element.count - first_row;
            let end = match element.row_size {
                Some(row_size) => rows_of_one_size(bytes, row_size, most, size),
                None => rows_of_any_size(bytes, header.encoding, element, most, size),
            };
            let Some([rows, length]) = end else {
                pieces.push(Piece { element, first_row, rows: most, bytes });
                return pieces;
            };
            pieces.push(Piece { element, first_row, rows: rows as u64, bytes });
            first_row += rows as u64;
            at += length;
        }
    }
    pieces
}

/// How many rows, and bytes, make a piece; `None` if there is not one row.
fn rows_of_one_size(bytes: &[u8], row_size: usize, most: u64, size: usize) -> Option<[usize; 2]> {
    let there = (bytes.len() / row_size).min(usize::try_from(most).unwrap_or(usize::MAX));
    let rows = there.min(size / row_size + 1);
    (rows > 0).then_some([rows, rows * row_size])
}

/// The same of rows with lists; `None` also if one cannot be read.
fn rows_of_any_size(
    bytes: &[u8],
    encoding: Encoding,
    element: &Element,
    most: u64,
    size: usize,
) -> Option<[usize; 2]> {
    let most = usize::try_from(most).unwrap_or(usize::MAX);
    let (mut rows, mut at) = (0, 0);
    // Nearly all files have faces that are one list of fewer than 256.
    if let [only] = &element.properties[..]
        && only.length == Some(Scalar::U8)
    {
        let value = only.value.size();
        while rows < most && at < size {
            at += 1 + usize::from(*bytes.get(at)?) * value;
            rows += 1;
        }
        return (at <= bytes.len()).then_some([rows, at]);
    }
    let mut values = Binary::new(bytes, bytes, encoding);
    while rows < most && bytes.len() - values.rest.len() < size {
        values.skip_row(element).ok()?;
        rows += 1;
    }
    Some([rows, bytes.len() - values.rest.len()])
}

pub(super) struct Binary<'a> {
    /// Bytes of the whole file.
    length: usize,
    rest: &'a [u8],
    encoding: Encoding,
}

impl<'a> Binary<'a> {
    /// The values in `rest`, which is the end of `file`.
    pub(super) fn new(file: &'a [u8], rest: &'a [u8], encoding: Encoding) -> Self {
        Self { length: file.len(), rest, encoding }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or_else(|| self.cut_off(N))?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn cut_off(&self, needed: usize) -> Fault {
        Fault::TooShort { needed: needed as u64, available: self.rest.len() as u64 }
    }

    /// Any scalar: f64 holds every value of every type.
    fn value(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    fn skip_row(&mut self, element: &Element) -> Result<(), Fault> {
        element.properties.iter().try_for_each(|property| {
            let count = property.length.map_or(Ok(1), |length| self.integer(length))?;
            let count = u64::try_from(count).map_err(|_| self.cut_off(0))?;
            self.skip(property.value, count)
        })
    }
}

impl Values for Binary<'_> {
    fn begin_row(&mut self) -> bool {
        !self.rest.is_empty()
    }

    #[expect(clippy::cast_possible_truncation, reason = "meshes are f32; beyond it is infinite")]
    fn real(&mut self, scalar: Scalar) -> Result<f32, Fault> {
        Ok(self.value(scalar)? as f32)
    }

    #[expect(clippy::cast_possible_truncation, reason = "only whole numbers below 2^53 pass")]
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault> {
        let value = self.value(scalar)?;
        if value.fract() == 0.0 && value.abs() < 2f64.powi(53) {
            Ok(value as i64)
        } else {
            Err(Fault::NotAnIndex { text: value.to_string() })
        }
    }

    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Fault> {
        let bytes = usize::try_from(count).ok().and_then(|count| count.checked_mul(scalar.size()));
        let bytes = bytes.unwrap_or(usize::MAX);
        self.rest = self.rest.get(bytes..).ok_or_else(|| self.cut_off(bytes))?;
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    fn place(&self, element: &str, row: u64) -> Place {
        let byte = (self.length - self.rest.len()) as u64;
        Place::Row { element: element.to_owned(), row, byte }
    }

    /// Vertices of f32 that begin with x, y and z and have no lists, and triangles of 32-bit indices
    /// of which nothing more is said.
    fn plain(&mut self, element: &Element, rows: &mut Rows<'_>) -> Option<()> {
        let is_big = self.encoding == Encoding::BigEndian;
        let integer = |bytes: &[u8; 4]| {
            if is_big { u32::from_be_bytes(*bytes) } else { u32::from_le_bytes(*bytes) }
        };
        let three = |bytes: &[u8]| {
            let (values, _) = bytes.as_chunks::<4>();
            let [a, b, c] = values.get(..3)? else { return None };
            Some([a, b, c].map(integer))
        };
        match element.kind {
            Kind::Vertex { xyz: [0, 1, 2] } => {
                let all = &element.properties[..3];
                let row_size =
                    element.row_size.filter(|_| all.iter().all(|p| p.value == Scalar::F32))?;
                let (row, rest) = self.rest.split_at_checked(row_size)?;
                rows.plain_vertex(three(row)?.map(f32::from_bits))?;
                self.rest = rest;
            }
            Kind::Face { .. } => {
                let [only] = &element.properties[..] else { return None };
                let is_plain = only.length == Some(Scalar::U8)
                    && matches!(only.value, Scalar::I32 | Scalar::U32);
                let (row, rest) = self.rest.split_at_checked(13)?;
                if !is_plain || row[0] != 3 {
                    return None;
                }
                rows.plain_triangle(three(&row[1..])?)?;
                self.rest = rest;
            }
            _ => return None,
        }
        Some(())
    }
}
