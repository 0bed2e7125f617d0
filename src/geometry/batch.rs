//! Sixteen points against one triangle after another: the filter of [`LightTriangle`] in SIMD.
//!
//! The same operations in the same order as the scalar filter, written so that the compiler can use the
//! widest registers it is allowed to; nothing is fused, so every instruction set gives the same bits.

use super::light_triangle::{Filtered, LightPoint, LightTriangle};

/// Points of one batch.
pub const LANES: usize = 16;

/// Up to sixteen points relative to one light, coordinate by coordinate.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct PointBatch {
    x: [f32; LANES],
    y: [f32; LANES],
    z: [f32; LANES],
    slack: [f32; LANES],
}

/// Where a scan of triangles stopped: the first one that some live lane is not clear of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stop {
    /// Index of the triangle.
    pub index: usize,
    /// Live lanes that it certainly blocks, one bit each.
    pub blocked: u16,
    /// Live lanes that the filter leaves undecided.
    pub undecided: u16,
}

/// An instruction set that the kernels are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InstructionSet {
    /// What the target always has.
    Portable,
    /// AVX2.
    Avx2,
    /// AVX-512 F, VL, BW and DQ.
    Avx512,
}

impl InstructionSet {
    /// All that there are, the widest last.
    pub const ALL: [InstructionSet; 3] =
        [InstructionSet::Portable, InstructionSet::Avx2, InstructionSet::Avx512];

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            InstructionSet::Portable => true,
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            InstructionSet::Portable => "portable",
            InstructionSet::Avx2 => "avx2",
            InstructionSet::Avx512 => "avx512",
        }
    }

    /// The widest that this machine has.
    pub fn best() -> InstructionSet {
        *InstructionSet::ALL.iter().rev().find(|set| set.is_available()).expect("portable is there")
    }
}

impl PointBatch {
    /// The first sixteen of some points; lanes without a point repeat the first and must not be live.
    pub fn new(points: &[LightPoint]) -> PointBatch {
        let lane = |i: usize| points.get(i).unwrap_or(&points[0]);
        PointBatch {
            x: std::array::from_fn(|i| lane(i).x),
            y: std::array::from_fn(|i| lane(i).y),
            z: std::array::from_fn(|i| lane(i).z),
            slack: std::array::from_fn(|i| lane(i).slack),
        }
    }

