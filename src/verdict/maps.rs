//! Verdicts pixel by pixel.

use crate::scene::Scene;
use crate::shadow::facing::{Sides, faces};
use crate::visibility::{SurfacePoint, VisibleSurfaces};

/// The shadow queries of one light: visible points that face it.
#[derive(Debug, Clone)]
pub struct Queries {
    /// The points.
    pub points: Vec<SurfacePoint>,
    /// The pixel of each point.
    pub pixels: Vec<u32>,
    /// Pixels whose surface faces away from the light.
    pub facing_away: Vec<u32>,
}

impl Queries {
    /// Splits the visible points by facing; `eye` are the sides of the camera.
    pub fn new(scene: &Scene, visible: &VisibleSurfaces, light: glam::Vec3, eye: &Sides) -> Queries {
        let sides = Sides::of(scene, light);
        let mut queries = Queries { points: Vec::new(), pixels: Vec::new(), facing_away: Vec::new() };
        for (point, &pixel) in visible.points.iter().zip(&visible.pixels) {
            if faces(point, &sides, eye) {
                queries.points.push(*point);
                queries.pixels.push(pixel);
            } else {
                queries.facing_away.push(pixel);
            }
        }
        queries
    }
}

/// What the channel `shadow.<light>.verdict` says of a pixel. The discriminants are its codes; 10 is added
/// where the query is touching.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum PixelVerdict {
    /// The pixel sees no surface.
    Background = 0,
    /// The surface faces away from the light: dark without a query.
    FacingAway = 1,
    /// Lit, and everyone says so.
    Lit = 2,
    /// Occluded, and everyone says so.
    Occluded = 3,
    /// The native tester is wrong, Embree is right.
    NativeWrong = 4,
    /// Embree is wrong, the native tester is right.
    EmbreeWrong = 5,
    /// Both are wrong.
    BothWrong = 6,
}

impl PixelVerdict {
    /// The verdict on one query.
    pub fn new(native: bool, embree: Option<bool>, truth: bool) -> PixelVerdict {
        let embree_wrong = embree.is_some_and(|e| e != truth);
        match (native != truth, embree_wrong) {
            (true, true) => PixelVerdict::BothWrong,
            (true, false) => PixelVerdict::NativeWrong,
            (false, true) => PixelVerdict::EmbreeWrong,
            (false, false) if truth => PixelVerdict::Occluded,
            (false, false) => PixelVerdict::Lit,
        }
    }

    /// The channel's code.
    pub fn code(self) -> u8 {
        self as u8
    }
}
