//! Saving and loading: bit for bit, or an error that says why not.

use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, PatchFileError, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, shapes};
use xxhash_rust::xxh3::xxh3_64;

fn set(mesh: &Mesh, filter: EdgeFilter, params: &FusionParams) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    fuse(mesh, &adjacency, filter, params, &|_| ControlFlow::Continue(())).unwrap()
}

/// With patches, always-tested edges and two classes, in less than 8 KB.
fn small_file() -> Vec<u8> {
    let params = FusionParams::PAPER.with_max_partition(Some(64));
    let set = set(&shapes::icosphere(80), EdgeFilter::Convex, &params);
    assert!(!set.patches().is_empty());
    set.to_bytes()
}

/// Makes the checksum right again.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let hash = xxh3_64(&[&bytes[..16], &bytes[24..]].concat());
    bytes[16..24].copy_from_slice(&hash.to_le_bytes());
    bytes
}

#[test]
fn assets_survive_bit_for_bit() {
    for shape in shapes::all() {
        for (filter, params) in [
            (EdgeFilter::Convex, FusionParams::PAPER),
            (EdgeFilter::All, FusionParams::PAPER_MEAN.with_max_partition(None)),
        ] {
            let set = set(&shape.mesh, filter, &params);
            let bytes = set.to_bytes();
            assert_eq!(PatchSet::from_bytes(&bytes).as_ref(), Ok(&set), "{}", shape.name);
            let mut written = Vec::new();
            set.write(&mut written).unwrap();
            assert_eq!(written, bytes);
        }
    }
}

#[test]
fn a_section_begins_where_the_format_says() {
    let mesh = shapes::icosphere(80);
    let set = set(&mesh, EdgeFilter::Convex, &FusionParams::PAPER);
    let bytes = set.to_bytes();
    assert_eq!(&bytes[256..296], bytemuck::bytes_of(&set.patches()[0]));
    let wings = (256 + 40 * set.patches().len()).next_multiple_of(256);
    assert_eq!(&bytes[wings..wings + 16], bytemuck::bytes_of(&set.wings()[0]));
}

#[test]
fn every_changed_byte_is_noticed() {
    let file = small_file();
    for place in 0..file.len() {
        for flip in [1, 0x80, 0xff] {
            let mut bytes = file.clone();
            bytes[place] ^= flip;
            let error = PatchSet::from_bytes(&bytes).unwrap_err();
            let is_expected = match place {
                0..8 => matches!(error, PatchFileError::Foreign),
                8..12 => matches!(error, PatchFileError::Version { .. }),
                24..32 => matches!(
                    error,
                    PatchFileError::Truncated { .. } | PatchFileError::TrailingBytes { .. }
                ),
                _ => matches!(error, PatchFileError::Corrupt),
            };
            assert!(is_expected, "byte {place}: {error}");
        }
    }
}

#[test]
fn every_other_length_is_noticed() {
    let file = small_file();
    for length in 0..file.len() {
        let error = PatchSet::from_bytes(&file[..length]).unwrap_err();
        assert!(matches!(error, PatchFileError::Truncated { .. }), "{length} bytes: {error}");
    }
    let longer = [&file[..], &[0]].concat();
    assert_eq!(PatchSet::from_bytes(&longer), Err(PatchFileError::TrailingBytes { extra: 1 }));
}

#[test]
fn errors_say_what_is_wrong() {
    let check = |bytes: &[u8], expected: &str| {
        assert_eq!(PatchSet::from_bytes(bytes).unwrap_err().to_string(), expected);
    };
    check(b"glTF\x02\0\0\0", "this is no patches file");
    check(&[0xff; 4096], "this is no patches file");
    check(b"", "the file is cut off: 0 bytes of 256");
    check(b"DRYP", "the file is cut off: 4 bytes of 256");
    let mut newer = small_file();
    newer[8] = 3;
    check(&newer, "the file has format version 3; this program reads version 2");
}

/// A file with a right checksum may still be nonsense: no byte of it may cause a panic or a large
/// allocation.
#[test]
fn sealed_nonsense_is_refused_or_harmless() {
    let file = small_file();
    let mut refused = 0;
    for place in (0..16).chain(24..file.len()) {
        for value in [0, 1, 0x7f, 0xff] {
            let mut bytes = file.clone();
            bytes[place] = value;
            match PatchSet::from_bytes(&sealed(bytes)) {
                Err(_) => refused += 1,
                // Such as a wing that names another vertex: readable, if wrong.
                Ok(set) => {
                    let _ = (set.validate(), set.summary(), set.expected_cost());
                    assert!(set.always_tested().end as usize == set.wings().len());
                }
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

#[test]
fn huge_counts_are_refused_before_memory_is_taken() {
    for place in [168, 172, 176, 180] {
        let mut bytes = small_file();
        bytes[place..place + 4].fill(0xff);
        let error = PatchSet::from_bytes(&sealed(bytes)).unwrap_err();
        assert_eq!(error, PatchFileError::Header { field: "counts" });
    }
}
