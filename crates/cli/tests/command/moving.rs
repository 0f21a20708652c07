//! A model that moves, made by code: a tube that bends, and three crates, one of them mirrored and one
//! that slides.

use std::fmt::Write as _;

use crate::bench::Bench;

/// Rings of the tube, and corners of each.
const RINGS: u16 = 9;
const CORNERS: u16 = 8;

/// Writes `moving.gltf` with its buffer. Its animations are "bend" (1 s), "slide" (2 s) and "grow"
/// (0.5 s); the last changes the weight of a morph target of the tube.
pub(crate) fn write(bench: &Bench) {
    let mut data = Data::default();
    let (positions, indices) = tube();
    let tube = data.floats(&positions.concat(), "VEC3");
    let tube_indices = data.shorts(&indices);
    let joints: Vec<u8> = positions.iter().flat_map(|_| [0, 1, 0, 0]).collect();
    let joints = data.add(&joints, positions.len(), 5121, "VEC4");
    // The lower third follows the first joint alone, the upper third the second.
    let weight = |&[_, y, _]: &[f32; 3]| ((y - 3.0) / 2.0).clamp(0.0, 1.0);
    let weights: Vec<f32> =
        positions.iter().flat_map(|p| [1.0 - weight(p), weight(p), 0.0, 0.0]).collect();
    let weights = data.floats(&weights, "VEC4");
    let bulge = |&[x, y, z]: &[f32; 3]| if y > 6.0 { [x, 0.0, z] } else { [0.0; 3] };
    let bulge = data.floats(&positions.iter().flat_map(bulge).collect::<Vec<_>>(), "VEC3");
    let bind = |y: f32| [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., -y, 0., 1.];
    let bind = data.floats(&[bind(0.0), bind(4.0)].concat(), "MAT4");
    let (positions, indices) = crate_shape();
    let shape = data.floats(&positions.concat(), "VEC3");
    let shape_indices = data.shorts(&indices);

    let half = std::f32::consts::FRAC_1_SQRT_2;
    let times = [data.floats(&[0.0, 1.0], "SCALAR"), data.floats(&[0.0, 2.0], "SCALAR")];
    let short = data.floats(&[0.0, 0.5], "SCALAR");
    let turns = data.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half], "VEC4");
    let moves = data.floats(&[3.0, 1.0, 0.0, 9.0, 1.0, 0.0], "VEC3");
    let sizes = data.floats(&[0.0, 1.0], "SCALAR");
    let animation = |name: &str, [input, output]: [usize; 2], node: usize, path: &str| {
        format!(
            r#"{{"name": "{name}", "samplers": [{{"input": {input}, "output": {output}}}],
            "channels": [{{"sampler": 0, "target": {{"node": {node}, "path": "{path}"}}}}]}}"#
        )
    };
    let animations = [
        animation("bend", [times[0], turns], 2, "rotation"),
        animation("slide", [times[1], moves], 4, "translation"),
        animation("grow", [short, sizes], 0, "weights"),
    ];
    let rest = format!(
        r#""nodes": [{{"name": "tube", "mesh": 0, "skin": 0}},
        {{"children": [2]}}, {{"translation": [0, 4, 0]}},
        {{"name": "left", "mesh": 1, "translation": [-3, 1, 0]}},
        {{"name": "right", "mesh": 1, "translation": [3, 1, 0], "scale": [-1, 1, 1]}},
        {{"name": "back", "mesh": 1, "translation": [0, 1, -4]}}],
        "scenes": [{{"nodes": [0, 1, 3, 4, 5]}}], "scene": 0,
        "skins": [{{"joints": [1, 2], "inverseBindMatrices": {bind}}}],
        "meshes": [{{"primitives": [{{"indices": {tube_indices}, "attributes": {{"POSITION": {tube},
        "JOINTS_0": {joints}, "WEIGHTS_0": {weights}}}, "targets": [{{"POSITION": {bulge}}}]}}]}},
        {{"primitives": [{{"indices": {shape_indices}, "attributes": {{"POSITION": {shape}}}}}]}}],
        "animations": [{}]"#,
        animations.join(", ")
    );
    bench.write("moving.gltf", data.document("moving.bin", &rest));
    bench.write("moving.bin", &data.binary);
}

/// A closed tube of radius 1 from y = 0 to y = 8.
fn tube() -> (Vec<[f32; 3]>, Vec<u16>) {
    let ring = |ring: u16| {
        let angle = |corner: u16| std::f32::consts::TAU * f32::from(corner) / f32::from(CORNERS);
        (0..CORNERS).map(move |c| [angle(c).cos(), f32::from(ring), -angle(c).sin()])
    };
    let mut positions: Vec<[f32; 3]> = (0..RINGS).flat_map(ring).collect();
    let (bottom, top) = (RINGS * CORNERS, RINGS * CORNERS + 1);
    positions.extend([[0.0, 0.0, 0.0], [0.0, f32::from(RINGS - 1), 0.0]]);
    let mut indices = Vec::new();
    for corner in 0..CORNERS {
        let next = (corner + 1) % CORNERS;
        for ring in 0..RINGS - 1 {
            let [a, b] = [corner, next].map(|c| ring * CORNERS + c);
            let [c, d] = [b + CORNERS, a + CORNERS];
            indices.extend([a, b, c, a, c, d]);
        }
        let last = (RINGS - 1) * CORNERS;
        indices.extend([next, corner, bottom, last + corner, last + next, top]);
    }
    (positions, indices)
}

/// A block that is not its own mirror image: a cube with one corner drawn out.
fn crate_shape() -> (Vec<[f32; 3]>, Vec<u16>) {
    let corner = |i: u16| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|x| f32::from(x) - 0.5);
    let mut positions: Vec<[f32; 3]> = (0..8).map(corner).collect();
    positions[7] = [1.25, 0.75, 0.5];
    let sides: [[u16; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = sides.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    (positions, indices)
}

/// The buffer of a document, and what describes it.
#[derive(Default)]
struct Data {
    binary: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Data {
    /// Adds an accessor of so many elements. Returns its index.
    fn add(&mut self, bytes: &[u8], count: usize, component: u32, shape: &str) -> usize {
        let (view, offset, length) = (self.views.len(), self.binary.len(), bytes.len());
        self.views
            .push(format!(r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length}}}"#));
        self.accessors.push(format!(
            r#"{{"bufferView": {view}, "count": {count}, "componentType": {component}, "type": "{shape}"}}"#
        ));
        self.binary.extend(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        view
    }

    fn floats(&mut self, values: &[f32], shape: &str) -> usize {
        let size = match shape {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.add(&bytes, values.len() / size, 5126, shape)
    }

    fn shorts(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.add(&bytes, values.len(), 5123, "SCALAR")
    }

    fn document(&self, uri: &str, rest: &str) -> String {
        let mut text = String::new();
        write!(
            text,
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{uri}", "byteLength": {}}}],
            "bufferViews": [{}], "accessors": [{}], {rest}}}"#,
            self.binary.len(),
            self.views.join(", "),
            self.accessors.join(", ")
        )
        .unwrap();
        text
    }
}
