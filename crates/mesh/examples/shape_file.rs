//! Writes a built-in shape to a file, to have one of any size.
//!
//! ```sh
//! cargo run --release -p drypoint-mesh --example shape_file -- bumpy-sphere 10000000 big.ply
//! ```
//!
//! Binary PLY, or OBJ if the name ends so. Shapes are those of `drypoint --help`.

use std::fs::File;
use std::io::{BufWriter, Write};

use drypoint_mesh::{Mesh, shapes};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, triangles, path] = &arguments[..] else {
        return Err("a shape, a number of triangles and a file are needed".into());
    };
    let mesh =
        shapes::by_name(name, triangles.parse()?).ok_or(format!("there is no shape {name}"))?;
    let mut file = BufWriter::new(File::create(path).map_err(|error| format!("{path}: {error}"))?);
    if path.ends_with(".obj") {
        obj(&mesh, &mut file)?
    } else {
        ply(&mesh, &mut file)?
    }
    Ok(file.flush()?)
}

fn obj(mesh: &Mesh, file: &mut impl Write) -> std::io::Result<()> {
    for p in mesh.positions() {
        writeln!(file, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|v| v + 1)) {
        writeln!(file, "f {a} {b} {c}")?;
    }
    Ok(())
}

fn ply(mesh: &Mesh, file: &mut impl Write) -> std::io::Result<()> {
    let (vertices, faces) = (mesh.positions().len(), mesh.triangles().len());
    writeln!(
        file,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\nelement face {faces}\n\
         property list uchar int vertex_index\nend_header"
    )?;
    for p in mesh.positions() {
        p.to_array().iter().try_for_each(|x| file.write_all(&x.to_le_bytes()))?;
    }
    for triangle in mesh.triangles() {
        file.write_all(&[3])?;
        triangle.iter().try_for_each(|v| file.write_all(&v.to_le_bytes()))?;
    }
    Ok(())
}
