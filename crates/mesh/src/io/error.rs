//! What can be wrong with a mesh file, and where.

use std::{fmt, io};

use super::Format;
use crate::MeshError;
use crate::rig::CurveError;

/// Why a file gives no mesh. Each displays as one line that reads on from the file's name:
/// `bunny.obj: line 12: "1.2.3" is not a number`.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file is missing, or the system does not let it be read.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// The file has no bytes.
    #[error("is empty")]
    Empty,
    /// The name says nothing about the format, or names one that is not known.
    #[error("has {}; only {} can be read", shown_extension(extension), supported())]
    UnknownExtension {
        /// The extension without its dot; empty if there is none.
        extension: String,
    },
    /// The name says one format and the content another.
    #[error("has extension .{extension} but is {} file", with_article(*content))]
    WrongExtension {
        /// The extension without its dot.
        extension: String,
        /// What the content looks like.
        content: Format,
    },
    /// The feature of this format was left out of the build.
    #[error("is {} file, which this build cannot read", with_article(*format))]
    NotBuiltIn {
        /// The format.
        format: Format,
    },
    /// A glTF file needs an extension that may change its geometry.
    #[error("requires the glTF extension {}, which is not supported", quoted(name))]
    RequiredExtension {
        /// As the file spells it.
        name: String,
    },
    /// One place in the file is wrong.
    #[error("{place}: {fault}")]
    Malformed {
        /// Where.
        place: Place,
        /// What.
        fault: Fault,
    },
    /// There is nothing to draw.
    #[error("has no faces")]
    NoFaces,
    /// Every face uses a vertex that is NaN, infinite or beyond the range of f32.
    #[error("has no face without a vertex at no finite position; faces left out: {count}")]
    NoFiniteFaces {
        /// How many there are.
        count: usize,
    },
    /// The parts are sound and the whole is not: too many triangles.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Where in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// A line of a text file, counted from 1. Of lines joined by `\`, the first.
    Line(u64),
    /// An offset from the start of the file.
    Byte(u64),
    /// A row of a binary file: a vertex, a face, a facet.
    Row {
        /// What the file calls it.
        element: String,
        /// Counted from 0.
        row: u64,
        /// Offset of the byte after the last one that was understood.
        byte: u64,
    },
    /// An object of a glTF document, such as `meshes[0].primitives[1]`.
    Json(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::Row { element, row, byte } => {
                write!(f, "{} {row} (byte {byte})", shortened(element))
            }
            Self::Json(path) => f.write_str(path),
        }
    }
}

