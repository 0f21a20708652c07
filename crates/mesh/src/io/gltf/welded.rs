//! Triangles that are added piece by piece.

use foldhash::HashMap;
use glam::{DVec3, Vec3};

use super::Piece;
use crate::io::error::{Fault, ReadError};
use crate::io::parts::Dropped;
use crate::weld::Place;
use crate::{MAX_TRIANGLES, MeshError};

/// Vertices at one position are one. In order of first use.
#[derive(Default)]
pub(super) struct Welded {
    pub(super) positions: Vec<Vec3>,
    known: HashMap<Place, u32>,
}

impl Welded {
    /// The vertex at this position; `None` if that is none.
    pub(super) fn vertex(&mut self, position: Vec3) -> Option<u32> {
        position.is_finite().then(|| {
            *self.known.entry(Place::of(position)).or_insert_with(|| {
                // −0 is stored as 0.
                self.positions.push(position + Vec3::ZERO);
                // At most three to a triangle, and those are counted.
                u32::try_from(self.positions.len() - 1).unwrap_or(u32::MAX)
            })
        })
    }
}

/// What a vertex of a piece becomes.
pub(super) enum Found {
    /// A vertex, and whether what is outside near it would come to lie inside.
    Vertex(u32, bool),
    /// No vertex: it would be here.
    Nowhere(DVec3),
}

/// Adds the triangles of a piece to `triangles`, by asking once for each vertex that it uses. Those
/// that use one that is nowhere are left out and counted, or refused if the reader is `strict`.
pub(super) fn add(
    piece: &Piece<'_>,
    triangles: &mut Vec<[u32; 3]>,
    (dropped, strict): (&mut Dropped, bool),
    mut find: impl FnMut(usize) -> Result<Found, Fault>,
) -> Result<(), ReadError> {
    let count = triangles.len() + piece.triangles.len();
    if count > MAX_TRIANGLES {
        return Err(MeshError::TooManyTriangles { count }.into());
    }
    let vertex_count = piece.positions.count();
    let mut known: Vec<Option<Option<(u32, bool)>>> = vec![None; vertex_count];
    triangles.reserve(piece.triangles.len());
    for triangle in &piece.triangles {
        let mut corners = [None; 3];
        for (corner, &vertex) in corners.iter_mut().zip(triangle) {
            let slot = known.get_mut(vertex as usize).ok_or_else(|| {
                let (vertex, vertex_count) = (i64::from(vertex), vertex_count as u64);
                Fault::VertexOutOfRange { vertex, vertex_count }.at(piece.place.clone())
            })?;
            *corner = match *slot {
                Some(found) => found,
                None => {
                    let found = find(vertex as usize).map_err(|f| f.at(piece.place.clone()))?;
                    *slot.insert(match found {
                        Found::Vertex(vertex, mirrors) => Some((vertex, mirrors)),
                        Found::Nowhere(at) if strict => {
                            // As the file has it, if that is what is wrong.
                            let stored = piece.position(vertex as usize).as_vec3();
                            let at = if stored.is_finite() { at.as_vec3() } else { stored };
                            let position = at.to_array();
                            let fault = Fault::NotFinite { vertex: vertex.into(), position };
                            return Err(fault.at(piece.place.clone()));
                        }
                        Found::Nowhere(_) => {
                            dropped.vertices += 1;
                            None
                        }
                    })
                }
            };
        }
        match corners {
            [Some((a, false)), Some((b, _)), Some((c, _))] => triangles.push([a, b, c]),
            [Some((a, true)), Some((b, _)), Some((c, _))] => triangles.push([a, c, b]),
            _ => dropped.faces += 1,
        }
    }
    Ok(())
}
