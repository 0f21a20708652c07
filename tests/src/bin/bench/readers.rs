//! Files, read by us and by others, each the way it is fastest that its documentation knows of.

use std::fs::{self, File};
use std::hint::black_box;
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use drypoint_mesh::{Mesh, io, shapes};
use drypoint_tests::report::{FileRead, Quartiles, ReaderTime, Reading};
use ply_rs_bw::parser::{Parser, Reader as PlyReader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};
use serde::Deserialize;

use crate::kept::Kept;
use crate::{Options, Section, machine};

/// Bytes below which a file is read too fast to be timed.
const LEAST: u64 = 1_000_000;

/// Triangles of the shape that is written in each format.
const FACES: usize = 1_000_000;

/// Bytes that others read from a file at once.
const BUFFER: usize = 1 << 16;

type Corners = Vec<[[f32; 3]; 3]>;

/// Reads a file, and gives the corners of all triangles if they are wanted, to compare.
struct Reader {
    name: &'static str,
    read: fn(&Path, bool) -> Result<Corners, String>,
}

const OURS: Reader = Reader { name: "drypoint", read: ours };

const OF_OBJ: [Reader; 6] = [
    OURS,
    Reader { name: "mesh-loader 0.1", read: mesh_loader },
    Reader { name: "tobj 4", read: tobj },
    Reader { name: "wobj 0.3", read: wobj },
    Reader { name: "obj-rs 0.7", read: obj_rs },
    Reader { name: "wavefront_obj 11", read: wavefront_obj },
];

const OF_PLY: [Reader; 3] = [
    OURS,
    Reader { name: "serde-ply 0.2", read: serde_ply },
    Reader { name: "ply-rs-bw 4", read: ply_rs_bw },
];

/// Times all readers on the files that are large enough, and on a shape in each format.
pub(crate) fn measure(
    kept: &Kept,
    options: &Options,
    files: &[PathBuf],
) -> Result<Option<Reading>, String> {
    if !options.wants(Section::Readers) {
        return Ok(None);
    }
    let folder = tempfile::tempdir().map_err(said)?;
    let mut paths = shape_files(folder.path(), options).map_err(said)?;
    let is_large = |path: &&PathBuf| path.metadata().is_ok_and(|about| about.len() >= LEAST);
    paths.extend(files.iter().filter(is_large).cloned());
    let mut read = Vec::new();
    for path in paths {
        let readers: &[Reader] = match path.extension().unwrap_or_default().to_str() {
            Some("obj") => &OF_OBJ,
            Some("ply") => &OF_PLY,
            _ => continue,
        };
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let rounds = options.rounds();
        let measured = kept.or_measure(&format!("{name}, readers"), &rounds.to_string(), || {
            in_turn(&name, &path, readers, rounds)
        })?;
        read.push(measured);
    }
    Ok(Some(Reading { machine: machine::machine(), run: machine::run(options), files: read }))
}

fn in_turn(name: &str, path: &Path, readers: &[Reader], rounds: u32) -> Result<FileRead, String> {
    let expected = (OURS.read)(path, true)?;
    let agrees = |reader: &&Reader| (reader.read)(path, true).is_ok_and(|found| found == expected);
    let readers: Vec<&Reader> = readers.iter().filter(agrees).collect();
    let faces = expected.len();
    drop(expected);
    let mut times = vec![Vec::new(); readers.len()];
    for _ in 0..rounds {
        for (reader, times) in readers.iter().zip(&mut times) {
            let start = Instant::now();
            black_box((reader.read)(path, false)?);
            times.push(start.elapsed().as_secs_f64());
        }
    }
    let time = |(reader, own): (&&Reader, &Vec<f64>)| ReaderTime {
        name: reader.name.to_owned(),
        seconds: Quartiles::of(own.iter().copied()).median,
        over_ours: Quartiles::of_ratios(own, &times[0]),
    };
    let readers = readers.iter().zip(&times).map(time).collect();
    let bytes = path.metadata().map_err(said)?.len();
    Ok(FileRead { name: name.to_owned(), bytes, faces, readers })
}

