//! What is the same whatever the GPU is spoken to by: what it is given, and what becomes of what it gives.

use std::fmt::Display;

use drypoint_cpu::Statistics;
use drypoint_fusion::PatchSet;
use drypoint_lines::{Camera, Color, Style, filter_for_drawing};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint};
use drypoint_shaders::{self as shaders, Content, LineStyle, Method, Placement, Segment, View};
use glam::{DAffine3, DMat4, DVec3};

#[cfg(feature = "ash")]
use super::ash;
#[cfg(feature = "wgpu")]
use super::wgpu;
use crate::draw::Scene;
use crate::gpu::Api;
use crate::output::tell;
#[cfg(feature = "wgpu")]
use crate::rigged::Posed;

/// Segments that there is room for at first. If there are more, they are found a second time.
const FIRST_CAPACITY: u32 = 1 << 16;

/// The nearest plane that is seen, if the model comes nearer: a fraction of the distance to the farthest.
const NEAREST: f64 = 1e-5;

/// What is drawn, as a GPU takes it.
pub(super) struct Frame<'a> {
    pub(super) mesh: &'a Mesh,
    adjacency: &'a MeshAdjacency,
    /// Of those edges that a drawing needs.
    patches: Option<&'a PatchSet>,
    filter: EdgeFilter,
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
    pub(super) placement: Placement,
    pub(super) view: View,
}

impl Frame<'_> {
    /// What is uploaded.
    pub(super) fn content(&self) -> Content {
        match self.patches {
            Some(patches) => Content::new(&[patches]),
            None => Content::without_patches(self.mesh, self.adjacency, self.filter),
        }
    }

    pub(super) fn method(&self) -> Method {
        if self.patches.is_some() { Method::Patches } else { Method::BruteForce }
    }
}

/// Finds the contour edges of `patches` by their ids.
pub(crate) fn extract(
    api: Api,
    patches: &PatchSet,
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) -> Result<Statistics, String> {
    let placement = Placement::at_origin(viewpoint);
    let (segments, counted): (Vec<Segment>, _) = match api {
        #[cfg(feature = "wgpu")]
        Api::Wgpu => wgpu::extract(patches, &placement).map_err(plain)?,
        #[cfg(feature = "ash")]
        Api::Ash => ash::extract(patches, &placement).map_err(plain)?,
        #[cfg(not(all(feature = "ash", feature = "wgpu")))]
        _ => return Err(api.refusal()),
    };
    contours.clear();
    contours.extend(segments.iter().map(|segment| segment.edge));
    Ok(statistics(counted))
}

/// Finds the contour edges of a model that moves by their ids in its rig, through patches of its shapes.
#[cfg(feature = "wgpu")]
pub(crate) fn extract_rig(
    api: Api,
    posed: &Posed<'_>,
    patches: &[PatchSet],
    viewpoint: Viewpoint,
    contours: &mut Vec<EdgeId>,
) -> Result<Statistics, String> {
    api.check_rig()?;
    let placement = Placement::at_origin(viewpoint);
    let (edges, counted) = wgpu::extract_rig(posed, patches, placement).map_err(plain)?;
    *contours = edges;
    Ok(statistics(counted))
}

fn statistics(counted: shaders::Statistics) -> Statistics {
    // No more than there are edges.
    let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
    Statistics {
        super_patches_tested: count(counted.super_patches_tested),
        super_patches_accepted: count(counted.super_patches_accepted),
        patches_tested: count(counted.patches_tested),
        patches_accepted: count(counted.patches_accepted),
        edges_tested: count(counted.edges_tested),
        contour_edges: count(counted.segments),
    }
}

/// What `find` finds with room for so many segments: with more if not all fit.
pub(super) fn with_room<T, E>(
    mut find: impl FnMut(u32) -> Result<(T, shaders::Statistics), E>,
) -> Result<(T, shaders::Statistics), E> {
    let mut segments = FIRST_CAPACITY;
    loop {
        let (found, statistics) = find(segments)?;
        match statistics.overflow() {
            None => return Ok((found, statistics)),
            Some(needed) => segments = u32::try_from(needed).unwrap_or(u32::MAX),
        }
    }
}

/// A PNG of the visible contours. From `patches`, if they are of the edges that a drawing needs.
pub(crate) fn draw(
    api: Api,
    scene: &Scene<'_>,
    patches: Option<&PatchSet>,
    style: &Style,
) -> Result<Vec<u8>, String> {
    let frame = frame(scene, patches, style);
    let pixels = match api {
        #[cfg(feature = "wgpu")]
        Api::Wgpu => wgpu::draw(&frame).map_err(plain)?,
        #[cfg(feature = "ash")]
        Api::Ash => ash::draw(&frame).map_err(plain)?,
        #[cfg(not(all(feature = "ash", feature = "wgpu")))]
        _ => return Err(api.refusal()),
    };
    let (pixel, rest) = pixels.split_at(4);
    if rest.chunks_exact(4).all(|other| other == pixel) {
        tell(&format!("drypoint: no line of {} is visible on the page", scene.source.name));
    }
    encode(&pixels, frame.size).map_err(plain)
}

