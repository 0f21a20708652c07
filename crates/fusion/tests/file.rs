//! Saving and loading: bit for bit, or an error that says why not.

use std::io::ErrorKind;
use std::ops::ControlFlow;
use std::path::Path;

use drypoint_fusion::{
    BoundKind, CostModel, FusionParams, Levels, PatchFile, PatchFileError, PatchSet, SuperPatch,
    ViewProfile, fuse,
};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, shapes};
use proptest::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

fn set(mesh: &Mesh, filter: EdgeFilter, params: &FusionParams) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    fuse(mesh, &adjacency, filter, params, &|_| ControlFlow::Continue(())).unwrap()
}

/// Half of the patches in super-patches of one patch each.
fn with_second_level(set: PatchSet) -> PatchSet {
    let of_one = |(first_patch, index): (u32, usize)| {
        let bound = set.patches()[index].bound;
        SuperPatch { bound, first_patch, patch_count: 1 }
    };
    let groups = (0..).zip(0..set.patches().len() / 2).map(of_one).collect();
    set.with_super_patches(groups).unwrap()
}

/// With super-patches, patches and edges of two classes, in less than 10 KB.
fn small_set() -> PatchSet {
    let params = FusionParams::PAPER.with_max_partition(Some(64));
    let set = with_second_level(set(&shapes::open_grid(100), EdgeFilter::All, &params));
    assert!(set.super_patches().len() > 1);
    assert!(set.classes().iter().any(|&class| class != set.classes()[0]));
    set
}

fn small_file() -> Vec<u8> {
    small_set().to_bytes()
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
            let set = with_second_level(set(&shape.mesh, filter, &params));
            let bytes = set.to_bytes();
            let again = PatchSet::from_bytes(&bytes);
            assert_eq!(again.as_ref(), Ok(&set), "{}", shape.name);
            assert_eq!(again.unwrap().to_bytes(), bytes);
            let mut written = Vec::new();
            set.write(&mut written).unwrap();
            assert_eq!(written, bytes);
        }
    }
}

#[test]
fn a_file_is_read_in_place() {
    let set = small_set();
    let bytes = set.to_bytes();
    let file = PatchFile::parse(&bytes).unwrap();
    assert_eq!(file.super_patches(), set.super_patches());
    assert_eq!(file.patches(), set.patches());
    assert_eq!(file.wings(), set.wings());
    assert_eq!(file.edge_ids(), set.edge_ids());
    assert_eq!(file.classes(), set.classes());
    assert_eq!(file.positions(), set.positions());
    assert_eq!(file.provenance(), set.provenance());
    let range = bytes.as_ptr_range();
    assert!(range.contains(&file.wings().as_ptr().cast()), "not a copy");
}

/// Only reading in place asks for it.
#[test]
fn bytes_may_begin_anywhere() {
    let set = small_set();
    let shifted = [&[0; 4][..], &set.to_bytes()].concat();
    let mut refused = 0;
    for start in 0..4 {
        let mut bytes = shifted[start..].to_vec();
        bytes.drain(..4 - start);
        // A view that begins at any place of a word.
        let padded = [&vec![0; start][..], &bytes].concat();
        let view = &padded[start..];
        assert_eq!(PatchSet::from_bytes(view).as_ref(), Ok(&set));
        refused +=
            usize::from(PatchFile::parse(view).is_err_and(|e| e == PatchFileError::Misaligned));
    }
    assert_eq!(refused, 3);
}

#[test]
fn a_section_begins_where_the_format_says() {
    let set = small_set();
    let bytes = set.to_bytes();
    assert_eq!(&bytes[256..296], bytemuck::bytes_of(&set.super_patches()[0]));
    let patches = (256 + 40 * set.super_patches().len()).next_multiple_of(256);
    assert_eq!(&bytes[patches..patches + 40], bytemuck::bytes_of(&set.patches()[0]));
    let wings = (patches + 40 * set.patches().len()).next_multiple_of(256);
    assert_eq!(&bytes[wings..wings + 16], bytemuck::bytes_of(&set.wings()[0]));
}