    /// The first triangle at or after `start` that one of the live lanes is not clear of.
    pub fn scan(
        &self,
        instruction_set: InstructionSet,
        triangles: &[LightTriangle],
        start: usize,
        live: u16,
    ) -> Option<Stop> {
        assert!(instruction_set.is_available(), "{instruction_set:?} on a machine without it");
        match instruction_set {
            InstructionSet::Portable => scan(self, triangles, start, live),
            // SAFETY: the machine has the instructions, as asserted above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { scan_avx2(self, triangles, start, live) },
            // SAFETY: the machine has the instructions, as asserted above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { scan_avx512(self, triangles, start, live) },
            #[cfg(not(target_arch = "x86_64"))]
            _ => scan(self, triangles, start, live),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn scan_avx2(batch: &PointBatch, triangles: &[LightTriangle], start: usize, live: u16) -> Option<Stop> {
    scan(batch, triangles, start, live)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512bw,avx512dq")]
fn scan_avx512(batch: &PointBatch, triangles: &[LightTriangle], start: usize, live: u16) -> Option<Stop> {
    scan(batch, triangles, start, live)
}

#[inline(always)]
fn scan(batch: &PointBatch, triangles: &[LightTriangle], start: usize, live: u16) -> Option<Stop> {
    // Lanes that are not live are clear of everything: no value is at or above infinity.
    let mut limit = [f32::INFINITY; LANES];
    for i in (0..LANES).filter(|i| live >> i & 1 == 1) {
        limit[i] = -batch.slack[i];
    }
    for (index, t) in triangles.iter().enumerate().skip(start) {
        if touches(batch, &limit, t) {
            let stop = settle(batch, t, index, live);
            if stop.blocked != 0 || stop.undecided != 0 {
                return Some(stop);
            }
        }
    }
    None
}

/// Whether some lane has no plane that certainly clears the triangle. A plane that is NaN clears nothing:
/// the selection drops it or, in the last place, leaves the lane touched.
#[inline(always)]
fn touches(batch: &PointBatch, limit: &[f32; LANES], t: &LightTriangle) -> bool {
    let plane = |k: usize, i: usize| {
        ((t.x[k] * batch.x[i] + t.y[k] * batch.y[i]) + t.z[k] * batch.z[i]) - t.offset[k]
    };
    let smaller = |a: f32, b: f32| if a < b { a } else { b };
    let mut touched = false;
    for (i, limit) in limit.iter().enumerate() {
        let least = smaller(smaller(plane(0, i), plane(1, i)), smaller(plane(2, i), plane(3, i)));
        let clear = least < *limit;
        touched |= !clear;
    }
    touched
}

/// The careful filter, lane by lane.
#[cold]
fn settle(batch: &PointBatch, t: &LightTriangle, index: usize, live: u16) -> Stop {
    let mut stop = Stop { index, blocked: 0, undecided: 0 };
    for i in (0..LANES).filter(|i| live >> i & 1 == 1) {
        let point = LightPoint { x: batch.x[i], y: batch.y[i], z: batch.z[i], slack: batch.slack[i] };
        match t.classify(&point) {
            Filtered::Blocks => stop.blocked |= 1 << i,
            Filtered::Undecided => stop.undecided |= 1 << i,
            Filtered::Clear => {}
        }
    }
    stop
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_instruction_set_agrees_with_the_scalar_filter(
            corners in prop::collection::vec(prop::array::uniform9(-2i8..3), 1..20),
            points in prop::collection::vec(prop::array::uniform3(-3i8..4), 1..17),
            live in any::<u16>(),
        ) {
            let light = Vec3::new(0.25, 0.5, 3.0).into();
            let triangles: Vec<LightTriangle> = corners
                .iter()
                .map(|c| c.map(f32::from))
                .filter_map(|c| {
                    let corner = |i: usize| Vec3::new(c[i], c[i + 1], c[i + 2]);
                    LightTriangle::new(&light, [corner(0), corner(3), corner(6)])
                })
                .collect();
            let points: Vec<LightPoint> = points
                .iter()
                .map(|p| LightPoint::new(&light, Vec3::from(p.map(f32::from)).as_dvec3()))
                .collect();
            let live = live & (u32::MAX >> (32 - points.len())) as u16;
            let expected: Vec<Stop> = triangles
                .iter()
                .enumerate()
                .map(|(index, t)| {
                    let lanes = |wanted: Filtered| {
                        points.iter().enumerate().fold(0, |m, (i, p)| m | u16::from(t.classify(p) == wanted) << i) & live
                    };
                    Stop { index, blocked: lanes(Filtered::Blocks), undecided: lanes(Filtered::Undecided) }
                })
                .filter(|stop| stop.blocked | stop.undecided != 0)
                .collect();
            let batch = PointBatch::new(&points);
            // All lanes are live: those without a point repeat the first.
            let limit = batch.slack.map(|slack| -slack);
            for t in &triangles {
                let expected = points.iter().any(|p| t.classify(p) != Filtered::Clear);
                prop_assert_eq!(touches(&batch, &limit, t), expected);
            }
            for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                let mut found = Vec::new();
                let mut start = 0;
                while let Some(stop) = batch.scan(set, &triangles, start, live) {
                    found.push(stop);
                    start = stop.index + 1;
                }
                prop_assert_eq!(&found, &expected);
            }
        }
    }

    #[test]
    fn a_value_at_the_very_bound_is_not_clear() {
        let t = LightTriangle { x: [1.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [0.0; 4] };
        let at = |x: f32| PointBatch::new(&[LightPoint { x, y: 0.0, z: 0.0, slack: 0.25 }]);
        let touched = |x: f32| touches(&at(x), &[-0.25; LANES], &t);
        assert_eq!([(-0.25_f32).next_down(), -0.25, 0.25].map(touched), [false, true, true]);
    }
}
