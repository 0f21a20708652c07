//! A [`PatchSet`] as bytes.
//!
//! All numbers are little-endian. A header of 256 bytes is followed by sections that each begin at
//! a multiple of 256 bytes, the largest offset that a GPU asks of a storage buffer, so that a
//! buffer can be filled from the file, or a binding point into it. What is between is zero.
//!
//! | offset | what |
//! | --- | --- |
//! | 0 | `DRYPATCH` |
//! | 8 | version, u32: 1 |
//! | 12 | edge filter, u32: 0 convex, 1 all |
//! | 16 | XXH3-64 of every byte but these eight |
//! | 24 | length of the file, u64 |
//! | 32 | hash of the mesh, u64 |
//! | 40 | unit of distances, f64 |
//! | 48 | cost of a patch test, f64 |
//! | 56 | view distance, f64 |
//! | 64 | sphere, u32: 0 mean, 1 reduced |
//! | 68 | cache size, u32 |
//! | 72 | whether partitions are limited, u32: 0 or 1 |
//! | 76 | most edges in a partition, u32 |
//! | 80 | numbers of patches, edges, vertices, u32 each |
//!
//! Sections: patches ([`Patch`], 40 bytes each), wings (16), edge ids (4), positions (12), classes
//! (1: 0 convex, 1 flat, 2 concave, 3 boundary, 4 non-manifold, 5 inconsistent).

use std::io::{self, Write};
use std::ops::Range;

use bytemuck::Pod;
use drypoint_mesh::{EdgeClass, EdgeFilter, EdgeId, Wing};
use glam::Vec3;
use xxhash_rust::xxh3::Xxh3;

use crate::patch_set::little_endian;
use crate::{
    BoundKind, CostModel, FusionParams, InvalidPatches, Levels, Method, Patch, PatchSet,
    Provenance, SphereKind, SuperPatch, ViewProfile,
};

const MAGIC: &[u8; 8] = b"DRYPATCH";
const VERSION: u32 = 2;
const HEADER: usize = 256;
/// Of every section.
const ALIGNMENT: usize = 256;
const HASH: Range<usize> = 16..24;

/// By code.
const CLASSES: [EdgeClass; 6] = [
    EdgeClass::Convex,
    EdgeClass::Flat,
    EdgeClass::Concave,
    EdgeClass::Boundary,
    EdgeClass::NonManifold,
    EdgeClass::Inconsistent,
];

/// Why bytes are no [`PatchSet`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchFileError {
    /// It does not begin as such a file does.
    #[error("this is no patches file")]
    Foreign,
    /// Written by another version of this library, most likely a newer one.
    #[error("the file has format version {found}; this program reads version {VERSION}")]
    Version {
        /// The version it says.
        found: u32,
    },
    /// It ends too early.
    #[error("the file is cut off: {found} bytes of {expected}")]
    Truncated {
        /// How many bytes there should be, at least.
        expected: u64,
        /// How many there are.
        found: u64,
    },
    /// Something follows it.
    #[error("{extra} bytes follow the end of the file's data")]
    TrailingBytes {
        /// How many.
        extra: u64,
    },
    /// Bytes have changed since it was written.
    #[error("the file is corrupt: its checksum does not match")]
    Corrupt,
    /// A code or a count that no writer of this version would write.
    #[error("the file's header makes no sense: {field}")]
    Header {
        /// What makes no sense.
        field: &'static str,
    },
    /// The content contradicts itself.
    #[error("the file's content makes no sense: {0}")]
    Invalid(#[from] InvalidPatches),
}

/// Where each section is.
struct Layout {
    super_patches: Range<u64>,
    patches: Range<u64>,
    wings: Range<u64>,
    edge_ids: Range<u64>,
    positions: Range<u64>,
    classes: Range<u64>,
}

impl Layout {
    fn new([super_patch_count, patch_count, edge_count, vertex_count]: [u64; 4]) -> Self {
        let mut end = HEADER as u64;
        // Counts are below 2³², so that nothing overflows.
        let mut section = |count: u64, size: usize| {
            let start = end.next_multiple_of(ALIGNMENT as u64);
            end = start + count * size as u64;
            start..end
        };
        Self {
            super_patches: section(super_patch_count, size_of::<SuperPatch>()),
            patches: section(patch_count, size_of::<Patch>()),
            wings: section(edge_count, size_of::<Wing>()),
            edge_ids: section(edge_count, size_of::<EdgeId>()),
            positions: section(vertex_count, size_of::<Vec3>()),
            classes: section(edge_count, 1),
        }
    }

