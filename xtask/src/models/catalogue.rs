//! The meshes that the tests and the figures in docs/ are made with.
//!
//! None is part of this repository: each has its own terms. An address is here only if what it
//! serves is known to have this size or hash; it names a commit or a release, so that it stays so.
//! Each file is checked after a download in any case.

/// One file, as the figures were measured on it.
#[derive(Debug)]
pub(crate) struct Mesh {
    /// Its name in the folder of models.
    pub(crate) name: &'static str,
    pub(crate) faces: u32,
    /// What it is good for.
    pub(crate) good_for: &'static str,
    pub(crate) terms: &'static str,
    /// Where its makers or their archive present it.
    pub(crate) source: &'static str,
    /// Where a person finds the file.
    pub(crate) page: &'static str,
    /// Which of the files there it is.
    pub(crate) file: &'static str,
    /// In bytes.
    pub(crate) size: u64,
    /// In lower-case hexadecimal digits.
    pub(crate) sha256: &'static str,
    pub(crate) download: Option<Download>,
}

#[derive(Debug)]
pub(crate) enum Download {
    /// The address serves the mesh itself.
    File { url: &'static str },
    /// The address serves a .tar.gz of this size and hash, with the mesh under this path.
    Member { url: &'static str, size: u64, sha256: &'static str, member: &'static str },
}

const STANFORD: &str = "https://graphics.stanford.edu/data/3Dscanrep/";
const STANFORD_TERMS: &str =
    "research use with credit to the Stanford Computer Graphics Laboratory, no commercial use";
const COMMON: &str = "https://github.com/alecjacobson/common-3d-test-models";
const NOT_STATED: &str = "common test model, terms not stated";

pub(crate) const MESHES: &[Mesh] = &[
    Mesh {
        name: "stanford-bunny.obj",
        faces: 69_451,
        good_for: "the mesh of most papers on contours",
        terms: STANFORD_TERMS,
        source: STANFORD,
        page: COMMON,
        file: "data/stanford-bunny.obj",
        size: 2_408_417,
        sha256: "1eb35d1e21ce99e5ce911353b6be278990713448dd9e8f5c9387f9de39b32205",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/alecjacobson/common-3d-test-models/8a4f8642acaf43f9cd7b67858a1502e1055ef202/data/stanford-bunny.obj",
        }),
    },
    Mesh {
        name: "dragon_vrip.ply",
        faces: 871_414,
        good_for: "large, with 108 faces of no area",
        terms: STANFORD_TERMS,
        source: STANFORD,
        page: STANFORD,
        file: "dragon_recon/dragon_vrip.ply of dragon_recon.tar.gz",
        size: 33_831_477,
        sha256: "fea87ff48f2aba22fb53e7b67c3ff3f7b8c2a3b3a0653af62c48bba67c6d5744",
        download: Some(Download::Member {
            url: "https://graphics.stanford.edu/pub/3Dscanrep/dragon/dragon_recon.tar.gz",
            size: 11_197_764,
            sha256: "74ac1d90989c9b1732edee82d57e9ce71452144cf4355f108d8c9c616d28d02f",
            member: "dragon_recon/dragon_vrip.ply",
        }),
    },
    Mesh {
        name: "armadillo.obj",
        faces: 99_994,
        good_for: "closed and detailed",
        terms: STANFORD_TERMS,
        source: STANFORD,
        page: "https://github.com/gcherchi/InteractiveAndRobustMeshBooleans",
        file: "data/armadillo.obj, a decimated copy",
        size: 3_451_590,
        sha256: "dec4a7da1dc45a1e3e05ae6805925135649382f830ac0f1a1c6582bae85b4d42",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/gcherchi/InteractiveAndRobustMeshBooleans/7beadc707e11afd0f8bbdaeb2c1d4c29a2296db3/data/armadillo.obj",
        }),
    },
    Mesh {
        name: "fandisk.obj",
        faces: 12_946,
        good_for: "a machine part with hard edges and flat regions",
        terms: "Hoppe et al., research use",
        source: "https://dblp.org/rec/conf/siggraph/HoppeDDHJMSS94.html",
        page: COMMON,
        file: "data/fandisk.obj",
        size: 379_559,
        sha256: "ea5bab2fbf545b1915f0d9faf6cc61ff8c18e0d8174ad61f8e35de15d8f6e3f8",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/alecjacobson/common-3d-test-models/f0f46265301433f4374e80711751a56d1f19f3d4/data/fandisk.obj",
        }),
    },
    Mesh {
        name: "cow.obj",
        faces: 5_804,
        good_for: "small, closed and organic",
        terms: NOT_STATED,
        source: "https://gfx.cs.princeton.edu/proj/sugcon/models/",
        page: COMMON,
        file: "data/cow.obj",
        size: 180_177,
        sha256: "69afce548640bc2beb0c44894d1a24d5766cc9cd3fd74f3ec55b4e229104b23f",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/alecjacobson/common-3d-test-models/f4cdcb194dd2a5f583cd8c714e868c33db6d15bc/data/cow.obj",
        }),
    },
    Mesh {
        name: "spot.obj",
        faces: 5_856,
        good_for: "texture coordinates: faces of v/vt",
        terms: "Keenan Crane, CC0",
        source: "https://www.cs.cmu.edu/~kmcrane/Projects/ModelRepository/",
        page: COMMON,
        file: "data/spot.obj",
        size: 330_624,
        sha256: "0738b5e8608fed74e5e8c7aa8dd0af97b4b74f9f6cbf7aac84cd7e40b2e44a75",
        download: None,
    },
    Mesh {
        name: "teapot.obj",
        faces: 6_320,
        good_for: "many boundaries",
        terms: "Martin Newell, public domain",
        source: "https://www.sjbaker.org/wiki/index.php?title=The_History_of_The_Teapot",
        page: COMMON,
        file: "data/teapot.obj",
        size: 210_614,
        sha256: "1b5396fedd74b577e32cef41146582c2f2e1a050d5b4915193c0ac1ad4187ed4",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/alecjacobson/common-3d-test-models/f96f1e93ec315a43cc771d596fcdc4268bd8b047/data/teapot.obj",
        }),
    },
    Mesh {
        name: "suzanne.obj",
        faces: 968,
        good_for: "an edge of three faces, boundaries, quads",
        terms: "comes with Blender, terms not stated",
        source: "https://www.blender.org/",
        page: COMMON,
        file: "data/suzanne.obj",
        size: 49_137,
        sha256: "d8684326f9bd8cfc24d3d302c1042fa16f63d2e66e49ed56b413fa20bed271e6",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/alecjacobson/common-3d-test-models/ae0c8d85001509c6f349ddae6642081c3425b6ab/data/suzanne.obj",
        }),
    },
    Mesh {
        name: "beetle-alt.obj",
        faces: 38_656,
        good_for: "an open surface, made by hand",
        terms: NOT_STATED,
        source: "https://blenderartists.org/t/ivan-sutherlands-1972-mesh/1162769",
        page: COMMON,
        file: "data/beetle-alt.obj",
        size: 1_361_270,
        sha256: "4528700590e20363b27e8ab77a4af6199a59b94ab6b849c9ba5a4a36f7c5b8cd",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/alecjacobson/common-3d-test-models/8fea25b01c7dbc70ec6b04f3c40cae3a503e27d8/data/beetle-alt.obj",
        }),
    },
    Mesh {
        name: "sponza.obj",
        faces: 33_663,
        good_for: "a building: viewpoints inside, long edges",
        terms: "Marko Dabrovic; the page has the terms",
        source: "http://hdri.cgtechniques.com/~sponza/files/",
        page: "https://casual-effects.com/data/",
        // Ours breaks off in the middle of a line, so no complete copy has its hash.
        file: "sponza.obj of Dabrovic Sponza, which has more faces and so differs",
        size: 3_276_532,
        sha256: "55a68f848f44df7293739e44b82577ea10dc74bcd7c0dc0edcdb236fb40eff2d",
        download: None,
    },
    Mesh {
        name: "RobotExpressive.glb",
        faces: 3_234,
        good_for: "rigged robot of 44 joints with 14 animations, nearly all rigid",
        terms: "Tomás Laulhé, CC0",
        source: "https://github.com/mrdoob/three.js/tree/dev/examples/models/gltf/RobotExpressive",
        page: "https://github.com/mrdoob/three.js/tree/dev/examples/models/gltf/RobotExpressive",
        file: "RobotExpressive.glb, another export and so differs",
        size: 498_064,
        sha256: "81cab16685e3e00d25cdbdf41698899de0e57a5f89916d7e78f2cff86a74c97b",
        download: None,
    },
    Mesh {
        name: "BrainStem.glb",
        faces: 61_666,
        good_for: "rigged robot of 59 meshes and 18 joints",
        terms: "Smith Micro Software; the page names the Poser EULA",
        source: "https://github.com/KhronosGroup/glTF-Sample-Assets/tree/main/Models/BrainStem",
        page: "https://github.com/KhronosGroup/glTF-Sample-Assets/tree/main/Models/BrainStem",
        file: "glTF-Binary/BrainStem.glb, another export and so differs",
        size: 3_535_188,
        sha256: "63ccb18fe046f08f0a58334b333fe12494736188d5fb718fa9f6edbbec6357e5",
        download: None,
    },
    Mesh {
        name: "Fox.glb",
        faces: 576,
        good_for: "skinned animal of 24 joints, mostly not rigid; no index buffer",
        terms: "PixelMannen (CC0); tomkranis, AsoboStudio, scurest (CC BY 4.0)",
        source: "https://github.com/KhronosGroup/glTF-Sample-Assets/tree/main/Models/Fox",
        page: "https://github.com/KhronosGroup/glTF-Sample-Assets/tree/main/Models/Fox",
        file: "glTF-Binary/Fox.glb",
        size: 162_852,
        sha256: "d97044e701822bac5a62696459b27d7b375aada5de8574ed4362edbba94771f7",
        download: Some(Download::File {
            url: "https://raw.githubusercontent.com/KhronosGroup/glTF-Sample-Assets/81e8b567643b5166e6ff40024e4ff71ad4b18676/Models/Fox/glTF-Binary/Fox.glb",
        }),
    },
];

