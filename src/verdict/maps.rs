//! Verdicts pixel by pixel.

/// What the channel `shadow.<light>.verdict` says of a pixel. The discriminants are its codes; 10 is added
/// where the query is touching, and [`Cause::code`](super::Cause::code) where it is known why Embree is wrong.
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
