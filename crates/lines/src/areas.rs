//! What of the faces is visible, as tinted areas.
//!
//! A face is three *thirds*, each between a side and the centroid, so that a tint can belong to an
//! edge: the thirds on its two sides are its share of the surface. A third is cut into smaller and
//! smaller pieces until each is either visible or hidden, and the visible pieces of one tint are
//! dissolved into outlines. Areas so never lie upon each other, and can be inked in any order.

use drypoint_mesh::MeshAdjacency;
use glam::{DVec2, DVec3};

use crate::occluders::{Occluders, Sightlines};
use crate::rings::dissolve;
use crate::{Area, Camera, Tint};

/// Longest side in pixels of a piece that four lines of sight decide on: what is narrower and hides
/// a part of a face can be missed.
const COARSE: f64 = 6.0;

/// Longest side in pixels of a piece that is not cut any more. Outlines of what hides something are
/// as ragged as this, under a stroke that is wider.
const FINE: f64 = 1.0;

/// How often a piece is halved at most. Only one that reaches behind the eye, and has no size on the
/// page, comes that far.
const DEPTH: u32 = 16;

/// The visible areas of `tints`, in their order; those of which nothing is visible are left out.
///
/// `thirds` has three indices into `tints` for each triangle: of the third at the side from corner 0
/// to 1, from 1 to 2, and from 2 to 0. Faces are seen from both sides; those without area are not.
///
/// One line of sight for faces below a pixel, four for those of a few pixels and about one for every
/// four pixels of larger ones, of two or three microseconds each.
///
/// # Panics
/// If an index is out of range.
pub fn tinted_areas(
    occluders: &Occluders<'_>,
    adjacency: &MeshAdjacency,
    camera: &Camera,
    tints: &[Tint],
    thirds: &[[usize; 3]],
) -> Vec<Area> {
    let mesh = occluders.mesh();
    let sightlines = occluders.sightlines(camera.viewpoint());
    let mut cutter = Cutter { sightlines, camera };
    let mut pieces: Vec<Vec<[DVec2; 3]>> = vec![Vec::new(); tints.len()];
    for (face, tints) in (0u32..).zip(thirds) {
        if !adjacency.is_without_area(face) {
            let corners = mesh.corners(face).map(|p| p.as_dvec3());
            cutter.cut_face(corners, tints, &mut pieces);
        }
    }
    let areas = tints.iter().zip(&pieces);
    let areas = areas.map(|(tint, pieces)| Area { tint: tint.clone(), rings: dissolve(pieces) });
    areas.filter(|area| !area.rings.is_empty()).collect()
}

/// What of a piece is visible.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Seen {
    All,
    None,
    /// It has to be cut.
    Some,
}

struct Cutter<'a> {
    sightlines: Sightlines<'a>,
    camera: &'a Camera,
}

impl Cutter<'_> {
    /// Adds the visible pieces of a face to those of each tint.
    fn cut_face(
        &mut self,
        corners: [DVec3; 3],
        tints: &[usize; 3],
        pieces: &mut [Vec<[DVec2; 3]>],
    ) {
        let [a, b, c] = corners;
        if tints[0] == tints[1] && tints[1] == tints[2] {
            self.cut(corners, 0, &mut pieces[tints[0]]);
            return;
        }
        // On a dense mesh faces are small, and this saves asking three times.
        let seen = match self.projected(corners) {
            Some(page) => self.seen(corners, page),
            None => Seen::Some,
        };
        let centroid = (a + b + c) / 3.0;
        for (third, tint) in
            [[a, b, centroid], [b, c, centroid], [c, a, centroid]].iter().zip(tints)
        {
            match seen {
                Seen::All => pieces[*tint].extend(self.projected(*third)),
                Seen::None => {}
                Seen::Some => {
                    self.cut(*third, 0, &mut pieces[*tint]);
                }
            }
        }
    }

    /// Adds the visible pieces of a piece, itself if it is visible as a whole; whether it is.
    fn cut(&mut self, corners: [DVec3; 3], depth: u32, pieces: &mut Vec<[DVec2; 3]>) -> bool {
        let page = self.projected(corners);
        match page.map(|page| self.seen(corners, page)) {
            Some(Seen::All) => {
                pieces.extend(page);
                return true;
            }
            Some(Seen::None) => return false,
            // Reaches behind the eye.
            None if corners.iter().all(|&p| self.camera.project(p).is_none()) => return false,
            _ if depth == DEPTH => return false,
            _ => {}
        }
        let before = pieces.len();
        let [a, b, c] = corners;
        let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
        let mut is_whole = true;
        for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            is_whole &= self.cut(part, depth + 1, pieces);
        }
        if let Some(page) = page.filter(|_| is_whole) {
            pieces.truncate(before);
            pieces.push(page);
        }
        is_whole
    }

    /// Where a piece lands on the page; nowhere if a corner is not in front of the eye.
    fn projected(&self, corners: [DVec3; 3]) -> Option<[DVec2; 3]> {
        let [a, b, c] = corners.map(|p| self.camera.project(p));
        Some([a?, b?, c?])
    }

    fn seen(&mut self, corners: [DVec3; 3], page: [DVec2; 3]) -> Seen {
        if self.is_off_page(page) {
            return Seen::None;
        }
        let [a, b, c] = page;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        if longest > COARSE {
            return Seen::Some;
        }
        let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
        let is_seen = !self.sightlines.is_face_hidden(centroid);
        let mut is_else = |corner: DVec3| {
            // Near the corner, where other faces meet, who hides what is a matter of rounding.
            is_seen == self.sightlines.is_face_hidden(corner.lerp(centroid, 0.25))
        };
        if longest > FINE && corners.iter().any(|&corner| is_else(corner)) {
            Seen::Some
        } else if is_seen {
            Seen::All
        } else {
            Seen::None
        }
    }

    fn is_off_page(&self, page: [DVec2; 3]) -> bool {
        let [width, height] = self.camera.page().sides();
        let min = page[0].min(page[1]).min(page[2]);
        let max = page[0].max(page[1]).max(page[2]);
        max.x < 0.0 || max.y < 0.0 || min.x > width || min.y > height
    }
}
