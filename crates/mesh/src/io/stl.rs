//! STL, ascii and binary.
//!
//! Read here rather than by the crate `stl_io`, which at 0.11 takes every file that begins with
//! "solid " for text, as many binary ones do; stops at the first `endsolid`, losing the other
//! solids of the file without a word; refuses facets whose unused normal is NaN; and says no line.
//! A test compares both where they should agree.
//!
//! Normals and attributes are ignored. Vertices stay as they are stored, three to a facet.

use glam::Vec3;

use super::error::{Fault, Place, ReadError, lossy};
use super::format::is_ascii_stl;
use super::parts::{self, Model, Parts};
use super::text::{self, Lines, Words};

/// Bytes before the facets of a binary file: 80 that mean nothing and the count.
const HEADER: usize = 84;
/// Bytes of a facet: normal, three vertices, attributes.
const FACET: usize = 50;

/// Reads an STL file, text or binary.
pub(super) fn parse(bytes: &[u8]) -> Result<Model, ReadError> {
    let mut solids = Solids::default();
    if is_ascii_stl(bytes) {
        let mut lines = Lines::new(bytes);
        solids.read_text(&mut lines).map_err(|fault| fault.on_line(lines.number()))?;
    } else {
        solids.read_binary(bytes)?;
    }
    let vertex_count = u32::try_from(solids.positions.len()).unwrap_or(u32::MAX);
    let corners: Vec<u32> = (0..vertex_count).collect();
    let triangles = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    parts::model(solids.positions, triangles, solids.parts, Parts::default())
}

#[derive(Default)]
struct Solids {
    positions: Vec<Vec3>,
    parts: Parts,
}

impl Solids {
    fn vertex(&mut self, position: [f32; 3]) -> Result<(), Fault> {
        let vertex = self.positions.len() as u64;
        self.positions.push(position.into());
        if position.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(Fault::NotFinite { vertex, position })
        }
    }

    fn read_binary(&mut self, bytes: &[u8]) -> Result<(), ReadError> {
        let available = bytes.len() as u64;
        let not_stl = |needed| Fault::NotStl { needed, available }.at(Place::Byte(0));
        let Some((header, facets)) = bytes.split_first_chunk::<HEADER>() else {
            return Err(not_stl(HEADER as u64));
        };
        let count = u32::from_le_bytes([header[80], header[81], header[82], header[83]]);
        let needed = HEADER as u64 + FACET as u64 * u64::from(count);
        if available < needed {
            return Err(not_stl(needed));
        }
        self.positions.reserve(3 * count as usize);
        for (row, facet) in facets.chunks_exact(FACET).take(count as usize).enumerate() {
            for corner in facet[12..48].chunks_exact(12) {
                let real = |at: usize| f32::from_le_bytes(std::array::from_fn(|i| corner[at + i]));
                self.vertex([real(0), real(4), real(8)]).map_err(|fault| {
                    let byte = (HEADER + FACET * row) as u64;
                    fault.at(Place::Row { element: "facet".to_owned(), row: row as u64, byte })
                })?;
            }
        }
        Ok(())
    }

    fn read_text(&mut self, lines: &mut Lines<'_>) -> Result<(), Fault> {
        let mut in_solid = false;
        // Vertices so far, inside a facet.
        let mut facet = None;
        while let Some(line) = lines.next_line() {
            let mut words = Words(line);
            let Some(word) = words.next() else { continue };
            let unexpected = |expected| Err(Fault::Unexpected { expected, found: shown(line) });
            match (word.to_ascii_lowercase().as_slice(), facet) {
                (b"solid", _) if !in_solid => {
                    in_solid = true;
                    self.parts.begin(shown(words.0), self.positions.len() / 3);
                }
                _ if !in_solid => return unexpected("solid"),
                (b"endsolid", None) => in_solid = false,
                (b"facet", None) => facet = Some(0),
                (_, None) => return unexpected("facet or endsolid"),
                (b"vertex", Some(corners)) => {
                    self.vertex(text::position(&mut words)?)?;
                    if let Some(word) = words.next() {
                        return Err(Fault::LeftOver { text: lossy(word) });
                    }
                    facet = Some(corners + 1);
                }
                (b"endfacet", Some(3)) => facet = None,
                (b"endfacet", Some(corners)) => return Err(Fault::NotATriangle { corners }),
                (b"outer" | b"endloop", Some(_)) => {}
                (_, Some(_)) => return unexpected("vertex or endfacet"),
            }
        }
        match (in_solid, facet) {
            (_, Some(_)) => Err(Fault::Unfinished { missing: "endfacet" }),
            (true, None) => Err(Fault::Unfinished { missing: "endsolid" }),
            (false, None) => Ok(()),
        }
    }
}

fn shown(text: &[u8]) -> String {
    lossy(text.trim_ascii())
}
