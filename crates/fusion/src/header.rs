//! The first bytes of a patches file: what it was made from, and how much of everything follows.
//! The table of its fields is in the documentation of [`PatchFile`](crate::PatchFile).

use drypoint_mesh::EdgeFilter;

use crate::params::is_size;
use crate::{
    BoundKind, CostModel, FusionParams, Levels, Method, PatchFileError, Provenance, SphereKind,
    ViewProfile,
};

/// Bytes before the first section.
pub(crate) const HEADER: usize = 256;

pub(crate) const MAGIC: &[u8; 8] = b"DRYPATCH";

/// Of the format that is written, and the only one that is read.
pub(crate) const VERSION: u32 = 2;

/// All of the header but the checksum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Header {
    pub(crate) provenance: Provenance,
    /// Numbers of super-patches, patches, edges and vertices.
    pub(crate) counts: [u32; 4],
    /// Length of the file.
    pub(crate) length: u64,
}

impl Header {
    /// As bytes, with 0 for the checksum.
    pub(crate) fn to_bytes(self) -> Vec<u8> {
        let Provenance { params, filter, mesh_hash, unit } = self.provenance;
        let mut header = Vec::with_capacity(HEADER);
        let mut put = |bytes: &[u8]| header.extend_from_slice(bytes);
        put(MAGIC);
        put(&VERSION.to_le_bytes());
        put(&u32::from(filter == EdgeFilter::All).to_le_bytes());
        put(&[0; 8]);
        put(&self.length.to_le_bytes());
        put(&mesh_hash.to_le_bytes());
        let CostModel { patch_test, accepted_patch, block, max_edges, max_vertices } = params.cost;
        let ViewProfile { distances, weights } = params.views;
        let costs = [unit, patch_test, accepted_patch];
        for number in costs.into_iter().chain(distances).chain(weights) {
            put(&number.to_le_bytes());
        }
        let limits = [block, max_edges, max_vertices];
        let kinds = [params.bound as u32, params.levels as u32];
        let method = method_words(params.method);
        for word in limits.into_iter().chain(kinds).chain(method).chain(self.counts) {
            put(&word.to_le_bytes());
        }
        header.resize(HEADER, 0);
        header
    }

    /// Reads what [`Header::to_bytes`] wrote; magic, version and checksum are the caller's to check.
    pub(crate) fn read(bytes: &[u8; HEADER]) -> Result<Self, PatchFileError> {
        let fields = Fields(bytes);
        let params = FusionParams {
            bound: fields.bound().ok_or(nonsense("bound"))?,
            cost: fields.cost(),
            views: fields.views(),
            method: fields.method().ok_or(nonsense("method"))?,
            levels: fields.levels().ok_or(nonsense("levels"))?,
        };
        params.check()?;
        let filter = match fields.u32(12) {
            0 => EdgeFilter::Convex,
            1 => EdgeFilter::All,
            _ => return Err(nonsense("edge filter")),
        };
        let unit = fields.f64(40);
        if !is_size(unit) {
            return Err(nonsense("unit"));
        }
        let header = Self {
            provenance: Provenance { params, filter, mesh_hash: fields.u64(32), unit },
            counts: [168, 172, 176, 180].map(|at| fields.u32(at)),
            length: fields.u64(24),
        };
        // What no field uses is zero, so that equal assets are equal files.
        let again = header.to_bytes();
        let is_unused_zero = (0..HEADER).all(|at| CHECKSUM.contains(&at) || again[at] == bytes[at]);
        if is_unused_zero { Ok(header) } else { Err(nonsense("unused bytes")) }
    }
}

/// Where the checksum is.
pub(crate) const CHECKSUM: std::ops::Range<usize> = 16..24;

/// What says how patches were grown.
fn method_words(method: Method) -> [u32; 5] {
    match method {
        Method::Greedy { sphere, cache_size, max_partition } => {
            let is_limited = u32::from(max_partition.is_some());
            [0, sphere as u32, cache_size, is_limited, max_partition.unwrap_or(0)]
        }
        Method::Planes { cell, looks, sweeps, tears } => [1, cell, looks, sweeps, tears],
    }
}

/// The header's fields by offset.
pub(crate) struct Fields<'a>(pub(crate) &'a [u8; HEADER]);

impl Fields<'_> {
    pub(crate) fn u32(&self, at: usize) -> u32 {
        u32::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    pub(crate) fn u64(&self, at: usize) -> u64 {
        u64::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    fn f64(&self, at: usize) -> f64 {
        f64::from_bits(self.u64(at))
    }

    fn cost(&self) -> CostModel {
        CostModel {
            patch_test: self.f64(48),
            accepted_patch: self.f64(56),
            block: self.u32(128),
            max_edges: self.u32(132),
            max_vertices: self.u32(136),
        }
    }

    fn views(&self) -> ViewProfile {
        ViewProfile {
            distances: std::array::from_fn(|i| self.f64(64 + 8 * i)),
            weights: std::array::from_fn(|i| self.f64(96 + 8 * i)),
        }
    }

    fn bound(&self) -> Option<BoundKind> {
        let kinds = [BoundKind::Mean, BoundKind::Reduced, BoundKind::Minimal, BoundKind::Tight];
        kinds.into_iter().find(|&kind| kind as u32 == self.u32(140))
    }

    fn levels(&self) -> Option<Levels> {
        [Levels::One, Levels::Two].into_iter().find(|&levels| levels as u32 == self.u32(144))
    }

    fn method(&self) -> Option<Method> {
        let [kind, a, b, c, d] = [148, 152, 156, 160, 164].map(|at| self.u32(at));
        match kind {
            0 => {
                let spheres = [SphereKind::Mean, SphereKind::Reduced];
                let sphere = spheres.into_iter().find(|&sphere| sphere as u32 == a)?;
                let max_partition = match c {
                    0 => None,
                    1 => Some(d),
                    _ => return None,
                };
                Some(Method::Greedy { sphere, cache_size: b, max_partition })
            }
            1 => Some(Method::Planes { cell: a, looks: b, sweeps: c, tears: d }),
            _ => None,
        }
    }
}

fn nonsense(field: &'static str) -> PatchFileError {
    PatchFileError::Header { field }
}
