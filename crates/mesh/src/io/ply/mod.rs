//! Stanford PLY, ascii and binary of both endiannesses.
//!
//! Greg Turk, The PLY Polygon File Format, 1994. Read here rather than by a crate: `ply-rs-bw`, at
//! 4.0, keeps a hash map for every row, or takes some three times as long into structs.
//!
//! Read are `x`, `y` and `z` of the element `vertex`; lists `vertex_indices` or `vertex_index` of
//! `face`; and of `tristrips`, where −1 ends a strip and every second triangle is turned, as in the
//! files of the Stanford 3D Scanning Repository. Everything else is skipped.
//!
//! A file is read in pieces, by all threads: first one looks where rows begin, then all read them.
//! The first thing that is wrong in the first piece that has any is the first of the file.

mod ascii;
mod binary;
mod header;
mod row;

use rayon::prelude::*;

use super::ReadOptions;
use super::error::ReadError;
use super::parts::Model;
use crate::io::content::Content;
use header::{Encoding, Kind};
use row::Rows;

/// Reads a PLY file.
pub(super) fn parse(bytes: &[u8], size: usize, options: &ReadOptions) -> Result<Model, ReadError> {
    in_pieces(bytes, size, options)?.into_model()
}

/// About how many vertices and triangles a file of so many bytes holds that begins with `start`: what its
/// header says, but no more than there are bytes for.
pub(super) fn estimate(start: &[u8], bytes: u64) -> Option<[u64; 2]> {
    let (header, lines) = header::parse(start).ok()?;
    let mut left = bytes.saturating_sub((start.len() - lines.rest().len()) as u64);
    let is_text = header.encoding == Encoding::Ascii;
    let (mut vertices, mut triangles) = (0, 0);
    for table in header.tables() {
        // A value takes a digit and a separator.
        let least =
            if is_text { 2 * table.properties.len() } else { table.least_row_size() } as u64;
        let rows = table.count.min(left / least);
        match table.kind {
            Kind::Vertex { .. } => vertices = rows,
            // Faces mostly come last, and so tell by their bytes how many corners they have. No more
            // than four, lest bytes of something else are taken for theirs.
            Kind::Face { list } if !is_text => {
                let value = table.properties[list].value.size() as u64;
                let corners = (left / rows.max(1)).saturating_sub(least) / value;
                triangles += rows * corners.clamp(3, 4).saturating_sub(2);
            }
            Kind::Face { .. } => triangles += rows,
            Kind::Strips { list } => {
                let value = if is_text { 2 } else { table.properties[list].value.size() as u64 };
                triangles += left / value;
            }
            Kind::Other => {}
        }
        left -= rows * least;
    }
    Some([vertices, triangles])
}

/// What a file holds, read in pieces of some `size` bytes.
fn in_pieces(bytes: &[u8], size: usize, options: &ReadOptions) -> Result<Content, ReadError> {
    let (header, lines) = header::parse(bytes)?;
    let rows = || Rows::new(&header, options);
    let found: Vec<Result<Content, ReadError>> = match header.encoding {
        Encoding::Ascii => ascii::pieces(&header, lines, size)
            .into_par_iter()
            .map(|piece| rows().read_text(piece))
            .collect(),
        Encoding::LittleEndian | Encoding::BigEndian => binary::pieces(&header, lines.rest(), size)
            .into_par_iter()
            .map(|piece| rows().read_bytes(bytes, &piece))
            .collect(),
    };
    let pieces: Vec<Content> = found.into_iter().collect::<Result<_, _>>()?;
    Ok(Content::joined(pieces))
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;

    const VERTEX: &str = "property float x\nproperty float y\nproperty float z\n";
    const FACE: &str = "property list uchar int vertex_index\n";

    /// Reads `bytes` in pieces of `size`, and as one.
    #[track_caller]
    fn check(bytes: &[u8], size: usize, options: &ReadOptions) {
        let read = |size| {
            let read = in_pieces(bytes, size, options).and_then(Content::into_model);
            read.map_err(|error| error.to_string())
        };
        assert_eq!(read(size), read(usize::MAX / 2));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn lines_in_pieces_are_the_whole(
            lines in vec(select(&["0 0 1", " 1 2 3", "nan 1 2", "1 2", "1e99 0 0 ", "", "\r"][..]), 0..9),
            faces in vec(select(&["3 0 1 2", "4 2 1 0 1", "3 0 1 9", "3 1 0 2 7", " ", "3 0 1 -1"][..]), 0..9),
            missing in 0usize..2, wide in any::<bool>(), last in select(&["", "\n"][..]),
            size in 1usize..60, strict in any::<bool>(),
        ) {
            let rows = |lines: &[&str]| lines.iter().filter(|line| !line.trim().is_empty()).count();
            let [vertices, triangles] = [rows(&lines), rows(&faces) + missing];
            let face = if wide { "property uchar r\n" } else { "" };
            let lines: String = lines.iter().chain(&faces).map(|line| format!("{line}\n")).collect();
            let text = format!(
                "ply\nformat ascii 1.0\nelement vertex {vertices}\n{VERTEX}element none 3\n\
                 element face {triangles}\n{FACE}{face}end_header\n{}{last}",
                lines.trim_end_matches('\n'),
            );
            check(text.as_bytes(), size, &ReadOptions { strict });
        }

        #[test]
        fn bytes_in_pieces_are_the_whole(
            vertices in vec([any::<u8>(), any::<u8>(), any::<u8>()], 0..9),
            faces in vec(vec(0u8..9, 3..5), 0..9), big in any::<bool>(), wide in any::<bool>(),
            cut in 0usize..40, extra in 0usize..2, size in 1usize..60, strict in any::<bool>(),
        ) {
            let encoding = if big { "binary_big_endian" } else { "binary_little_endian" };
            let (count, face_count) = (vertices.len(), faces.len() + extra);
            let more = if wide { "property short s\nproperty list ushort uchar l\n" } else { "" };
            let mut bytes = format!(
                "ply\nformat {encoding} 1.0\nelement vertex {count}\n{VERTEX}\
                 element face {face_count}\n{FACE}{more}end_header\n"
            )
            .into_bytes();
            let value = |bits: u32| if big { bits.to_be_bytes() } else { bits.to_le_bytes() };
            for x in vertices.into_iter().flatten() {
                // One in some is not finite.
                bytes.extend(value(if x == 7 { f32::NAN.to_bits() } else { f32::from(x).to_bits() }));
            }
            for face in faces {
                bytes.push(u8::try_from(face.len()).unwrap());
                face.iter().for_each(|&vertex| bytes.extend(value(u32::from(vertex))));
                if wide {
                    bytes.extend([0; 4]);
                }
            }
            if cut < 20 {
                bytes.truncate(bytes.len().saturating_sub(cut));
            }
            check(&bytes, size, &ReadOptions { strict });
        }
    }
}
