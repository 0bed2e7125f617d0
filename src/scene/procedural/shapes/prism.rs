//! Outlines pulled straight up.

use super::loft::{Closing, loft};
use super::mesh::Mesh;
use glam::DVec3;

/// An outline in (x, z'), z' = -z, counter-clockwise from above, between two heights: two polygons more than
/// it has corners.
pub(in crate::scene::procedural) fn prism(outline: &[[f64; 2]], low: f64, high: f64) -> Mesh {
    loft(&[level(outline, low), level(outline, high)], Closing::Capped)
}

/// The same with several levels, each a height and a scale of the outline: three bands for a slab whose upper
/// and lower edges are bevelled.
pub(in crate::scene::procedural) fn bevelled_prism(outline: &[[f64; 2]], levels: &[[f64; 2]]) -> Mesh {
    let at = |&[height, scale]: &[f64; 2]| {
        let outline: Vec<_> = outline.iter().map(|corner| corner.map(|c| c * scale)).collect();
        level(&outline, height)
    };
    loft(&levels.iter().map(at).collect::<Vec<_>>(), Closing::Capped)
}

fn level(outline: &[[f64; 2]], height: f64) -> Vec<DVec3> {
    outline.iter().map(|&[x, depth]| DVec3::new(x, height, -depth)).collect()
}
