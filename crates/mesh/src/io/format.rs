//! Which format a file has: by its name, and by what it holds.

use std::fmt;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, ascii or binary.
    Ply,
    /// STL, ascii or binary.
    Stl,
    /// glTF 2.0, as JSON or as GLB.
    Gltf,
}

impl Format {
    /// The extensions that are known, in lower case.
    pub(super) const EXTENSIONS: [(&str, Self); 5] = [
        ("obj", Self::Obj),
        ("ply", Self::Ply),
        ("stl", Self::Stl),
        ("gltf", Self::Gltf),
        ("glb", Self::Gltf),
    ];

    /// The format of files of this extension, given without its dot, in any case.
    pub fn of_extension(extension: &str) -> Option<Self> {
        let known = Self::EXTENSIONS.iter().find(|(name, _)| name.eq_ignore_ascii_case(extension));
        known.map(|&(_, format)| format)
    }

    /// What a file that begins with these bytes plainly is, if anything. Binary STL has no mark of
    /// its own and is known by its length, so `bytes` should be the whole file.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        if is_binary_stl(bytes) {
            Some(Self::Stl)
        } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if bytes.starts_with(b"glTF") || text.starts_with(b"{") && mentions_asset(text) {
            Some(Self::Gltf)
        } else if is_ascii_stl(bytes) {
            Some(Self::Stl)
        } else if starts_like_obj(text) {
            Some(Self::Obj)
        } else {
            None
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Gltf => "glTF",
        })
    }
}

/// Whether `bytes` are exactly as long as a binary STL file of the count they would hold.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    count.is_some_and(|count| bytes.len() as u64 == 84 + 50 * u64::from(count))
}

/// Whether `bytes` begin as ascii STL does and are text. Many binary files begin with "solid" too;
/// but their facet count, below 2^24, has a zero byte.
pub(super) fn is_ascii_stl(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let word = start.get(..5).unwrap_or_default();
    let after = start.get(5).is_none_or(u8::is_ascii_whitespace);
    word.eq_ignore_ascii_case(b"solid") && after && !bytes.contains(&0)
}

/// The one property that every glTF document has.
fn mentions_asset(json: &[u8]) -> bool {
    json.windows(7).any(|window| window == b"\"asset\"")
}

/// Whether the first line that is no comment starts with a word that OBJ files start with.
fn starts_like_obj(text: &[u8]) -> bool {
    const WORDS: [&[u8]; 9] = [b"v", b"vt", b"vn", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl"];
    let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && line[0] != b'#').unwrap_or_default();
    let mut words = first.split(u8::is_ascii_whitespace);
    WORDS.contains(&words.next().unwrap_or_default()) && words.next().is_some()
}
