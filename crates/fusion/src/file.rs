//! A [`PatchSet`] as bytes, and bytes as one.

use std::io::{self, Write};
use std::ops::Range;

use bytemuck::{CheckedBitPattern, checked};
use drypoint_mesh::{EdgeClass, EdgeId, Wing};
use glam::Vec3;
use xxhash_rust::xxh3::Xxh3;

use crate::header::{CHECKSUM, Fields, HEADER, Header, MAGIC, VERSION};
use crate::patch_set::little_endian;
use crate::validate::Content;
use crate::{InvalidParams, InvalidPatches, Patch, PatchSet, Provenance, SuperPatch};

/// Of every section.
const ALIGNMENT: usize = 256;

/// Why bytes are no [`PatchSet`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatchFileError {
    /// It does not begin as such a file does.
    #[error("this is no patches file")]
    Foreign,
    /// Written by a newer version of this library.
    #[error(
        "written by a newer version of Drypoint: the file has format {found}, this program reads up to {VERSION}"
    )]
    Newer {
        /// The format it says.
        found: u32,
    },
    /// Written by an older version of this library, in a format that is no longer read.
    #[error(
        "written by an older version of Drypoint: the file has format {found}, this program reads {VERSION}; build the patches again"
    )]
    Older {
        /// The format it says.
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
    /// The bytes do not begin at a multiple of 4, so that no number can be read in place.
    #[error("the bytes do not begin at a multiple of 4 in memory")]
    Misaligned,
    /// This machine stores numbers the other way round.
    #[error("patches files are little-endian, and this machine is not")]
    BigEndian,
    /// Bytes have changed since it was written.
    #[error("the file is corrupt: its checksum does not match")]
    Corrupt,
    /// A code or a number that no writer of this version would write.
    #[error("the file's header makes no sense: {field}")]
    Header {
        /// What makes no sense.
        field: &'static str,
    },
    /// Parameters that no patches can be made with.
    #[error("the file's header makes no sense: {0}")]
    Params(#[from] InvalidParams),
    /// A code that stands for no [`EdgeClass`].
    #[error("the file's content makes no sense: an edge has an unknown class")]
    UnknownClass,
    /// What lies between two sections is not zero.
    #[error("the file's content makes no sense: byte {offset} belongs to nothing and is not zero")]
    Padding {
        /// Where, from the beginning of the file.
        offset: u64,
    },
    /// The content contradicts itself.
    #[error("the file's content makes no sense: {0}")]
    Invalid(#[from] InvalidPatches),
}

/// A patches file, read in place: its lists are slices of the bytes, nothing is copied, and a GPU
/// buffer can be filled from them as they are. The bytes may be mapped from a file.
///
/// # Format
///
/// All numbers are little-endian. A header of 256 bytes is followed by sections that each begin at
/// a multiple of 256 bytes, the largest offset that a GPU asks of a storage buffer, so that a
/// buffer can be filled from the file, or a binding point into it. What is between is zero.
///
/// | offset | what |
/// | --- | --- |
/// | 0 | `DRYPATCH` |
/// | 8 | version, u32: 2 |
/// | 12 | edge filter, u32: 0 convex, 1 all |
/// | 16 | XXH3-64 of every byte but these eight |
/// | 24 | length of the file, u64 |
/// | 32 | [`mesh_hash`](crate::mesh_hash), u64 |
/// | 40 | unit of distances, f64 |
/// | 48 | cost of a patch test t_P, f64 |
/// | 56 | cost of an accepted patch t_A, f64 |
/// | 64 | four view distances, f64 each |
/// | 96 | their four weights, f64 each |
/// | 128 | edges in a block, u32 |
/// | 132 | most edges in a patch, u32 |
/// | 136 | most vertices in a patch, u32 |
/// | 140 | bound, u32: 0 mean, 1 reduced, 2 minimal, 3 tight |
/// | 144 | levels, u32: 1 or 2 |
/// | 148 | method, five u32: 0, sphere (0 mean, 1 reduced), cache size, whether partitions are limited (0 or 1), most edges in a partition; or 1, cell, looks, sweeps, tears |
/// | 168 | numbers of super-patches, patches, edges and vertices, u32 each |
/// | 184 | zeros |
///
/// Sections: super-patches ([`SuperPatch`], 40 bytes each), patches ([`Patch`], 40), wings (16),
/// edge ids (4), positions (12), classes (1: 0 convex, 1 flat, 2 concave, 3 boundary,
/// 4 non-manifold, 5 inconsistent).
///
/// ```
/// use std::ops::ControlFlow;
///
/// use drypoint_fusion::{FusionParams, PatchFile, fuse};
/// use drypoint_mesh::{EdgeFilter, MeshAdjacency, shapes};
///
/// let mesh = shapes::icosphere(500);
/// let go_on = |_| ControlFlow::Continue(());
/// let params = FusionParams::PAPER;
/// let set = fuse(&mesh, &MeshAdjacency::new(&mesh), EdgeFilter::All, &params, &go_on)?;
///
/// let bytes = set.to_bytes();
/// let file = PatchFile::parse(&bytes)?;
/// assert_eq!(file.wings(), set.wings());
/// assert_eq!(file.to_patch_set(), set);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PatchFile<'a> {
    content: Content<'a>,
    provenance: Provenance,
}

impl<'a> PatchFile<'a> {
    /// Checks all that could make a reader fail or read out of range; that the bounds hold is not
    /// checked ([`PatchSet::validate`] does that). Linear: the checksum reads every byte.
    ///
    /// `bytes` must begin at a multiple of 4 in memory, as mapped files and what allocators give do.
    ///
    /// # Errors
    /// What is wrong with the bytes; the same bytes, the same error. Never panics.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, PatchFileError> {
        let found = bytes.len() as u64;
        let known = bytes.len().min(MAGIC.len());
        if bytes[..known] != MAGIC[..known] {
            return Err(PatchFileError::Foreign);
        }
        if let Some(&[.., a, b, c, d]) = bytes.first_chunk::<12>() {
            match u32::from_le_bytes([a, b, c, d]) {
                VERSION => {}
                found if found < VERSION => return Err(PatchFileError::Older { found }),
                found => return Err(PatchFileError::Newer { found }),
            }
        }
        let Some(head) = bytes.first_chunk::<HEADER>() else {
            return Err(PatchFileError::Truncated { expected: HEADER as u64, found });
        };
        let expected = Fields(head).u64(24);
        if found < expected {
            return Err(PatchFileError::Truncated { expected, found });
        }
        if found > expected {
            return Err(PatchFileError::TrailingBytes { extra: found - expected });
        }
        if checksum(bytes) != Fields(head).u64(CHECKSUM.start) {
            return Err(PatchFileError::Corrupt);
        }
        let header = Header::read(head)?;
        let layout = Layout::new(header.counts.map(u64::from));
        if layout.total() != expected {
            return Err(PatchFileError::Header { field: "counts" });
        }
        let file = Self { content: layout.read(bytes)?, provenance: header.provenance };
        file.content.validate()?;
        Ok(file)
    }

    /// As [`PatchSet::super_patches`].
    pub fn super_patches(&self) -> &'a [SuperPatch] {
        self.content.super_patches
    }

    /// As [`PatchSet::patches`].
    pub fn patches(&self) -> &'a [Patch] {
        self.content.patches
    }

    /// As [`PatchSet::wings`].
    pub fn wings(&self) -> &'a [Wing] {
        self.content.wings
    }

    /// As [`PatchSet::edge_ids`].
    pub fn edge_ids(&self) -> &'a [EdgeId] {
        self.content.edge_ids
    }

    /// As [`PatchSet::classes`].
    pub fn classes(&self) -> &'a [EdgeClass] {
        self.content.classes
    }

    /// As [`PatchSet::positions`].
    pub fn positions(&self) -> &'a [Vec3] {
        self.content.positions
    }

    /// What it was made from.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// A copy that needs the bytes no longer.
    pub fn to_patch_set(&self) -> PatchSet {
        PatchSet {
            super_patches: self.super_patches().to_vec(),
            patches: self.patches().to_vec(),
            wings: self.wings().to_vec(),
            edge_ids: self.edge_ids().to_vec(),
            classes: self.classes().to_vec(),
            positions: self.positions().to_vec(),
            provenance: self.provenance,
        }
    }
}