#[test]
fn a_field_stands_where_the_format_says() {
    let params = FusionParams {
        bound: BoundKind::Minimal,
        cost: CostModel {
            patch_test: 1.5,
            accepted_patch: 2.5,
            block: 3,
            max_edges: 100,
            max_vertices: 99,
        },
        views: ViewProfile { distances: [4.0, 5.0, 6.0, 7.0], weights: [0.1, 0.2, 0.3, 0.4] },
        levels: Levels::One,
        ..FusionParams::PAPER_MEAN.with_max_partition(Some(77))
    };
    let set = set(&shapes::icosphere(320), EdgeFilter::All, &params);
    let bytes = set.to_bytes();
    let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let f64_at = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    assert_eq!([8, 12].map(u32_at), [2, 1]);
    assert_eq!(bytes[24..32], (bytes.len() as u64).to_le_bytes());
    assert_eq!(bytes[32..40], set.provenance().mesh_hash.to_le_bytes());
    assert_eq!([40, 48, 56].map(f64_at), [set.provenance().unit, 1.5, 2.5]);
    assert_eq!([64, 72, 80, 88].map(f64_at), params.views.distances);
    assert_eq!([96, 104, 112, 120].map(f64_at), params.views.weights);
    assert_eq!([128, 132, 136, 140, 144].map(u32_at), [3, 100, 99, 2, 1]);
    assert_eq!([148, 152, 156, 160, 164].map(u32_at), [0, 0, 50, 1, 77]);
    let counts =
        [set.super_patches().len(), set.patches().len(), set.wings().len(), set.positions().len()];
    assert_eq!([168, 172, 176, 180].map(|at| u32_at(at) as usize), counts);
    assert_eq!(PatchSet::from_bytes(&bytes), Ok(set));
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
                8..12 => matches!(error, PatchFileError::Newer { .. }),
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
    let newer =
        "written by a newer version of Drypoint: the file has format 3, this program reads up to 2";
    let older = "written by an older version of Drypoint: the file has format 1, this program reads 2; \
                 build the patches again";
    for (version, expected) in [(3, newer), (1, older)] {
        let mut bytes = small_file();
        bytes[8] = version;
        check(&bytes, expected);
        // Another format may have another header.
        check(&bytes[..12], expected);
    }
}

#[test]
fn nonsense_in_the_header_is_named() {
    let nan = f64::NAN.to_le_bytes();
    let negative = (-1.0f64).to_le_bytes();
    let cases: &[(usize, &[u8], &str)] = &[
        (12, &[2], "edge filter"),
        (40, &nan, "unit"),
        (40, &negative, "unit"),
        (140, &[4], "bound"),
        (144, &[0], "levels"),
        (144, &[3], "levels"),
        (148, &[2], "method"),
        (152, &[2], "method"),
        (160, &[2], "method"),
        // The limit of partitions that are not limited.
        (160, &[0], "unused bytes"),
        (184, &[1], "unused bytes"),
        (255, &[1], "unused bytes"),
        (168, &[0xff; 4], "counts"),
        (172, &[0xff; 4], "counts"),
        (176, &[0xff; 4], "counts"),
        (180, &[0xff; 4], "counts"),
    ];
    for &(offset, bytes, expected) in cases {
        let mut file = small_file();
        file[offset..offset + bytes.len()].copy_from_slice(bytes);
        let found = PatchSet::from_bytes(&sealed(file));
        assert_eq!(found, Err(PatchFileError::Header { field: expected }), "{offset}");
    }
}

/// These, with the number that a file has at `offset` replaced.
fn with_number(mut params: FusionParams, offset: usize, number: f64) -> FusionParams {
    let field = match offset {
        48 => &mut params.cost.patch_test,
        56 => &mut params.cost.accepted_patch,
        64..96 => &mut params.views.distances[(offset - 64) / 8],
        _ => &mut params.views.weights[(offset - 96) / 8],
    };
    *field = number;
    params
}

