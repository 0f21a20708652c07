//! Every mesh there is to test on: the shapes, then the models.

use drypoint_mesh::{Mesh, io, shapes};

use crate::models;

/// Hands every mesh whose name holds `only` to `visit`: the shapes first, then the files of the
/// folder that `DRYPOINT_MODELS` names, read one at a time.
///
/// # Errors
/// What `visit` fails with, a file that cannot be read, or no mesh of such a name.
pub fn for_each(
    only: &str,
    mut visit: impl FnMut(&str, &Mesh) -> Result<(), String>,
) -> Result<(), String> {
    let mut visited = 0;
    for shape in shapes::all().into_iter().filter(|shape| shape.name.contains(only)) {
        visit(shape.name, &shape.mesh)?;
        visited += 1;
    }
    for path in models::files()? {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if name.contains(only) {
            let model = io::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            visit(&name, &model.mesh)?;
            visited += 1;
        }
    }
    if visited == 0 { Err(format!("no mesh has {only:?} in its name")) } else { Ok(()) }
}
