//! STL, ascii and binary.
//!
//! Read here rather than by the crate `stl_io`, which at 0.11 takes every file that begins with
//! "solid " for text, as many binary ones do; stops at the first `endsolid`, losing the other
//! solids of the file without a word; refuses facets whose unused normal is NaN; and says no line.
//! A test compares both where they should agree.
//!
//! Normals and attributes are ignored. Vertices stay as they are stored, three to a facet.
//!
//! Both kinds are read in pieces, by all threads; a text that is wrong once more from its beginning.

use glam::Vec3;
use rayon::prelude::*;

use super::content::Content;
use super::error::{Fault, Place, ReadError, lossy};
use super::format::is_ascii_stl;
use super::parts::{Model, Parts};
use super::polygon::Faces;
use super::text::{self, Lines, Plain, Words};
use super::{PIECE, ReadOptions};

/// Bytes before the facets of a binary file: 80 that mean nothing and the count.
const HEADER: usize = 84;
/// Bytes of a facet: normal, three vertices, attributes.
const FACET: usize = 50;

/// Reads an STL file, text or binary.
pub(super) fn parse(bytes: &[u8], size: usize, options: &ReadOptions) -> Result<Model, ReadError> {
    let content = if is_ascii_stl(bytes) {
        match in_pieces(bytes, size, options) {
            Some(content) => content,
            None => in_one(bytes, options)?,
        }
    } else {
        from_binary(bytes, options)?
    };
    content.into_model()
}

/// The content of a text that is good; of others `None`.
fn in_pieces(bytes: &[u8], size: usize, options: &ReadOptions) -> Option<Content> {
    // Wherever a facet begins the state is the same: in a solid, and in no facet.
    let begins_facet = |_: &[u8], after: &[u8]| {
        // Of the next line alone, so that many empty ones are not looked through again and again.
        let line = &after[..memchr::memchr(b'\n', after).unwrap_or(after.len())];
        let word = line.trim_ascii_start();
        word.get(..6).is_some_and(|word| word.eq_ignore_ascii_case(b"facet "))
    };
    let pieces = text::pieces(bytes, size, begins_facet);
    let last = pieces.len() - 1;
    let read = |(index, text): (usize, &&[u8])| {
        let between = State { in_solid: true, facet: None };
        let state = if index == 0 { State::default() } else { between };
        let mut solids = Solids { state, ..Solids::new(options) };
        solids.read(&mut Lines::new(text)).ok()?;
        let end = if index == last { State::default() } else { between };
        (solids.state == end).then(|| solids.into_content())
    };
    let pieces: Option<Vec<Content>> = pieces.par_iter().enumerate().map(read).collect();
    pieces.map(with_all_triangles)
}

/// The same, or the first thing that is wrong.
fn in_one(bytes: &[u8], options: &ReadOptions) -> Result<Content, ReadError> {
    let mut solids = Solids::new(options);
    let mut lines = Lines::new(bytes);
    let read = solids.read(&mut lines);
    read.and(solids.state.finished()).map_err(|fault| fault.on_line(lines.number()))?;
    Ok(with_all_triangles(vec![solids.into_content()]))
}

/// The pieces as one, with triangles of three vertices each in a row.
fn with_all_triangles(pieces: Vec<Content>) -> Content {
    let content = Content::joined(pieces);
    Content { faces: triangles(content.positions.len()), ..content }
}

/// Three of so many vertices each in a row.
fn triangles(vertex_count: usize) -> Faces {
    // More than fit are refused by their number.
    let corner = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
    let corners = |facet: usize| [0, 1, 2].map(|i| corner(3 * facet + i));
    Faces::of_triangles((0..vertex_count / 3).into_par_iter().map(corners).collect())
}

fn from_binary(bytes: &[u8], options: &ReadOptions) -> Result<Content, ReadError> {
    let available = bytes.len() as u64;
    let not_stl = |needed| Fault::NotStl { needed, available }.at(Place::Byte(0));
    let Some((header, facets)) = bytes.split_first_chunk::<HEADER>() else {
        return Err(not_stl(HEADER as u64));
    };
    let count = u32::from_le_bytes([header[80], header[81], header[82], header[83]]);
    let needed = HEADER as u64 + FACET as u64 * u64::from(count);
    if available < needed {
        return Err(not_stl(needed));
    }
    let (facets, _) = facets.as_chunks::<FACET>();
    let facets = &facets[..count as usize];
    let vertex = |facet: &[u8; FACET], corner: usize| {
        let (coordinates, _) = facet[12 + 12 * corner..].as_chunks::<4>();
        Vec3::from_array([0, 1, 2].map(|i| f32::from_le_bytes(coordinates[i])))
    };
    let mut positions: Vec<Vec3> = bytemuck::zeroed_vec(3 * facets.len());
    positions.par_chunks_exact_mut(3).with_min_len(PIECE / FACET).zip(facets).for_each(
        |(corners, facet)| {
            for (corner, position) in corners.iter_mut().enumerate() {
                *position = vertex(facet, corner);
            }
        },
    );
    if options.strict
        && let Some(vertex) = positions.iter().position(|position| !position.is_finite())
    {
        let (row, position) = (vertex / 3, positions[vertex].to_array());
        let byte = (HEADER + FACET * row) as u64;
        let place = Place::Row { element: "facet".to_owned(), row: row as u64, byte };
        return Err(Fault::NotFinite { vertex: vertex as u64, position }.at(place));
    }
    let faces = triangles(positions.len());
    Ok(Content { positions, faces, ..Content::default() })
}