/// What [`fuse`] says of parameters, and the loader of a file with the same.
#[track_caller]
fn check_number(offset: usize, number: f64, expected: Result<(), &str>) {
    let mesh = shapes::icosphere(80);
    let params = with_number(FusionParams::FAST, offset, number);
    let go_on = |_| ControlFlow::Continue(());
    let made = fuse(&mesh, &MeshAdjacency::new(&mesh), EdgeFilter::All, &params, &go_on);
    let mut bytes = set(&mesh, EdgeFilter::All, &FusionParams::FAST).to_bytes();
    bytes[offset..offset + 8].copy_from_slice(&number.to_le_bytes());
    let loaded = PatchSet::from_bytes(&sealed(bytes));
    let expected = expected.map_err(str::to_owned);
    assert_eq!(made.map(|_| ()).map_err(|error| error.to_string()), expected);
    let of_file = |why| format!("the file's header makes no sense: {why}");
    assert_eq!(loaded.map(|_| ()).map_err(|error| error.to_string()), expected.map_err(of_file));
}

#[test]
fn senseless_parameters_are_refused_by_maker_and_loader() {
    let patch_test = "a patch test must cost a finite number above 0, not";
    for (number, name) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (0.0, "0"), (-0.5, "-0.5")] {
        check_number(48, number, Err(&format!("{patch_test} {name}")));
    }
    let accepted_patch = "an accepted patch must cost a finite number from 0, not";
    let weight = "the weight of view distance 3 must be a finite number from 0, not";
    for (number, name) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (-0.5, "-0.5")] {
        check_number(56, number, Err(&format!("{accepted_patch} {name}")));
        check_number(120, number, Err(&format!("{weight} {name}")));
    }
    for (number, name) in [(f64::NAN, "NaN"), (0.0, "0"), (-3.0, "-3")] {
        let expected = format!("view distance 1 must be above 0, not {name}");
        check_number(72, number, Err(&expected));
    }
    check_number(120, 0.25, Err("the weights of view distances must sum up to 1, not 0.75"));
    check_number(56, 0.0, Ok(()));
    check_number(120, 0.5 + 1e-7, Ok(()));
    // Viewpoints may be infinitely far away.
    check_number(64, f64::INFINITY, Ok(()));
}

#[test]
fn nonsense_in_the_content_is_named() {
    let broken = |offset: usize, bytes: &[u8]| {
        let mut file = small_file();
        file[offset..offset + bytes.len()].copy_from_slice(bytes);
        PatchSet::from_bytes(&sealed(file)).unwrap_err().to_string()
    };
    // The second super-patch, and what lies behind the last.
    let second = broken(256 + 40 + 32, &[2]);
    assert!(second.contains("super-patch 1 holds 1 patches from 2"), "{second}");
    let infinite = f32::INFINITY.to_le_bytes();
    assert!(broken(256, &infinite).contains("the bound of super-patch 0 is not finite"));
    let behind = 256 + 40 * small_set().super_patches().len();
    assert!(broken(behind, &[1]).contains(&format!("byte {behind} belongs to nothing")));
    let last = small_file().len() - 1;
    assert!(broken(last, &[6]).contains("unknown class"));
}

/// What every loaded asset must be good for, whatever its bytes.
fn use_it(set: &PatchSet, bytes: &[u8]) {
    let _ = (set.validate(), set.summary(), set.expected_cost());
    assert_eq!(set.always_tested().end as usize, set.wings().len());
    assert_eq!(set.always_tested_patches().end as usize, set.patches().len());
    assert_eq!(set.to_bytes(), bytes);
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
            let bytes = sealed(bytes);
            match PatchSet::from_bytes(&bytes) {
                Err(_) => refused += 1,
                // Such as a wing that names another vertex: readable, if wrong.
                Ok(set) => use_it(&set, &bytes),
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]

    /// The same, at several places at once: whole words, as the fuzz target finds them.
    #[test]
    fn sealed_random_nonsense_is_refused_or_harmless(
        words in prop::collection::vec((any::<prop::sample::Index>(), word()), 1..6),
    ) {
        thread_local!(static FILE: Vec<u8> = small_file());
        let mut bytes = FILE.with(Clone::clone);
        for (place, word) in words {
            // Not the file's name, version, checksum and length: those have tests of their own.
            let place = 32 + 4 * place.index((bytes.len() - 32) / 4);
            bytes[place..place + 4].copy_from_slice(&word.to_le_bytes());
        }
        let bytes = sealed(bytes);
        if let Ok(set) = PatchSet::from_bytes(&bytes) {
            use_it(&set, &bytes);
        }
    }
}

