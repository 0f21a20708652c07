//! What is made of rows.

use super::ascii::{self, Ascii};
use super::binary::{self, Binary};
use super::header::{Element, Header, Kind, Scalar};
use crate::io::ReadOptions;
use crate::io::content::Content;
use crate::io::error::{Fault, Place, ReadError};

/// The values of a file, in order.
pub(super) trait Values {
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
    /// Reads the next row if it is one as nearly all are.
    fn plain(&mut self, element: &Element, rows: &mut Rows<'_>) -> Option<()>;
}

/// Reads rows in a row.
pub(super) struct Rows<'a> {
    header: &'a Header,
    options: &'a ReadOptions,
    pub(super) content: Content,
    /// The list last read.
    list: Vec<i64>,
    corners: Vec<u32>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(header: &'a Header, options: &'a ReadOptions) -> Self {
        let (list, corners) = (Vec::new(), Vec::new());
        Self { header, options, content: Content::default(), list, corners }
    }

    /// Reads lines of text, of whatever elements they are.
    pub(super) fn read_text(mut self, piece: ascii::Piece<'_>) -> Result<Content, ReadError> {
        let mut row = piece.first_row;
        let mut values = Ascii::new(piece.lines);
        let mut before = 0u64;
        for element in self.header.tables() {
            let end = before.saturating_add(element.count);
            while row < end && (piece.is_last || row < piece.first_row + piece.rows) {
                self.read_row(element, row - before, &mut values)?;
                row += 1;
            }
            before = end;
        }
        Ok(self.content)
    }

    /// Reads rows of bytes, of one element.
    pub(super) fn read_bytes(
        mut self,
        file: &[u8],
        piece: &binary::Piece<'_>,
    ) -> Result<Content, ReadError> {
        // No more than there is room for, whatever the header says.
        let most = piece.bytes.len() / piece.element.least_row_size();
        let rows = usize::try_from(piece.rows).map_or(most, |rows| rows.min(most));
        match piece.element.kind {
            Kind::Vertex { .. } => self.content.positions.reserve(rows),
            Kind::Face { list } => {
                // Three corners each, or there are fewer of them.
                let corners = 3 * piece.element.properties[list].value.size();
                let least = piece.element.least_row_size() + corners;
                self.content.faces.reserve(rows.min(piece.bytes.len() / least));
            }
            Kind::Strips { .. } | Kind::Other => {}
        }
        let mut values = Binary::new(file, piece.bytes, self.header.encoding);
        for row in piece.first_row..piece.first_row + piece.rows {
            self.read_row(piece.element, row, &mut values)?;
        }
        Ok(self.content)
    }

    fn read_row<V: Values>(
        &mut self,
        element: &Element,
        row: u64,
        values: &mut V,
    ) -> Result<(), ReadError> {
        if values.plain(element, self).is_some() {
            return Ok(());
        }
        let done = if values.begin_row() {
            self.row(element, row, values)
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
        })
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
        if self.options.strict && position.iter().any(|x| !x.is_finite()) {
            return Err(Fault::NotFinite { vertex, position });
        }
        self.content.positions.push(position.into());
        Ok(())
    }

    /// Adds a vertex, unless something is to be said about it.
    pub(super) fn plain_vertex(&mut self, position: [f32; 3]) -> Option<()> {
        self.vertex(0, position).ok()
    }

    /// Adds a triangle, unless something is to be said about it. Corners below 0, too, are beyond all
    /// vertices if they are seen as unsigned.
    pub(super) fn plain_triangle(&mut self, corners: [u32; 3]) -> Option<()> {
        let vertex_count = self.header.vertex_count.min(1 << 31);
        let is_known = corners.iter().all(|&vertex| u64::from(vertex) < vertex_count);
        is_known.then(|| self.content.faces.push_triangle(corners))
    }

    fn face(&mut self) -> Result<(), Fault> {
        if self.list.len() < 3 {
            return Err(Fault::TooFewCorners { corners: self.list.len() });
        }
        self.corners.clear();
        for &index in &self.list {
            self.corners.push(vertex_index(index, self.header.vertex_count)?);
        }
        self.content.faces.push(&self.corners);
        Ok(())
    }

    /// Triangles that only stitch strips together, with a corner twice, are left out.
    fn strips(&mut self) -> Result<(), Fault> {
        for strip in self.list.split(|&index| index == -1) {
            self.corners.clear();
            for &index in strip {
                self.corners.push(vertex_index(index, self.header.vertex_count)?);
            }
            for (i, triangle) in self.corners.windows(3).enumerate() {
                let &[a, b, c] = triangle else { continue };
                if a != b && b != c && c != a {
                    let turned = if i % 2 == 0 { [a, b, c] } else { [b, a, c] };
                    self.content.faces.push_triangle(turned);
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
