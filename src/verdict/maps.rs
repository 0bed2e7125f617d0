//! Verdicts pixel by pixel.

use crate::scene::{Light, Scene};
use crate::shadow::facing::{Facing, Sides};
use crate::visibility::{SurfacePoint, VisibleSurfaces};
use rayon::prelude::*;

/// The shadow queries of one light: visible points that face it or that it shines through, inside its cone if
/// it has one, on objects that receive shadows.
#[derive(Debug, Clone, Default)]
pub struct Queries {
    /// The points.
    pub points: Vec<SurfacePoint>,
    /// The pixel of each point.
    pub pixels: Vec<u32>,
    /// Those of the points, by their places in the list and in ascending order, that are on a transparent
    /// surface which the light reaches from behind: it passes through that surface too.
    pub from_behind: Vec<u32>,
    /// Pixels whose surface faces away from the light: dark without a query.
    pub facing_away: Vec<u32>,
    /// Pixels whose surface faces it and is outside its cone: dark without a query.
    pub outside_cone: Vec<u32>,
    /// Pixels of objects that receive no shadows and would otherwise be queries: lit without one.
    pub not_receiving: Vec<u32>,
}

impl Queries {
    /// Splits the visible points.
    pub fn new(scene: &Scene, visible: &VisibleSurfaces, light: &Light) -> Queries {
        let sides = Sides::of(scene, light.position());
        let cone = light.lit_cone();
        let is_lit =
            |point: &SurfacePoint| cone.is_none_or(|cone| cone.holds(point.position, || point.exact(scene)));
        let receives =
            |point: &SurfacePoint| point.primitive().is_none_or(|p| scene.object(p).shadowing.receives);
        let facing: Vec<Facing> = visible.points.par_iter().map(|p| sides.facing(scene, p)).collect();
        let lets_light_through =
            |point: &SurfacePoint| point.primitive().is_some_and(|p| scene.is_transparent(p));
        let mut queries = Queries::default();
        for ((point, &pixel), &facing) in visible.points.iter().zip(&visible.pixels).zip(&facing) {
            let from_behind = facing == Facing::Away && lets_light_through(point);
            if facing != Facing::Towards && !from_behind {
                queries.facing_away.push(pixel);
            } else if !is_lit(point) {
                queries.outside_cone.push(pixel);
            } else if !receives(point) {
                queries.not_receiving.push(pixel);
            } else {
                if from_behind {
                    queries.from_behind.push(queries.points.len() as u32);
                }
                queries.points.push(*point);
                queries.pixels.push(pixel);
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
    /// Outside the cone of a spot light: dark without a query.
    OutsideCone = 7,
    /// On an object that receives no shadows: lit without a query.
    NotReceiving = 8,
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
