//! Stanford PLY, ascii and binary of both endiannesses.
//!
//! Greg Turk, The PLY Polygon File Format, 1994. Read here rather than by a crate: `ply-rs-bw`, at
//! 4.0, keeps a hash map for every row and takes about five times as long on the Stanford dragon.
//!
//! Read are `x`, `y` and `z` of the element `vertex`; lists `vertex_indices` or `vertex_index` of
//! `face`; and of `tristrips`, where −1 ends a strip and every second triangle is turned, as in the
//! files of the Stanford 3D Scanning Repository. Everything else is skipped.

mod ascii;
mod binary;
mod header;

use glam::Vec3;

use super::error::{Fault, Place, ReadError};
use super::parts::{self, Model, Parts};
use super::polygon::Faces;
use ascii::Ascii;
use binary::Binary;
use header::{Element, Encoding, Header, Kind, Scalar};

/// Reads a PLY file.
pub(super) fn parse(bytes: &[u8]) -> Result<Model, ReadError> {
    let (header, lines) = header::parse(bytes)?;
    match header.encoding {
        Encoding::Ascii => read(&header, Ascii::new(lines)),
        Encoding::LittleEndian => read(&header, Binary::new(bytes, lines.rest(), true)),
        Encoding::BigEndian => read(&header, Binary::new(bytes, lines.rest(), false)),
    }
}

/// The values of a file, in order.
trait Values {
    /// Goes to the next row of an element, if there is one.
    fn begin_row(&mut self) -> bool;
    /// The next value as f32.
    fn real(&mut self, scalar: Scalar) -> Result<f32, Fault>;
    /// The next value as an integer.
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault>;
    /// Passes over values.
    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Fault>;
    /// Checks that the row is complete.
    fn end_row(&mut self) -> Result<(), Fault>;
    /// Where we are, in a row of an element.
    fn place(&self, element: &str, row: u64) -> Place;
    /// At most so many rows of an element can follow.
    fn rows_left(&self, element: &Element) -> u64;
}

fn read<V: Values>(header: &Header, mut values: V) -> Result<Model, ReadError> {
    let mut mesh = Builder { vertex_count: header.vertex_count, ..Builder::default() };
    for element in &header.elements {
        // Rows of no values take no room in a binary file, and there is nothing to read.
        if element.properties.is_empty() {
            continue;
        }
        mesh.reserve(element, values.rows_left(element).min(element.count));
        for row in 0..element.count {
            let done = if values.begin_row() {
                mesh.row(element, row, &mut values)
            } else {
                Err(Fault::TooShort { needed: 1, available: 0 })
            };
            done.map_err(|fault| {
                let (name, expected) = (element.name.clone(), element.count);
                let place = values.place(&name, row);
                match fault {
                    Fault::TooShort { .. } => {
                        Fault::EndsEarly { element: name, rows: row, expected }.at(place)
                    }
                    fault => fault.at(place),
                }
            })?;
        }
    }
    let triangles = mesh.faces.into_triangles(&mesh.positions);
    parts::model(mesh.positions, triangles, Parts::default(), Parts::default())
}

#[derive(Default)]
struct Builder {
    /// As the header says.
    vertex_count: u64,
    positions: Vec<Vec3>,
    faces: Faces,
    /// The list last read.
    list: Vec<i64>,
    corners: Vec<u32>,
}

impl Builder {
    /// Makes room for rows that the file is long enough to hold.
    fn reserve(&mut self, element: &Element, rows: u64) {
        let rows = usize::try_from(rows).unwrap_or(0);
        match element.kind {
            Kind::Vertex { .. } => self.positions.reserve(rows),
            Kind::Face { .. } => self.faces = Faces::with_capacity(rows),
            Kind::Strips { .. } | Kind::Other => {}
        }
    }

    fn row<V: Values>(&mut self, element: &Element, row: u64, values: &mut V) -> Result<(), Fault> {
        let mut position = [0.0; 3];
        for (index, property) in element.properties.iter().enumerate() {
            let value = property.value;
            match (element.kind, property.length) {
                (Kind::Vertex { xyz }, None) if xyz.contains(&index) => {
                    let coordinate = values.real(value)?;
                    (0..3).filter(|&i| xyz[i] == index).for_each(|i| position[i] = coordinate);
                }
                (Kind::Face { list } | Kind::Strips { list }, Some(length)) if list == index => {
                    let length = count(values.integer(length)?)?;
                    self.list.clear();
                    for _ in 0..length {
                        self.list.push(values.integer(value)?);
                    }
                }
                (_, None) => values.skip(value, 1)?,
                (_, Some(length)) => {
                    let length = count(values.integer(length)?)?;
                    values.skip(value, length)?;
                }
            }
        }
        values.end_row()?;
        match element.kind {
            Kind::Vertex { .. } => self.vertex(row, position),
            Kind::Face { .. } => self.face(),
            Kind::Strips { .. } => self.strips(),
            Kind::Other => Ok(()),
        }
    }

    fn vertex(&mut self, vertex: u64, position: [f32; 3]) -> Result<(), Fault> {
        self.positions.push(position.into());
        if position.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(Fault::NotFinite { vertex, position })
        }
    }

    fn face(&mut self) -> Result<(), Fault> {
        if self.list.len() < 3 {
            return Err(Fault::TooFewCorners { corners: self.list.len() });
        }
        self.corners.clear();
        for &index in &self.list {
            self.corners.push(vertex_index(index, self.vertex_count)?);
        }
        self.faces.push(&self.corners);
        Ok(())
    }

    /// Triangles that only stitch strips together, with a corner twice, are left out.
    fn strips(&mut self) -> Result<(), Fault> {
        for strip in self.list.split(|&index| index == -1) {
            self.corners.clear();
            for &index in strip {
                self.corners.push(vertex_index(index, self.vertex_count)?);
            }
            for (i, triangle) in self.corners.windows(3).enumerate() {
                let &[a, b, c] = triangle else { continue };
                if a != b && b != c && c != a {
                    self.faces.push(&if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
                }
            }
        }
        Ok(())
    }
}

/// The length of a list.
fn count(length: i64) -> Result<u64, Fault> {
    u64::try_from(length).map_err(|_| Fault::Unexpected {
        expected: "the length of a list",
        found: length.to_string(),
    })
}

fn vertex_index(index: i64, vertex_count: u64) -> Result<u32, Fault> {
    let known = u32::try_from(index).ok().filter(|&vertex| u64::from(vertex) < vertex_count);
    known.ok_or(if index < 0 {
        Fault::NotAnIndex { text: index.to_string() }
    } else {
        Fault::VertexOutOfRange { vertex: index, vertex_count }
    })
}
