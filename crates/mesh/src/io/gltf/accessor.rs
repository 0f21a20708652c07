//! Typed views of buffers, checked once so that reading an element cannot fail.

use std::borrow::Cow;

use ::gltf::json::accessor::{ComponentType, IndexComponentType, Type};
use ::gltf::json::validation::{Checked, USize64};
use ::gltf::json::{Accessor, Index, buffer};

use super::document::{Document, object};
use crate::io::error::{Fault, Place, ReadError};

/// The elements of an accessor.
#[derive(Debug)]
pub(super) struct Elements<'a> {
    bytes: Cow<'a, [u8]>,
    count: usize,
    /// Bytes from one element to the next.
    stride: usize,
    component: ComponentType,
    /// Integers stand for −1 ..= 1 or 0 ..= 1.
    normalized: bool,
}

/// What an accessor must hold.
struct Wanted {
    shape: Type,
    components: &'static [ComponentType],
    name: &'static str,
}

impl<'a> Elements<'a> {
    /// Positions: three numbers of any type; integers by `KHR_mesh_quantization`.
    pub(super) fn positions(
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Self, ReadError> {
        use ComponentType::{F32, I8, I16, U8, U16};
        let components = &[F32, I8, U8, I16, U16];
        Wanted { shape: Type::Vec3, components, name: "VEC3 of numbers" }
            .read(document, accessor, place)
    }

    /// Vertex indices.
    pub(super) fn indices(
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Self, ReadError> {
        let components = &[ComponentType::U8, ComponentType::U16, ComponentType::U32];
        Wanted { shape: Type::Scalar, components, name: "SCALAR of unsigned integers" }
            .read(document, accessor, place)
    }

    /// Joints of vertices, four each.
    pub(super) fn joints(
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Self, ReadError> {
        let components = &[ComponentType::U8, ComponentType::U16];
        Wanted { shape: Type::Vec4, components, name: "VEC4 of unsigned bytes or shorts" }
            .read(document, accessor, place)
    }

    /// Weights of vertices, four each.
    pub(super) fn weights(
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Self, ReadError> {
        let components = &[ComponentType::F32, ComponentType::U8, ComponentType::U16];
        Wanted { shape: Type::Vec4, components, name: "VEC4 of weights" }
            .read(document, accessor, place)
    }

    /// Matrices, column by column.
    pub(super) fn matrices(
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Self, ReadError> {
        let components = &[ComponentType::F32];
        Wanted { shape: Type::Mat4, components, name: "MAT4 of floats" }
            .read(document, accessor, place)
    }

    /// Times of keys.
    pub(super) fn times(
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Self, ReadError> {
        let components = &[ComponentType::F32];
        Wanted { shape: Type::Scalar, components, name: "SCALAR of floats" }
            .read(document, accessor, place)
    }

    /// Values at keys, numbers or vectors.
    pub(super) fn curve_values(
        document: &'a Document<'_>,
        accessor: usize,
        shape: Type,
        place: &Place,
    ) -> Result<Self, ReadError> {
        use ComponentType::{F32, I8, I16, U8, U16};
        let name = match shape {
            Type::Scalar => "SCALAR of numbers",
            Type::Vec3 => "VEC3 of numbers",
            _ => "VEC4 of numbers",
        };
        Wanted { shape, components: &[F32, I8, U8, I16, U16], name }.read(document, accessor, place)
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// One component of an element as a real number.
    ///
    /// # Panics
    /// If `element` is not below [`Self::count`].
    pub(super) fn real(&self, element: usize, component: usize) -> f64 {
        let (value, most) = match self.component {
            ComponentType::F32 => {
                return f64::from(f32::from_le_bytes(self.at(element, component)));
            }
            ComponentType::I8 => {
                (f64::from(i8::from_le_bytes(self.at(element, component))), f64::from(i8::MAX))
            }
            ComponentType::I16 => {
                (f64::from(i16::from_le_bytes(self.at(element, component))), f64::from(i16::MAX))
            }
            ComponentType::U8 => (self.integer(element, component).into(), f64::from(u8::MAX)),
            ComponentType::U16 => (self.integer(element, component).into(), f64::from(u16::MAX)),
            ComponentType::U32 => (self.integer(element, component).into(), f64::from(u32::MAX)),
        };
        if self.normalized { (value / most).max(-1.0) } else { value }
    }

    /// One component of an element as an unsigned integer; 0 if its type is none.
    ///
    /// # Panics
    /// If `element` is not below [`Self::count`].
    pub(super) fn integer(&self, element: usize, component: usize) -> u32 {
        match self.component {
            ComponentType::U8 => u8::from_le_bytes(self.at(element, component)).into(),
            ComponentType::U16 => u16::from_le_bytes(self.at(element, component)).into(),
            ComponentType::U32 => u32::from_le_bytes(self.at(element, component)),
            ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => 0,
        }
    }

    fn at<const N: usize>(&self, element: usize, component: usize) -> [u8; N] {
        let start = element * self.stride + component * N;
        std::array::from_fn(|i| self.bytes[start + i])
    }
}

impl Wanted {
    fn read<'a>(
        &self,
        document: &'a Document<'_>,
        accessor: usize,
        place: &Place,
    ) -> Result<Elements<'a>, ReadError> {
        let json = object(&document.root.accessors, accessor, "accessors", place)?;
        let place = Place::Json(format!("accessors[{accessor}]"));
        let wrong_type = || Fault::WrongType { expected: self.name }.at(place.clone());
        let (Checked::Valid(component), Checked::Valid(shape)) = (json.component_type, &json.type_)
        else {
            return Err(wrong_type());
        };
        if *shape != self.shape || !self.components.contains(&component.0) {
            return Err(wrong_type());
        }
        let size = component.0.size() * shape.multiplicity();
        let base = match json.buffer_view {
            Some(view) => Some(span(document, view, json.byte_offset, (json.count, size), &place)?),
            None => None,
        };
        let elements = |bytes, count, stride| {
            let (component, normalized) = (component.0, json.normalized);
            Elements { bytes, count, stride, component, normalized }
        };
        if let (Some(base), None) = (&base, &json.sparse) {
            return Ok(elements(Cow::Borrowed(base.bytes), base.count, base.stride));
        }
        let (bytes, count) = sparse(document, json, base, size, &place)?;
        Ok(elements(Cow::Owned(bytes), count, size))
    }
}

/// Bytes that hold `count` elements.
struct Span<'a> {
    bytes: &'a [u8],
    count: usize,
    stride: usize,
}

/// The bytes of (count, size) elements of a view, from an offset on.
fn span<'a>(
    document: &'a Document<'_>,
    view: Index<buffer::View>,
    offset: Option<USize64>,
    (count, size): (USize64, usize),
    place: &Place,
) -> Result<Span<'a>, ReadError> {
    let json = object(&document.root.buffer_views, view.value(), "bufferViews", place)?;
    let view_place = Place::Json(format!("bufferViews[{}]", view.value()));
    let buffer = object(&document.buffers, json.buffer.value(), "buffers", &view_place)?;
    let part = |bytes: &'a [u8], offset: u64, length: u64, place: &Place| {
        let needed = offset.saturating_add(length);
        let range = usize::try_from(offset).ok().zip(usize::try_from(needed).ok());
        let bytes_there = range.and_then(|(start, end)| bytes.get(start..end));
        let available = bytes.len() as u64;
        bytes_there.ok_or_else(|| Fault::TooShort { needed, available }.at(place.clone()))
    };
    let start = json.byte_offset.map_or(0, |offset| offset.0);
    let bytes = part(buffer, start, json.byte_length.0, &view_place)?;

    // A stride of 0 is not allowed and means none in practice.
    let stride = json.byte_stride.map(|stride| stride.0).filter(|&stride| stride > 0);
    let stride = stride.unwrap_or(size);
    if stride < size {
        let fault = Fault::Stride { stride: stride as u64, size: size as u64 };
        return Err(fault.at(view_place));
    }
    let length = match count.0 {
        0 => 0,
        count => (count - 1).saturating_mul(stride as u64).saturating_add(size as u64),
    };
    let bytes = part(bytes, offset.map_or(0, |offset| offset.0), length, place)?;
    // That many elements fit in memory, so their number fits a usize.
    Ok(Span { bytes, count: usize::try_from(count.0).unwrap_or(usize::MAX), stride })
}

/// The packed bytes of an accessor, some of whose elements are given one by one.
fn sparse(
    document: &Document<'_>,
    json: &Accessor,
    base: Option<Span<'_>>,
    size: usize,
    place: &Place,
) -> Result<(Vec<u8>, usize), ReadError> {
    let Some(sparse) = &json.sparse else {
        return Err(Fault::Missing { missing: "bufferView" }.at(place.clone()));
    };
    let mut bytes = Vec::new();
    let at_place = |fault: Fault| fault.at(place.clone());
    let count = match base {
        Some(base) => {
            document.spend((base.count * size) as u64).map_err(at_place)?;
            let elements = (0..base.count).map(|i| &base.bytes[i * base.stride..][..size]);
            elements.for_each(|element| bytes.extend_from_slice(element));
            base.count
        }
        None => {
            // All zero, but a file of few bytes must not ask for many.
            let available = document.buffers.iter().map(|buffer| buffer.len() as u64).sum::<u64>();
            let too_short = || {
                let needed = json.count.0.saturating_mul(size as u64);
                Fault::TooShort { needed, available }.at(place.clone())
            };
            let count = usize::try_from(json.count.0).ok().filter(|&n| n as u64 <= available);
            let count = count.ok_or_else(too_short)?;
            document.spend((count * size) as u64).map_err(at_place)?;
            bytes.resize(count * size, 0);
            count
        }
    };
    let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
        return Err(Fault::WrongType { expected: "sparse by unsigned integers" }.at(place.clone()));
    };
    let index_shape = (sparse.count, component.size());
    let (view, offset) = (sparse.indices.buffer_view, Some(sparse.indices.byte_offset));
    let indices = span(document, view, offset, index_shape, place)?;
    let (view, offset) = (sparse.values.buffer_view, Some(sparse.values.byte_offset));
    let values = span(document, view, offset, (sparse.count, size), place)?;
    let indices = Elements {
        bytes: Cow::Borrowed(indices.bytes),
        count: indices.count,
        stride: indices.stride,
        component,
        normalized: false,
    };
    for i in 0..indices.count {
        let element = indices.integer(i, 0);
        let slot = (element as usize).checked_mul(size).and_then(|at| bytes.get_mut(at..at + size));
        let slot = slot.ok_or_else(|| {
            let (vertex, vertex_count) = (i64::from(element), count as u64);
            Fault::VertexOutOfRange { vertex, vertex_count }.at(place.clone())
        })?;
        slot.copy_from_slice(&values.bytes[i * values.stride..][..size]);
    }
    Ok((bytes, count))
}