fn frame<'a>(scene: &Scene<'a>, patches: Option<&'a PatchSet>, style: &Style) -> Frame<'a> {
    let Scene { source, adjacency, camera } = *scene;
    let mesh = source.mesh();
    let filter = filter_for_drawing(mesh, adjacency, camera.viewpoint());
    let (placement, scene_to_clip) = place(mesh, camera);
    #[expect(clippy::cast_possible_truncation, reason = "rounds")]
    let width = style.width as f32;
    let page = camera.page();
    Frame {
        mesh,
        adjacency,
        patches: patches.filter(|patches| patches.edge_filter() == filter),
        filter,
        size: [page.width, page.height],
        placement,
        view: View {
            scene_to_clip: scene_to_clip.as_mat4(),
            background: shares(style.background.unwrap_or(Color::WHITE)),
            lines: LineStyle { width, color: shares(style.color) },
        },
    }
}

/// The mesh around the origin and about as large as 1, where f32 is exact, and the matrix from there to
/// clip space.
fn place(mesh: &Mesh, camera: &Camera) -> (Placement, DMat4) {
    let bounds = mesh.bounds();
    // Vertices are f32, and so is this: what is subtracted from them loses nothing.
    let center = bounds.map_or(DVec3::ZERO, |bounds| bounds.center().as_vec3().as_dvec3());
    let size = bounds.map_or(1.0, |bounds| (bounds.max - bounds.min).as_dvec3().max_element());
    let scale = if size > 0.0 { size.log2().round().clamp(-126.0, 126.0).exp2() } else { 1.0 };
    let to_scene =
        DAffine3::from_scale(DVec3::splat(1.0 / scale)) * DAffine3::from_translation(-center);
    let clip = camera.clip_matrix(depths(mesh, camera)) * DMat4::from(to_scene.inverse());
    let viewpoint = camera.viewpoint();
    if viewpoint.is_point() {
        let viewpoint = Viewpoint::at(to_scene.transform_point3(viewpoint.xyz()));
        // Clip space is homogeneous: distances of the scene rather than the model.
        (Placement { to_scene, viewpoint }, clip * (1.0 / scale))
    } else {
        (Placement { to_scene, viewpoint }, clip)
    }
}

/// The farthest and the nearest depth that are drawn.
fn depths(mesh: &Mesh, camera: &Camera) -> [f64; 2] {
    let depths = mesh.positions().iter().map(|position| camera.depth(position.as_dvec3()));
    let [near, far] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[near, far], depth| {
        [near.min(depth), far.max(depth)]
    });
    if !camera.viewpoint().is_point() {
        let margin = 0.01 * (far - near) + f64::MIN_POSITIVE.max(1e-9 * far.abs());
        return [far + margin, near - margin];
    }
    // If all is behind the eye nothing is seen, whatever they are.
    let far = if far > 0.0 { 1.01 * far } else { 1.0 };
    [far, (0.99 * near).max(NEAREST * far)]
}

fn shares(Color { red, green, blue, alpha }: Color) -> [f32; 4] {
    [red, green, blue, alpha].map(|share| f32::from(share) / 255.0)
}

fn encode(pixels: &[u8], [width, height]: [u32; 2]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(bytes)
}

fn plain(error: impl Display) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests {
    use super::{FIRST_CAPACITY, shaders, with_room};

    #[track_caller]
    fn check(there: u64, expected: &[u32]) {
        let mut tried = Vec::new();
        let found = with_room(|capacity| -> Result<_, ()> {
            tried.push(capacity);
            let statistics =
                shaders::Statistics { segments: there, capacity, ..Default::default() };
            Ok((capacity, statistics))
        });
        assert_eq!(tried, expected);
        assert_eq!(found.map(|(capacity, _)| capacity), Ok(expected[expected.len() - 1]));
    }

    #[test]
    fn what_does_not_fit_is_found_again_with_more_room() {
        check(0, &[FIRST_CAPACITY]);
        check(FIRST_CAPACITY.into(), &[FIRST_CAPACITY]);
        check(u64::from(FIRST_CAPACITY) + 1, &[FIRST_CAPACITY, FIRST_CAPACITY + 1]);
    }
}