/// What is wrong there. Vertices are counted as the file counts them: OBJ from 1, others from 0.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Text where a number must be.
    #[error("{} is not a number", quoted(text))]
    NotANumber {
        /// The text.
        text: String,
    },
    /// Text, or a number, that can be no index.
    #[error("{} is not a vertex index", quoted(text))]
    NotAnIndex {
        /// The text.
        text: String,
    },
    /// Numbers are missing.
    #[error("has {found} numbers, but {expected} are needed")]
    TooFewNumbers {
        /// How many there are.
        found: usize,
        /// How many there must be at least.
        expected: usize,
    },
    /// More on a line than belongs there.
    #[error("has {} left over", quoted(text))]
    LeftOver {
        /// The first text too many.
        text: String,
    },
    /// A NaN or infinite coordinate, or one beyond the range of f32.
    #[error("vertex {vertex} is at ({}, {}, {}), which is no finite position", position[0], position[1], position[2])]
    NotFinite {
        /// The vertex.
        vertex: u64,
        /// Its position.
        position: [f32; 3],
    },
    /// Index 0 in an OBJ file.
    #[error("uses vertex 0, but OBJ counts from 1")]
    ZeroIndex,
    /// An index beyond the last vertex.
    #[error("uses vertex {vertex}, but there are only {vertex_count}")]
    VertexOutOfRange {
        /// The index as the file gives it.
        vertex: i64,
        /// How many vertices the file has.
        vertex_count: u64,
    },
    /// A negative OBJ index that reaches back too far.
    #[error("uses vertex {vertex}, but only {vertex_count} come before")]
    RelativeOutOfRange {
        /// The index as the file gives it.
        vertex: i64,
        /// How many vertices there are before this line.
        vertex_count: u64,
    },
    /// A face of no, one or two corners.
    #[error("has {corners} corners, but a face needs 3")]
    TooFewCorners {
        /// How many it has.
        corners: usize,
    },
    /// An STL facet that is no triangle.
    #[error("has {corners} vertices, but a facet has 3")]
    NotATriangle {
        /// How many it has.
        corners: usize,
    },
    /// A zero byte where text is expected.
    #[error("is zero, so this is no text file")]
    NotText,
    /// The file is cut off.
    #[error("the file ends after {rows} of {expected} rows of {}", quoted(element))]
    EndsEarly {
        /// What the rows are.
        element: String,
        /// Whole rows that are there.
        rows: u64,
        /// Rows that were announced.
        expected: u64,
    },
    /// The file is cut off inside something that must be closed.
    #[error("the file ends before {missing}")]
    Unfinished {
        /// What should have come.
        missing: &'static str,
    },
    /// Something else was expected here.
    #[error("expected {expected}, found {}", quoted(found))]
    Unexpected {
        /// What belongs here.
        expected: &'static str,
        /// What is here.
        found: String,
    },
    /// A part without which there is no mesh.
    #[error("has no {missing}")]
    Missing {
        /// The part.
        missing: &'static str,
    },
    /// A PLY element or property of a name that was used before.
    #[error("declares {} a second time", quoted(name))]
    Twice {
        /// The name.
        name: String,
    },
    /// Fewer bytes than the data takes.
    #[error("needs {needed} bytes, but there are only {available}")]
    TooShort {
        /// How many it takes; `u64::MAX` for more than can be counted.
        needed: u64,
        /// How many there are.
        available: u64,
    },
    /// Neither of the two ways to write an STL file.
    #[error(
        "is neither STL text, which begins with \"solid\", nor a whole binary STL, which would have {needed} bytes, not {available}"
    )]
    NotStl {
        /// How many the count in its header asks for, or the header itself.
        needed: u64,
        /// How many there are.
        available: u64,
    },
    /// A reference to a glTF object that is not there.
    #[error("uses {kind}[{index}], but there are only {count}")]
    NoSuchObject {
        /// The array of the document.
        kind: &'static str,
        /// Its index.
        index: u64,
        /// How many there are.
        count: u64,
    },
    /// Data of a type that cannot be used so.
    #[error("is not {expected}")]
    WrongType {
        /// What it must be.
        expected: &'static str,
    },
    /// A byte stride shorter than what it steps over.
    #[error("steps by {stride} bytes over elements of {size}")]
    Stride {
        /// Bytes from one element to the next.
        stride: u64,
        /// Bytes of an element.
        size: u64,
    },
    /// A glTF node that is a child of two others.
    #[error("has two parents")]
    TwoParents,
    /// A glTF node that hangs below itself.
    #[error("is its own ancestor")]
    Cycle,
    /// A skin without an inverse bind matrix for each of its joints.
    #[error("has {needed} joints, but only {available} inverse bind matrices")]
    TooFewMatrices {
        /// How many joints there are.
        needed: u64,
        /// How many matrices there are.
        available: u64,
    },
    /// A vertex that follows a joint which its skin does not have.
    #[error("vertex {vertex} follows joint {joint}, but there are only {joint_count}")]
    JointOutOfRange {
        /// The vertex.
        vertex: u64,
        /// The joint.
        joint: u64,
        /// How many joints the skin has.
        joint_count: u64,
    },
    /// Data that a glTF file uses again and again.
    #[error("repeats data until it needs far more memory than a file of {bytes} bytes may")]
    OutOfProportion {
        /// Bytes of the document and its buffers.
        bytes: u64,
    },
    /// Keys of an animation that make no curve.
    #[error("{error}")]
    Curve {
        /// What is wrong with them.
        error: CurveError,
    },
    /// A file named by a glTF file cannot be read.
    #[error("the file {} cannot be read: {error}", quoted(uri))]
    External {
        /// As the document spells it.
        uri: String,
        /// Why.
        error: io::Error,
    },
    /// The document itself cannot be understood.
    #[error("is no valid glTF: {message}")]
    Document {
        /// What the parser says.
        message: String,
    },
}

impl Fault {
    /// This fault at `place`.
    pub(super) fn at(self, place: Place) -> ReadError {
        ReadError::Malformed { place, fault: self }
    }

    /// This fault on a line.
    pub(super) fn on_line(self, line: u64) -> ReadError {
        self.at(Place::Line(line))
    }
}

/// Bytes as text for a message, whatever they are.
pub(super) fn lossy(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Text from a file, cut and escaped so that a message stays one readable line.
fn quoted(text: &str) -> String {
    format!("\"{}\"", shortened(text))
}

fn shortened(text: &str) -> String {
    const MAX: usize = 40;
    let escaped: String = text.chars().take(MAX).flat_map(char::escape_debug).collect();
    let dots = if text.chars().nth(MAX).is_some() { "…" } else { "" };
    // Quotes are no danger to a line and read better bare.
    escaped.replace("\\\"", "\"").replace("\\'", "'") + dots
}

fn shown_extension(extension: &str) -> String {
    if extension.is_empty() {
        "no extension".to_owned()
    } else {
        format!("the unknown extension .{}", shortened(extension))
    }
}

fn supported() -> String {
    let all: Vec<String> = Format::EXTENSIONS.iter().map(|(name, _)| format!(".{name}")).collect();
    all.join(", ")
}

fn with_article(format: Format) -> String {
    let article = if matches!(format, Format::Obj | Format::Stl) { "an" } else { "a" };
    format!("{article} {format}")
}