/// The meshes of these names, or all if there are no names.
pub(crate) fn find(names: &[String]) -> Result<Vec<&'static Mesh>, String> {
    if names.is_empty() {
        return Ok(MESHES.iter().collect());
    }
    let one = |name: &String| {
        MESHES.iter().find(|mesh| mesh.name == name).ok_or_else(|| {
            let known: Vec<_> = MESHES.iter().map(|mesh| mesh.name).collect();
            format!("no mesh `{name}`; known are {}", known.join(", "))
        })
    };
    names.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::super::check::{State, state};
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn every_entry_is_well_formed() {
        let is_hash = |text: &str| {
            text.len() == 64 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
        };
        let is_page = |text: &str| text.starts_with("https://") || text.starts_with("http://");
        for mesh in MESHES {
            let name = mesh.name;
            assert_eq!(Path::new(name).file_name(), Some(name.as_ref()), "{name} is no file name");
            assert!(is_hash(mesh.sha256), "{name}");
            assert!(is_page(mesh.source) && is_page(mesh.page), "{name}");
            let texts = [mesh.good_for, mesh.terms, mesh.file];
            assert!(mesh.size > 0 && mesh.faces > 0 && texts.iter().all(|t| !t.is_empty()));
            match &mesh.download {
                Some(Download::File { url }) => assert!(url.starts_with("https://"), "{name}"),
                Some(Download::Member { url, size, sha256, member }) => {
                    assert!(url.starts_with("https://") && *size > 0 && is_hash(sha256), "{name}");
                    assert!(member.ends_with(name), "{name}");
                }
                None => {}
            }
        }
        let names: BTreeSet<_> = MESHES.iter().map(|mesh| mesh.name).collect();
        assert_eq!(names.len(), MESHES.len());
    }

    #[test]
    fn the_files_at_hand_are_the_ones_described() {
        let Some(folder) = super::super::named_folder() else { return };
        // Of others, a copy from elsewhere may differ.
        for mesh in MESHES.iter().filter(|mesh| mesh.download.is_some()) {
            let state = state(mesh, &folder.join(mesh.name));
            assert!(matches!(state, State::Missing | State::Present), "{}: {state:?}", mesh.name);
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_known_ones() {
        let error = find(&["cow.obj".to_owned(), "cow".to_owned()]).expect_err("no such mesh");
        assert!(error.starts_with("no mesh `cow`; known are stanford-bunny.obj, "), "{error}");
        let found = find(&["cow.obj".to_owned()]).expect("it is known");
        assert_eq!(found.len(), 1);
        assert_eq!(find(&[]).expect("all").len(), MESHES.len());
    }
}