/// Numbers of all sizes, such as nobody should choose, and some that have none.
fn number() -> impl Strategy<Value = f64> {
    const EXTREMES: [f64; 6] = [f64::MIN_POSITIVE, f64::MAX, f64::INFINITY, f64::NAN, 0.0, -1.0];
    prop_oneof![4 => 0.1..100.0, 2 => prop::sample::select(&EXTREMES), 1 => any::<f64>()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn what_can_be_made_can_be_loaded(
        [patch_test, accepted_patch] in [number(), number()],
        distances in [number(), number(), number(), number()],
        weight in prop_oneof![0.0..=1.0, number()],
        preset in prop::sample::select(&[FusionParams::DEFAULT, FusionParams::PAPER]),
        levels in prop::sample::select(&[Levels::One, Levels::Two]),
    ) {
        let cost = CostModel { patch_test, accepted_patch, ..CostModel::MESH_SHADER };
        let views = ViewProfile { distances, weights: [weight, 0.0, 1.0 - weight, 0.0] };
        let params = FusionParams { cost, views, levels, ..preset };
        let mesh = shapes::open_grid(60);
        let go_on = |_| ControlFlow::Continue(());
        let made = fuse(&mesh, &MeshAdjacency::new(&mesh), EdgeFilter::All, &params, &go_on);
        prop_assert_eq!(made.is_ok(), params.check().is_ok());
        if let Ok(set) = made {
            prop_assert_eq!(PatchSet::from_bytes(&set.to_bytes()), Ok(set));
        }
    }
}

/// Counts, small and huge, and floats.
fn word() -> impl Strategy<Value = u32> {
    prop_oneof![0u32..300, any::<u32>(), any::<f32>().prop_map(f32::to_bits), Just(u32::MAX)]
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_saved_asset_is_loaded_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.patches");
    let set = small_set();
    for _ in 0..2 {
        set.save(&path).unwrap();
        assert_eq!(PatchSet::load(&path).unwrap(), set);
        assert_eq!(names_in(folder.path()), ["grid.patches"]);
    }
}

#[cfg(unix)]
#[test]
fn a_replaced_file_keeps_its_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.patches");
    std::fs::write(&path, "old").unwrap();
    std::fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).unwrap();
    small_set().save(&path).unwrap();
    assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
}

#[test]
fn a_failed_save_leaves_all_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing").join("grid.patches");
    assert_eq!(small_set().save(&missing).unwrap_err().kind(), ErrorKind::NotFound);
    // What stands in the way here is a folder, which no file can replace.
    let occupied = folder.path().join("occupied");
    std::fs::create_dir(&occupied).unwrap();
    std::fs::write(occupied.join("mine"), "old").unwrap();
    assert!(small_set().save(&occupied).is_err());
    assert_eq!(names_in(folder.path()), ["occupied"]);
    assert_eq!(std::fs::read(occupied.join("mine")).unwrap(), b"old");
}

#[test]
fn what_is_no_asset_is_not_loaded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    assert_eq!(PatchSet::load(&path).unwrap_err().kind(), ErrorKind::NotFound);
    std::fs::write(&path, b"\x89PNG").unwrap();
    let error = PatchSet::load(&path).unwrap_err();
    assert_eq!(
        (error.kind(), error.to_string()),
        (ErrorKind::InvalidData, "this is no patches file".to_owned())
    );
}