impl PatchSet {
    /// The asset as a file's content ([`PatchFile`] has the format). The same asset always gives the
    /// same bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let lengths =
            [self.super_patches.len(), self.patches.len(), self.wings.len(), self.positions.len()];
        #[expect(clippy::cast_possible_truncation, reason = "ids of all four are u32")]
        let counts = lengths.map(|length| length as u32);
        let layout = Layout::new(counts.map(u64::from));
        let header = Header { provenance: self.provenance, counts, length: layout.total() };
        let mut bytes = header.to_bytes();
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
        append(&layout.classes, bytemuck::cast_slice(&self.classes));
        let checksum = checksum(&bytes);
        bytes[CHECKSUM].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    /// Writes [`PatchSet::to_bytes`].
    ///
    /// # Errors
    /// What `out` fails with.
    pub fn write(&self, mut out: impl Write) -> io::Result<()> {
        out.write_all(&self.to_bytes())
    }

    /// Reads what [`PatchSet::to_bytes`] wrote, wherever it lies in memory. Checks what
    /// [`PatchFile::parse`] does. Linear; takes no more memory than twice the bytes.
    ///
    /// # Errors
    /// As [`PatchFile::parse`], but for [`PatchFileError::Misaligned`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PatchFileError> {
        if is_aligned(bytes) {
            return PatchFile::parse(bytes).map(|file| file.to_patch_set());
        }
        let mut words = vec![0u32; bytes.len().div_ceil(size_of::<u32>())];
        let copy = &mut bytemuck::cast_slice_mut(&mut words)[..bytes.len()];
        copy.copy_from_slice(bytes);
        PatchFile::parse(copy).map(|file| file.to_patch_set())
    }
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
    /// Counts are below 2³², so that nothing overflows.
    fn new([super_patch_count, patch_count, edge_count, vertex_count]: [u64; 4]) -> Self {
        let mut end = HEADER as u64;
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
            classes: section(edge_count, size_of::<EdgeClass>()),
        }
    }

    fn total(&self) -> u64 {
        self.classes.end
    }

    /// The sections of `bytes`, which are [`Layout::total`] long.
    fn read<'a>(&self, bytes: &'a [u8]) -> Result<Content<'a>, PatchFileError> {
        if cfg!(target_endian = "big") {
            return Err(PatchFileError::BigEndian);
        }
        if !is_aligned(bytes) {
            return Err(PatchFileError::Misaligned);
        }
        let mut end = HEADER as u64;
        for section in [
            &self.super_patches,
            &self.patches,
            &self.wings,
            &self.edge_ids,
            &self.positions,
            &self.classes,
        ] {
            let between = slice(bytes, &(end..section.start));
            if let Some(place) = between.iter().position(|&byte| byte != 0) {
                return Err(PatchFileError::Padding { offset: end + place as u64 });
            }
            end = section.end;
        }
        Ok(Content {
            super_patches: cast(bytes, &self.super_patches)?,
            patches: cast(bytes, &self.patches)?,
            wings: cast(bytes, &self.wings)?,
            edge_ids: cast(bytes, &self.edge_ids)?,
            positions: cast(bytes, &self.positions)?,
            classes: cast(bytes, &self.classes)?,
        })
    }
}

/// The bytes of a section, which is in range.
fn slice<'a>(bytes: &'a [u8], range: &Range<u64>) -> &'a [u8] {
    // The end of the last section is the length of `bytes`, so both fit.
    #[expect(clippy::cast_possible_truncation, reason = "see above")]
    let range = range.start as usize..range.end as usize;
    &bytes[range]
}

/// A section as what it holds. It has the right length and begins at a multiple of 4, and only
/// classes have codes that stand for nothing.
fn cast<'a, T: CheckedBitPattern>(
    bytes: &'a [u8],
    range: &Range<u64>,
) -> Result<&'a [T], PatchFileError> {
    checked::try_cast_slice(slice(bytes, range)).map_err(|_| PatchFileError::UnknownClass)
}

/// Whether the 4-byte numbers of a file can be read where they lie.
fn is_aligned(bytes: &[u8]) -> bool {
    bytes.as_ptr().addr().is_multiple_of(align_of::<u32>())
}

/// Of every byte but those that hold it.
fn checksum(bytes: &[u8]) -> u64 {
    let mut hash = Xxh3::new();
    hash.update(&bytes[..CHECKSUM.start]);
    hash.update(&bytes[CHECKSUM.end..]);
    hash.digest()
}