    fn total(&self) -> u64 {
        self.classes.end
    }
}

impl PatchSet {
    /// The asset as a file's content. The same asset always gives the same bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let lists = [self.super_patches.len(), self.patches.len()];
        let counts = [lists[0], lists[1], self.wings.len(), self.positions.len()];
        let layout = Layout::new(counts.map(|count| count as u64));
        let mut bytes = self.header(counts, layout.total());
        let mut append = |section: &Range<u64>, data: &[u8]| {
            bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
            debug_assert_eq!(section, &(bytes.len() as u64..(bytes.len() + data.len()) as u64));
            bytes.extend_from_slice(data);
        };
        append(&layout.super_patches, &little_endian(&self.super_patches));
        append(&layout.patches, &little_endian(&self.patches));
        append(&layout.wings, &little_endian(&self.wings));
        append(&layout.edge_ids, &little_endian(&self.edge_ids));
        append(&layout.positions, &little_endian(&self.positions));
        let classes: Vec<u8> = self.classes.iter().map(|&class| class as u8).collect();
        append(&layout.classes, &classes);
        let hash = hash(&bytes);
        bytes[HASH].copy_from_slice(&hash.to_le_bytes());
        bytes
    }

    /// Writes [`PatchSet::to_bytes`].
    ///
    /// # Errors
    /// What `out` fails with.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        out.write_all(&self.to_bytes())
    }

    fn header(&self, counts: [usize; 4], total: u64) -> Vec<u8> {
        let Provenance { params, filter, mesh_hash, unit } = self.provenance;
        let mut header = Vec::with_capacity(HEADER);
        let mut put = |bytes: &[u8]| header.extend_from_slice(bytes);
        put(MAGIC);
        put(&VERSION.to_le_bytes());
        put(&u32::from(filter == EdgeFilter::All).to_le_bytes());
        put(&[0; 8]);
        put(&total.to_le_bytes());
        put(&mesh_hash.to_le_bytes());
        put(&unit.to_le_bytes());
        put(&params.cost.patch_test.to_le_bytes());
        put(&params.cost.accepted_patch.to_le_bytes());
        for distance_or_weight in params.views.distances.into_iter().chain(params.views.weights) {
            put(&distance_or_weight.to_le_bytes());
        }
        let CostModel { block, max_edges, max_vertices, .. } = params.cost;
        let method = match params.method {
            Method::Greedy { sphere, cache_size, max_partition } => {
                let sphere = sphere as u32;
                let limit = max_partition.unwrap_or(0);
                [0, sphere, cache_size, u32::from(max_partition.is_some()), limit]
            }
            Method::Planes { cell, sweeps } => [1, cell, sweeps, 0, 0],
        };
        let kinds = [params.bound as u32, params.levels as u32];
        for word in [block, max_edges, max_vertices].into_iter().chain(kinds).chain(method) {
            put(&word.to_le_bytes());
        }
        for count in counts {
            #[expect(clippy::cast_possible_truncation, reason = "ids of all four are u32")]
            put(&(count as u32).to_le_bytes());
        }
        header.resize(HEADER, 0);
        header
    }

    /// Reads what [`PatchSet::to_bytes`] wrote. Everything that could make a reader fail or read
    /// out of range is checked; that the bounds hold is not ([`PatchSet::validate`] does that).
    /// Linear; takes no more memory than the bytes do.
    ///
    /// # Errors
    /// What is wrong with the bytes; the same bytes, the same error. Never panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PatchFileError> {
        let found = bytes.len() as u64;
        let known = bytes.len().min(MAGIC.len());
        if bytes[..known] != MAGIC[..known] {
            return Err(PatchFileError::Foreign);
        }
        let Some(header) = bytes.first_chunk::<HEADER>() else {
            return Err(PatchFileError::Truncated { expected: HEADER as u64, found });
        };
        let header = Header(header);
        if header.u32(8) != VERSION {
            return Err(PatchFileError::Version { found: header.u32(8) });
        }
        let expected = header.u64(24);
        if found < expected {
            return Err(PatchFileError::Truncated { expected, found });
        }
        if found > expected {
            return Err(PatchFileError::TrailingBytes { extra: found - expected });
        }
        if hash(bytes) != header.u64(16) {
            return Err(PatchFileError::Corrupt);
        }
        let counts = [168, 172, 176, 180].map(|at| u64::from(header.u32(at)));
        let layout = Layout::new(counts);
        if layout.total() != expected {
            return Err(PatchFileError::Header { field: "counts" });
        }
        let set = Self {
            super_patches: read_section(bytes, &layout.super_patches),
            patches: read_section(bytes, &layout.patches),
            wings: read_section(bytes, &layout.wings),
            edge_ids: read_section(bytes, &layout.edge_ids),
            positions: read_section(bytes, &layout.positions),
            classes: read_classes(section(bytes, &layout.classes))?,
            provenance: header.provenance()?,
        };
        set.content().validate()?;
        Ok(set)
    }
}