/// The same mesh as OBJ and as PLY, in text and in bytes.
fn shape_files(folder: &Path, options: &Options) -> std::io::Result<Vec<PathBuf>> {
    let mesh = shapes::bumpy_sphere(if options.quick { FACES / 10 } else { FACES });
    let paths = ["bumpy-sphere.obj", "bumpy-sphere-ascii.ply", "bumpy-sphere.ply"];
    let paths = paths.map(|name| folder.join(name));
    write_obj(&mesh, &paths[0])?;
    write_ply(&mesh, &paths[1], true)?;
    write_ply(&mesh, &paths[2], false)?;
    Ok(paths.into())
}

fn write_obj(mesh: &Mesh, path: &Path) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for p in mesh.positions() {
        writeln!(file, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|v| v + 1)) {
        writeln!(file, "f {a} {b} {c}")?;
    }
    file.flush()
}

fn write_ply(mesh: &Mesh, path: &Path, is_text: bool) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    let encoding = if is_text { "ascii" } else { "binary_little_endian" };
    let (vertices, faces) = (mesh.positions().len(), mesh.triangles().len());
    writeln!(
        file,
        "ply\nformat {encoding} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nelement face {faces}\nproperty list uchar int vertex_index\nend_header"
    )?;
    for p in mesh.positions() {
        if is_text {
            writeln!(file, "{} {} {}", p.x, p.y, p.z)?;
        } else {
            p.to_array().iter().try_for_each(|x| file.write_all(&x.to_le_bytes()))?;
        }
    }
    for [a, b, c] in mesh.triangles() {
        if is_text {
            writeln!(file, "3 {a} {b} {c}")?;
        } else {
            file.write_all(&[3])?;
            [a, b, c].iter().try_for_each(|v| file.write_all(&v.to_le_bytes()))?;
        }
    }
    file.flush()
}

fn said(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn open(path: &Path) -> Result<BufReader<File>, String> {
    Ok(BufReader::with_capacity(BUFFER, File::open(path).map_err(said)?))
}

/// All corners, or none.
fn corners(wanted: bool, all: impl Iterator<Item = [[f32; 3]; 3]>) -> Corners {
    if wanted { all.collect() } else { Vec::new() }
}

fn ours(path: &Path, wanted: bool) -> Result<Corners, String> {
    let model = black_box(io::read(path).map_err(said)?);
    let mesh = &model.mesh;
    Ok(corners(wanted, mesh.triangles().iter().map(|t| t.map(|v| mesh.position(v).to_array()))))
}

fn tobj(path: &Path, wanted: bool) -> Result<Corners, String> {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    let no_materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) =
        black_box(tobj::load_obj_buf(&mut open(path)?, &options, no_materials).map_err(said)?);
    let mut all = Corners::new();
    for tobj::Model { mesh, .. } in &models {
        let at = |v: u32| std::array::from_fn(|i| mesh.positions[3 * v as usize + i]);
        let (triangles, _) = mesh.indices.as_chunks::<3>();
        all.extend(corners(wanted, triangles.iter().map(|t| t.map(at))));
    }
    Ok(all)
}

/// Of this crate the step that gives positions and polygons; only triangles compare.
fn obj_rs(path: &Path, wanted: bool) -> Result<Corners, String> {
    use obj::raw::object::Polygon::{P, PN, PT, PTN};
    let raw = black_box(obj::raw::parse_obj(open(path)?).map_err(said)?);
    let at = |v: usize| {
        let (x, y, z, _) = raw.positions[v];
        [x, y, z]
    };
    let first = |polygon: &obj::raw::object::Polygon| match polygon {
        P(v) => [at(v[0]), at(v[1]), at(v[2])],
        PT(v) | PN(v) => [at(v[0].0), at(v[1].0), at(v[2].0)],
        PTN(v) => [at(v[0].0), at(v[1].0), at(v[2].0)],
    };
    Ok(corners(wanted, raw.polygons.iter().map(first)))
}

fn mesh_loader(path: &Path, wanted: bool) -> Result<Corners, String> {
    let scene = black_box(mesh_loader::Loader::default().load_obj(path).map_err(said)?);
    let mut all = Corners::new();
    for mesh in &scene.meshes {
        let at = |v: u32| mesh.vertices[v as usize];
        all.extend(corners(wanted, mesh.faces.iter().map(|t| t.map(at))));
    }
    Ok(all)
}

