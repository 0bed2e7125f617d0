//! Colours that people with any colour vision tell apart.
//!
//! The eight of Okabe and Ito, "Color Universal Design" (2008), and neutral greys for what is as it should
//! be. Convention of our maps: greys for agreement, orange and blue tones for disagreement, so that the eye
//! goes where the errors are.

/// Okabe and Ito's black.
pub const BLACK: [u8; 3] = [0, 0, 0];
/// Okabe and Ito's orange.
pub const ORANGE: [u8; 3] = [230, 159, 0];
/// Okabe and Ito's sky blue.
pub const SKY_BLUE: [u8; 3] = [86, 180, 233];
/// Okabe and Ito's bluish green.
pub const BLUISH_GREEN: [u8; 3] = [0, 158, 115];
/// Okabe and Ito's yellow.
pub const YELLOW: [u8; 3] = [240, 228, 66];
/// Okabe and Ito's blue.
pub const BLUE: [u8; 3] = [0, 114, 178];
/// Okabe and Ito's vermillion.
pub const VERMILLION: [u8; 3] = [213, 94, 0];
/// Okabe and Ito's reddish purple.
pub const REDDISH_PURPLE: [u8; 3] = [204, 121, 167];

/// Where there is no surface.
pub const BACKGROUND: [u8; 3] = [24, 24, 28];
/// Turned away from the light.
pub const FACING_AWAY: [u8; 3] = [58, 58, 64];
/// In cast shadow.
pub const SHADOWED: [u8; 3] = [104, 104, 112];
/// Lit.
pub const LIT: [u8; 3] = [208, 208, 212];
/// Outside the cone of a spot light.
pub const OUTSIDE_CONE: [u8; 3] = [40, 40, 46];
/// Lit because it receives no shadows.
pub const NOT_RECEIVING: [u8; 3] = [236, 236, 240];