/// The first bytes of a file.
struct Header<'a>(&'a [u8; HEADER]);

impl Header<'_> {
    fn u32(&self, at: usize) -> u32 {
        u32::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    fn u64(&self, at: usize) -> u64 {
        u64::from_le_bytes(std::array::from_fn(|i| self.0[at + i]))
    }

    fn f64(&self, at: usize) -> f64 {
        f64::from_bits(self.u64(at))
    }

    fn provenance(&self) -> Result<Provenance, PatchFileError> {
        let invalid = |field| Err(PatchFileError::Header { field });
        let filter = match self.u32(12) {
            0 => EdgeFilter::Convex,
            1 => EdgeFilter::All,
            _ => return invalid("edge filter"),
        };
        let bound = match self.u32(140) {
            0 => BoundKind::Mean,
            1 => BoundKind::Reduced,
            2 => BoundKind::Minimal,
            3 => BoundKind::Tight,
            _ => return invalid("bound"),
        };
        let levels = match self.u32(144) {
            1 => Levels::One,
            2 => Levels::Two,
            _ => return invalid("levels"),
        };
        let cost = CostModel {
            patch_test: self.f64(48),
            accepted_patch: self.f64(56),
            block: self.u32(128),
            max_edges: self.u32(132),
            max_vertices: self.u32(136),
        };
        let views = ViewProfile {
            distances: std::array::from_fn(|i| self.f64(64 + 8 * i)),
            weights: std::array::from_fn(|i| self.f64(96 + 8 * i)),
        };
        let Some(method) = self.method() else { return invalid("method") };
        let params = FusionParams { bound, cost, views, method, levels };
        Ok(Provenance { params, filter, mesh_hash: self.u64(32), unit: self.f64(40) })
    }
}

impl Header<'_> {
    fn method(&self) -> Option<Method> {
        let [kind, a, b, c, d] = [148, 152, 156, 160, 164].map(|at| self.u32(at));
        match kind {
            0 => {
                let sphere = match a {
                    0 => SphereKind::Mean,
                    1 => SphereKind::Reduced,
                    _ => return None,
                };
                let max_partition = match c {
                    0 => None,
                    1 => Some(d),
                    _ => return None,
                };
                Some(Method::Greedy { sphere, cache_size: b, max_partition })
            }
            1 => Some(Method::Planes { cell: a, sweeps: b }),
            _ => None,
        }
    }
}

/// Of every byte but those that hold it.
fn hash(bytes: &[u8]) -> u64 {
    let mut hash = Xxh3::new();
    hash.update(&bytes[..HASH.start]);
    hash.update(&bytes[HASH.end..]);
    hash.digest()
}

/// The bytes of a section, which is in range.
fn section<'a>(bytes: &'a [u8], range: &Range<u64>) -> &'a [u8] {
    // The end of the last section is the length of `bytes`, so both fit.
    #[expect(clippy::cast_possible_truncation, reason = "see above")]
    let range = range.start as usize..range.end as usize;
    &bytes[range]
}

fn read_section<T: Pod>(bytes: &[u8], range: &Range<u64>) -> Vec<T> {
    let mut data: Vec<T> = section(bytes, range)
        .chunks_exact(size_of::<T>())
        .map(bytemuck::pod_read_unaligned)
        .collect();
    let words: &mut [u32] = bytemuck::cast_slice_mut(&mut data);
    words.iter_mut().for_each(|word| *word = u32::from_le(*word));
    data
}

fn read_classes(codes: &[u8]) -> Result<Vec<EdgeClass>, PatchFileError> {
    let class = |&code: &u8| CLASSES.get(usize::from(code)).copied();
    codes
        .iter()
        .map(class)
        .collect::<Option<_>>()
        .ok_or(PatchFileError::Header { field: "classes" })
}
