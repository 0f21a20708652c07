//! The header: what is in the file, in which order and how.

use std::collections::HashSet;

use crate::io::error::{Fault, ReadError, lossy};
use crate::io::text::{self, Lines, Words};

/// What the header declares.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    /// In file order, under distinct names.
    pub(super) elements: Vec<Element>,
    /// Rows of the element `vertex`.
    pub(super) vertex_count: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A table: rows of the same properties.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    /// Rows.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    pub(super) kind: Kind,
    /// Bytes of a row in a binary file, if there are no lists.
    pub(super) row_size: Option<usize>,
}

impl Element {
    /// Bytes that a row takes at least in a binary file.
    pub(super) fn least_row_size(&self) -> usize {
        self.properties.iter().map(|p| p.length.unwrap_or(p.value).size()).sum::<usize>().max(1)
    }
}

impl Header {
    /// The elements that have rows in the file: a row of no values takes no room, and there is nothing
    /// to read.
    pub(super) fn tables(&self) -> impl Iterator<Item = &Element> {
        self.elements.iter().filter(|element| !element.properties.is_empty())
    }
}

/// What of an element is read, by indices of its properties.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Vertex { xyz: [usize; 3] },
    Face { list: usize },
    Strips { list: usize },
    Other,
}

#[derive(Debug)]
pub(super) struct Property {
    name: String,
    /// The type of the value, or of each value of a list.
    pub(super) value: Scalar,
    /// The type of the length, if it is a list.
    pub(super) length: Option<Scalar>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// The header, and the lines after it.
pub(super) fn parse(bytes: &[u8]) -> Result<(Header, Lines<'_>), ReadError> {
    let mut lines = Lines::new(bytes);
    let header = read(&mut lines).map_err(|fault| fault.on_line(lines.number().max(1)))?;
    Ok((header, lines))
}

fn read(lines: &mut Lines<'_>) -> Result<Header, Fault> {
    let first = lines.next_line().unwrap_or_default();
    if first.trim_ascii_end() != b"ply" {
        return Err(unexpected("\"ply\"", first));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let (mut of_file, mut of_element) = (HashSet::new(), HashSet::new());
    loop {
        let line = lines.next_line().ok_or(Fault::Unfinished { missing: "end_header" })?;
        let mut words = Words(line);
        match words.next().unwrap_or_default() {
            b"format" => encoding = Some(format(words, line)?),
            b"element" => {
                let element = element(words, line)?;
                if !of_file.insert(element.name.clone()) {
                    return Err(Fault::Twice { name: element.name });
                }
                elements.push(element);
                of_element.clear();
            }
            b"property" => {
                let property = property(words, line)?;
                let element = elements.last_mut();
                let element = element.ok_or_else(|| unexpected("an element first", line))?;
                if !of_element.insert(property.name.clone()) {
                    return Err(Fault::Twice { name: property.name });
                }
                element.properties.push(property);
            }
            b"comment" | b"obj_info" | b"" => {}
            b"end_header" => break,
            _ => return Err(unexpected("a header line", line)),
        }
    }
    let encoding = encoding.ok_or(Fault::Missing { missing: "format line" })?;
    let mut vertex_count = None;
    for element in &mut elements {
        element.kind = kind(element)?;
        let is_fixed = element.properties.iter().all(|property| property.length.is_none());
        let size = || element.properties.iter().map(|property| property.value.size()).sum();
        element.row_size = is_fixed.then(size);
        if let Kind::Vertex { .. } = element.kind {
            vertex_count = Some(element.count);
        }
    }
    let vertex_count = vertex_count.ok_or(Fault::Missing { missing: "element vertex" })?;
    Ok(Header { encoding, elements, vertex_count })
}

fn format(mut words: Words<'_>, line: &[u8]) -> Result<Encoding, Fault> {
    let encoding = match words.next() {
        Some(b"ascii") => Encoding::Ascii,
        Some(b"binary_little_endian") => Encoding::LittleEndian,
        Some(b"binary_big_endian") => Encoding::BigEndian,
        _ => {
            return Err(unexpected(
                "format ascii, binary_little_endian or binary_big_endian",
                line,
            ));
        }
    };
    if words.next() == Some(b"1.0") { Ok(encoding) } else { Err(unexpected("version 1.0", line)) }
}

fn element(mut words: Words<'_>, line: &[u8]) -> Result<Element, Fault> {
    let (name, count) = (words.next(), words.next().and_then(text::parse));
    let (Some(name), Some(count)) = (name, count) else {
        return Err(unexpected("element NAME COUNT", line));
    };
    let (properties, kind) = (Vec::new(), Kind::Other);
    Ok(Element { name: lossy(name), count, properties, kind, row_size: None })
}

fn property(mut words: Words<'_>, line: &[u8]) -> Result<Property, Fault> {
    let mut scalar = || words.next().and_then(Scalar::named);
    let is_list = Words(line).nth(1) == Some(b"list");
    let (length, value) = if is_list {
        scalar();
        let length = scalar().filter(|s| !matches!(s, Scalar::F32 | Scalar::F64));
        (Some(length.ok_or_else(|| unexpected("an integer type for the length", line))?), scalar())
    } else {
        (None, scalar())
    };
    let value = value.ok_or_else(|| unexpected("property TYPE NAME", line))?;
    let name = words.next().ok_or_else(|| unexpected("a name for the property", line))?;
    Ok(Property { name: lossy(name), value, length })
}

fn kind(element: &Element) -> Result<Kind, Fault> {
    let find = |name: &str, is_list: bool| {
        let fits = |p: &Property| p.name == name && p.length.is_some() == is_list;
        element.properties.iter().position(fits)
    };
    let indices = || find("vertex_indices", true).or_else(|| find("vertex_index", true));
    Ok(match element.name.as_str() {
        "vertex" => {
            let coordinate = |name, missing| find(name, false).ok_or(Fault::Missing { missing });
            Kind::Vertex {
                xyz: [
                    coordinate("x", "property x of vertex")?,
                    coordinate("y", "property y of vertex")?,
                    coordinate("z", "property z of vertex")?,
                ],
            }
        }
        "face" => Kind::Face {
            list: indices().ok_or(Fault::Missing { missing: "list vertex_indices of face" })?,
        },
        "tristrips" => Kind::Strips {
            list: indices()
                .ok_or(Fault::Missing { missing: "list vertex_indices of tristrips" })?,
        },
        _ => Kind::Other,
    })
}

fn unexpected(expected: &'static str, line: &[u8]) -> Fault {
    Fault::Unexpected { expected, found: lossy(line) }
}