fn wobj(path: &Path, wanted: bool) -> Result<Corners, String> {
    let bytes = fs::read(path).map_err(said)?;
    let file = wobj::Obj::parse(&bytes).map_err(said)?;
    let mut all = Corners::new();
    for mesh in &file.meshes() {
        let (indices, vertices) = black_box(mesh.triangulate().map_err(said)?);
        let (triangles, _) = indices.0.as_chunks::<3>();
        all.extend(corners(wanted, triangles.iter().map(|t| t.map(|v| vertices.positions[v]))));
    }
    Ok(all)
}

/// This crate keeps f64, which may round to another f32 than the text does, and is then left out.
#[expect(clippy::cast_possible_truncation, reason = "meshes are f32")]
fn wavefront_obj(path: &Path, wanted: bool) -> Result<Corners, String> {
    use wavefront_obj::obj::Primitive::Triangle;
    let text = fs::read_to_string(path).map_err(said)?;
    let set = black_box(wavefront_obj::obj::parse(text).map_err(said)?);
    let mut all = Corners::new();
    for object in &set.objects {
        let at = |v: usize| {
            let p = object.vertices[v];
            [p.x as f32, p.y as f32, p.z as f32]
        };
        let shapes = object.geometry.iter().flat_map(|geometry| &geometry.shapes);
        let triangles = shapes.filter_map(|shape| match shape.primitive {
            Triangle(a, b, c) => Some([at(a.0), at(b.0), at(c.0)]),
            _ => None,
        });
        all.extend(corners(wanted, triangles));
    }
    Ok(all)
}

#[derive(Deserialize)]
struct PlyMesh {
    vertex: Vec<PlyVertex>,
    face: Vec<PlyFace>,
}

#[derive(Deserialize)]
struct PlyVertex {
    x: f32,
    y: f32,
    z: f32,
}

#[derive(Deserialize)]
struct PlyFace {
    #[serde(alias = "vertex_indices")]
    vertex_index: Vec<u32>,
}

fn serde_ply(path: &Path, wanted: bool) -> Result<Corners, String> {
    let bytes = fs::read(path).map_err(said)?;
    let mesh: PlyMesh = black_box(serde_ply::from_bytes(&bytes).map_err(said)?);
    let at = |v: u32| {
        let vertex = &mesh.vertex[v as usize];
        [vertex.x, vertex.y, vertex.z]
    };
    let triangle = |face: &PlyFace| [0, 1, 2].map(|i| at(face.vertex_index[i]));
    Ok(corners(wanted, mesh.face.iter().map(triangle)))
}

struct Vertex([f32; 3]);
struct Face(Vec<i32>);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self([0.0; 3])
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let axis = ["x", "y", "z"].iter().position(|&axis| axis == name);
        if let (Some(axis), Property::Float(value)) = (axis, property) {
            self.0[axis] = value;
        }
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, _: &str, property: Property) -> PropertyAccessResult {
        if let Property::ListInt(corners) = property {
            self.0 = corners;
        }
        PropertyAccessResult::Set
    }
}

fn ply_rs_bw(path: &Path, wanted: bool) -> Result<Corners, String> {
    let mut file = PlyReader::new(open(path)?);
    let (of_vertices, of_faces) = (Parser::<Vertex>::new(), Parser::<Face>::new());
    let header = of_vertices.read_header(&mut file).map_err(said)?;
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for (_, element) in &header.elements {
        if element.name == "vertex" {
            let read = of_vertices.read_payload_for_element(&mut file, element, &header);
            vertices = read.map_err(said)?;
        } else {
            let read = of_faces.read_payload_for_element(&mut file, element, &header);
            faces = read.map_err(said)?;
        }
    }
    let (vertices, faces) = black_box((vertices, faces));
    let at = |v: i32| usize::try_from(v).map_or([f32::NAN; 3], |v| vertices[v].0);
    Ok(corners(wanted, faces.iter().map(|face: &Face| [0, 1, 2].map(|i| at(face.0[i])))))
}
