//! Values as bytes, without gaps.

use super::Values;
use super::header::{Element, Scalar};
use crate::io::error::{Fault, Place};

pub(super) struct Binary<'a> {
    /// Bytes of the whole file.
    length: usize,
    rest: &'a [u8],
    little_endian: bool,
}

impl<'a> Binary<'a> {
    /// The values in `rest`, which is the end of `file`.
    pub(super) fn new(file: &'a [u8], rest: &'a [u8], little_endian: bool) -> Self {
        Self { length: file.len(), rest, little_endian }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or_else(|| self.cut_off(N))?;
        self.rest = rest;
        let mut bytes = *bytes;
        if !self.little_endian {
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

    fn rows_left(&self, element: &Element) -> u64 {
        let sizes = element.properties.iter().map(|p| p.length.unwrap_or(p.value).size() as u64);
        self.rest.len() as u64 / sizes.sum::<u64>().max(1)
    }
}
