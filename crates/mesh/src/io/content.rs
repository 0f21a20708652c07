//! What the readers of OBJ, PLY and STL find, piece by piece, and the model that it makes.

use bytemuck::Pod;
use glam::Vec3;
use rayon::prelude::*;

use super::error::ReadError;
use super::parts::{self, Dropped, Model, Parts};
use super::polygon::Faces;

/// What a file holds, or a piece of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Content {
    pub(super) positions: Vec<Vec3>,
    pub(super) faces: Faces,
    pub(super) parts: Parts,
    pub(super) materials: Parts,
}

impl Content {
    /// The whole of what pieces in a row hold.
    pub(super) fn joined(pieces: impl IntoIterator<Item = Self>) -> Self {
        let (mut parts, mut materials) = (Parts::default(), Parts::default());
        let (mut positions, mut faces) = (Vec::new(), Vec::new());
        let mut triangle_count = 0;
        for piece in pieces {
            parts.append(piece.parts, triangle_count);
            materials.append(piece.materials, triangle_count);
            triangle_count += piece.faces.triangle_count();
            positions.push(piece.positions);
            faces.push(piece.faces);
        }
        Self { positions: joined(positions), faces: Faces::joined(faces), parts, materials }
    }

    /// The model, without the vertices that are not finite and the faces that use them.
    ///
    /// # Errors
    /// No faces, none that is finite, or more than [`MAX_TRIANGLES`](crate::MAX_TRIANGLES).
    ///
    /// # Panics
    /// If a face uses a vertex that is not there.
    pub(super) fn into_model(mut self) -> Result<Model, ReadError> {
        if self.positions.par_iter().all(|position| position.is_finite()) {
            let triangles = self.faces.into_triangles(&self.positions);
            return parts::model(self.positions, triangles, self.parts, self.materials);
        }
        let is_dropped: Vec<bool> = self.positions.iter().map(|p| !p.is_finite()).collect();
        let removed = self.faces.remove_those_of(|vertex| is_dropped[vertex as usize]);
        let vertices = is_dropped.iter().filter(|&&is_dropped| is_dropped).count();
        let dropped = Dropped { vertices, faces: removed.faces };
        if self.faces.triangle_count() == 0 && dropped.faces > 0 {
            return Err(ReadError::NoFiniteFaces { count: dropped.faces });
        }
        for position in self.positions.iter_mut().filter(|position| !position.is_finite()) {
            *position = Vec3::ZERO;
        }
        let [parts, materials] =
            [self.parts, self.materials].map(|parts| parts.without(&removed.triangles));
        let triangles = self.faces.into_triangles(&self.positions);
        Ok(Model { dropped, ..parts::model(self.positions, triangles, parts, materials)? })
    }
}

/// All of these, one after the other. Copied by all threads, so that memory is fetched by all.
pub(super) fn joined<T: Pod + Send + Sync>(mut pieces: Vec<Vec<T>>) -> Vec<T> {
    if pieces.len() == 1 {
        return pieces.swap_remove(0);
    }
    let mut all = bytemuck::zeroed_vec(pieces.iter().map(Vec::len).sum());
    let mut slots = Vec::with_capacity(pieces.len());
    let mut rest = &mut all[..];
    for piece in &pieces {
        let (slot, after) = rest.split_at_mut(piece.len());
        slots.push(slot);
        rest = after;
    }
    slots.into_par_iter().zip(pieces).for_each(|(slot, piece)| slot.copy_from_slice(&piece));
    all
}
