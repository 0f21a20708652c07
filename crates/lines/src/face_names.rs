//! What faces are called: the parts they belong to, or their materials.

use std::ops::Range;

/// Names of faces, by runs of them. A face without a name has the empty one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceNames {
    /// Each with the faces that have it, ascending.
    runs: Vec<(Range<u32>, u32)>,
    /// Each once; the empty one first.
    names: Vec<String>,
}

impl FaceNames {
    /// Takes runs of faces in ascending order, as [`drypoint_mesh::io::Model`] has them. Runs of the
    /// same name are of one part, or of one material. Linear in the runs, times the logarithm of
    /// their number.
    pub fn new<'n>(runs: impl IntoIterator<Item = (&'n str, Range<u32>)>) -> Self {
        let mut ids = std::collections::BTreeMap::from([("", 0)]);
        let mut names = vec![String::new()];
        let runs = runs.into_iter().map(|(name, faces)| {
            let id = *ids.entry(name).or_insert_with(|| {
                names.push(name.to_owned());
                u32::try_from(names.len() - 1).unwrap_or_default()
            });
            (faces, id)
        });
        Self { runs: runs.collect(), names }
    }

    /// The name of a face, as an index into [`FaceNames::names`]: equal if the names are. A search
    /// in the runs.
    pub fn of(&self, face: u32) -> usize {
        let next = self.runs.partition_point(|(faces, _)| faces.start <= face);
        let run = next.checked_sub(1).map(|last| &self.runs[last]);
        run.filter(|(faces, _)| faces.contains(&face)).map_or(0, |&(_, id)| id as usize)
    }

    /// Every name once: the empty one, then the others in the order in which they first come up.
    pub fn names(&self) -> &[String] {
        &self.names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_the_same_wherever_it_comes_up() {
        let names = FaceNames::new([("red", 0..2), ("", 2..3), ("blue", 3..4), ("red", 5..6)]);
        assert_eq!(names.names(), ["", "red", "blue"]);
        let found: Vec<_> = (0..8).map(|face| names.names()[names.of(face)].as_str()).collect();
        assert_eq!(found, ["red", "red", "", "blue", "", "red", "", ""]);
        assert_eq!(FaceNames::default().of(7), 0);
    }
}
