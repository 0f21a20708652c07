//! What the fuzz targets check, and the tests check on their corpora: these files are those of the
//! package `drypoint-tests`, without what else that package needs.

#[path = "../../tests/src/boundary.rs"]
pub mod boundary;
#[path = "../../tests/src/compare.rs"]
pub mod compare;
#[path = "../../tests/src/hostile.rs"]
pub mod hostile;
#[path = "../../tests/src/judges.rs"]
pub mod judges;
#[path = "../../tests/src/presets.rs"]
pub mod presets;
#[path = "../../tests/src/soup.rs"]
pub mod soup;