/// Where in a text we are.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct State {
    in_solid: bool,
    /// Vertices so far, inside a facet.
    facet: Option<usize>,
}

impl State {
    /// Whether the text may end here.
    fn finished(self) -> Result<(), Fault> {
        match self {
            Self { facet: Some(_), .. } => Err(Fault::Unfinished { missing: "endfacet" }),
            Self { in_solid: true, .. } => Err(Fault::Unfinished { missing: "endsolid" }),
            _ => Ok(()),
        }
    }
}

/// Reads a text.
struct Solids<'a> {
    options: &'a ReadOptions,
    positions: Vec<Vec3>,
    parts: Parts,
    state: State,
}

impl<'a> Solids<'a> {
    fn new(options: &'a ReadOptions) -> Self {
        let (positions, parts) = (Vec::new(), Parts::default());
        Self { options, positions, parts, state: State::default() }
    }

    /// What was read; triangles are made when all are.
    fn into_content(self) -> Content {
        let faces = triangles(self.positions.len());
        Content { positions: self.positions, faces, parts: self.parts, ..Content::default() }
    }

    fn vertex(&mut self, position: [f32; 3]) -> Result<(), Fault> {
        if self.options.strict && position.iter().any(|x| !x.is_finite()) {
            let vertex = self.positions.len() as u64;
            return Err(Fault::NotFinite { vertex, position });
        }
        self.positions.push(position.into());
        Ok(())
    }

    fn read(&mut self, lines: &mut Lines<'_>) -> Result<(), Fault> {
        loop {
            if lines.take_plain(|line| self.plain(line)) {
                continue;
            }
            let Some(line) = lines.next_line() else { return Ok(()) };
            self.line(line)?;
        }
    }

    /// Reads vertices as they are nearly always written.
    fn plain(&mut self, line: &mut Plain<'_>) -> Option<()> {
        let corners = self.state.facet?;
        line.spaces();
        line.keyword(b"vertex")?;
        let position = line.position()?;
        line.end_line()?;
        self.vertex(position).ok()?;
        self.state.facet = Some(corners + 1);
        Some(())
    }

    fn line(&mut self, line: &[u8]) -> Result<(), Fault> {
        let mut words = Words(line);
        let Some(word) = words.next() else { return Ok(()) };
        let is = |name: &[u8]| word.eq_ignore_ascii_case(name);
        let unexpected = |expected| Err(Fault::Unexpected { expected, found: shown(line) });
        let State { in_solid, facet } = &mut self.state;
        match *facet {
            _ if !*in_solid => {
                if !is(b"solid") {
                    return unexpected("solid");
                }
                *in_solid = true;
                self.parts.begin(shown(words.0), self.positions.len() / 3);
            }
            None if is(b"endsolid") => *in_solid = false,
            None if is(b"facet") => *facet = Some(0),
            None => return unexpected("facet or endsolid"),
            Some(corners) if is(b"vertex") => {
                *facet = Some(corners + 1);
                self.vertex(text::position(&mut words)?)?;
                if let Some(word) = words.next() {
                    return Err(Fault::LeftOver { text: lossy(word) });
                }
            }
            Some(3) if is(b"endfacet") => *facet = None,
            Some(corners) if is(b"endfacet") => return Err(Fault::NotATriangle { corners }),
            Some(_) if is(b"outer") || is(b"endloop") => {}
            Some(_) => return unexpected("vertex or endfacet"),
        }
        Ok(())
    }
}

fn shown(text: &[u8]) -> String {
    lossy(text.trim_ascii())
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;

    /// Lines of files, good and bad.
    const LINES: [&str; 10] = [
        "facet normal 0 0 1\n outer loop\nvertex 0 0 0\n  vertex 1 0 0\nVertex 0 1e0 0\nendloop\nendfacet",
        "facet normal 0 0 1\nvertex nan 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet",
        " FACET x\nvertex 0 0 0\nvertex 5 0 0\nvertex 0 6 0\nendfacet",
        "endsolid a\nsolid b",
        "facet normal",
        "vertex 1 2 3",
        "endfacet",
        "endsolid",
        "solid c",
        "",
    ];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn pieces_of_any_size_are_the_whole(
            lines in vec(select(&LINES[..]), 0..20), most in 4usize..=10, size in 1usize..200,
            strict in any::<bool>(),
        ) {
            let lines = lines.iter().filter(|line| LINES[..most].contains(line));
            let text = lines.fold("solid a\n".to_owned(), |text, line| text + line + "\n");
            let text = text + "endsolid";
            let options = ReadOptions { strict };
            let whole = in_one(text.as_bytes(), &options);
            let pieces = in_pieces(text.as_bytes(), size, &options);
            prop_assert_eq!(pieces.is_some(), whole.is_ok(), "{:?}", text);
            let model = |content: Content| content.into_model().map_err(|error| error.to_string());
            if let (Some(pieces), Ok(whole)) = (pieces, whole) {
                prop_assert_eq!(model(pieces), model(whole));
            }
        }
    }
}
