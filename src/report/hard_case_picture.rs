//! A hard case as a picture: its scene along an axis, its points, and who is wrong at which.

use super::plot::Drawn;
use crate::error::{Error, Result};
use crate::film::palette;
use crate::geometry::LightPosition;
use crate::geometry::curved::hull;
use crate::hard_cases::{HardCase, Situation, SituationVerdict};
use crate::scene::Primitive;
use crate::shadow::Basis;
use glam::{DVec2, DVec3, Vec3};
use plotters::coord::Shift;
use plotters::prelude::*;

const WIDTH: u32 = 720;
const HEIGHT: u32 = 620;
/// Room above for the title and below for the legend, in pixels.
const HEAD: f64 = 56.0;
const FOOT: f64 = 36.0;
const SIDE: f64 = 24.0;

/// What is more than so many times the extent of the points away from their middle is not made room for.
const FAR: f64 = 4.0;

/// More edges than these say nothing in a picture of this size.
const MOST_EDGES: usize = 6000;

/// The situation of a case that Embree's testers are most often wrong in, or its first.
pub fn most_telling(verdicts: &[SituationVerdict]) -> usize {
    let wrong = |i: &usize| verdicts[*i].verdict.testers.iter().map(|t| t.counts.wrong).sum::<u64>();
    // Of those that are equal it takes the last.
    (0..verdicts.len()).rev().max_by_key(wrong).unwrap_or(0)
}

/// The picture as SVG.
///
/// # Errors
/// If it cannot be drawn.
pub fn picture(case: &HardCase, situation: &Situation, verdict: &SituationVerdict) -> Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT)).into_drawing_area();
        draw(&area, case, situation, verdict)
            .map_err(|e| Error::Usage(format!("the picture of a case: {e}")))?;
    }
    Ok(svg)
}

fn draw(
    area: &DrawingArea<SVGBackend, Shift>,
    case: &HardCase,
    situation: &Situation,
    verdict: &SituationVerdict,
) -> Drawn {
    area.fill(&WHITE)?;
    let view = View::of(situation);
    let edge = RGBColor(150, 150, 158).mix(0.7).stroke_width(1);
    for [a, b] in edges(situation).into_iter().take(MOST_EDGES) {
        area.draw(&PathElement::new([view.place(a), view.place(b)], edge))?;
    }
    let light = colour(palette::ORANGE);
    match situation.light {
        LightPosition::At(light_at) => {
            area.draw(&Circle::new(view.place(light_at.as_dvec3()), 7, light.filled()))?;
        }
        LightPosition::Towards(direction) => {
            let towards = view.direction(direction.as_dvec3()) * 40.0;
            let from = DVec2::new(f64::from(WIDTH) - 70.0, HEAD + 50.0);
            let end = from + towards;
            area.draw(&PathElement::new([pixel(from), pixel(end)], light.stroke_width(3)))?;
            area.draw(&Circle::new(pixel(end), 5, light.filled()))?;
        }
    }
    let is_wrong = |i: usize, basis: Basis| {
        let wrong = |t: &crate::verdict::TesterResult| t.run.occluded[i] != verdict.verdict.truth[i];
        verdict.verdict.testers.iter().any(|t| t.run.basis == basis && wrong(t))
    };
    for (i, point) in situation.points.iter().enumerate() {
        let at = view.place(point.position);
        let fill = if verdict.verdict.truth[i] { OCCLUDED } else { LIT };
        area.draw(&Circle::new(at, 3, fill.filled()))?;
        area.draw(&Circle::new(at, 3, RGBColor(90, 90, 90).stroke_width(1)))?;
        if is_wrong(i, Basis::Measured) {
            area.draw(&Circle::new(at, 6, colour(palette::BLUE).stroke_width(2)))?;
        }
        if is_wrong(i, Basis::Exact) {
            area.draw(&Circle::new(at, 9, colour(palette::VERMILLION).stroke_width(3)))?;
        }
    }
    let text = |size: u32| ("sans-serif", size).into_font();
    area.draw(&Text::new(format!("{}  {}", case.number, case.name), (16, 10), text(18)))?;
    let along = ["x", "y", "z"][view.along];
    let situation = format!("{}; seen along {along}", situation.name);
    area.draw(&Text::new(situation, (16, 34), text(14)))?;
    let foot = HEIGHT as i32 - 22;
    let legend = [
        (LIT.filled(), 5, "lit"),
        (OCCLUDED.filled(), 5, "occluded"),
        (colour(palette::BLUE).stroke_width(2), 6, "Embree wrong"),
        (colour(palette::VERMILLION).stroke_width(3), 6, "a native tester wrong"),
        (light.filled(), 6, "light"),
    ];
    for (i, (style, size, name)) in legend.into_iter().enumerate() {
        let left = 24 + [0, 70, 180, 320, 510][i];
        area.draw(&Circle::new((left, foot + 6), size, style))?;
        area.draw(&Text::new(name, (left + 12, foot), text(14)))?;
    }
    area.present()
}

const LIT: RGBColor = RGBColor(240, 228, 66);
const OCCLUDED: RGBColor = RGBColor(60, 60, 66);

fn colour([r, g, b]: [u8; 3]) -> RGBColor {
    RGBColor(r, g, b)
}

fn pixel(p: DVec2) -> (i32, i32) {
    let limit = |x: f64| x.clamp(-1e5, 1e5) as i32;
    (limit(p.x), limit(p.y))
}

/// Edges of triangles, each once for each that has it, and of hulls around curved surfaces.
fn edges(situation: &Situation) -> Vec<[DVec3; 2]> {
    let scene = &situation.scene;
    let of_primitive = |p| match scene.primitive(p) {
        Primitive::Triangle(corners) => vec![corners.map(Vec3::as_dvec3)],
        Primitive::Curved(shape) => hull::outer(shape).unwrap_or_default(),
    };
    let triangles = (0..scene.primitive_count()).flat_map(of_primitive);
    triangles.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect()
}

/// How places become pixels: along one axis.
struct View {
    /// The axis that is looked along.
    along: usize,
    middle: DVec2,
    scale: f64,
}

impl View {
    /// Of all that is asked about and what is near it, along the axis that shows most of it.
    fn of(situation: &Situation) -> View {
        let points: Vec<DVec3> = situation.points.iter().map(|point| point.position).collect();
        let (mut low, mut high) = bounds(&points).unwrap_or((DVec3::ZERO, DVec3::ZERO));
        let corners: Vec<DVec3> = edges(situation).into_iter().flatten().collect();
        if (high - low).max_element() == 0.0 {
            (low, high) = bounds(&corners).unwrap_or((low - 1.0, high + 1.0));
        }
        let (middle, extent) = ((low + high) * 0.5, (high - low).max_element());
        let light = match situation.light {
            LightPosition::At(light) => Some(light.as_dvec3()),
            LightPosition::Towards(_) => None,
        };
        for p in corners.into_iter().chain(light) {
            if (p - middle).abs().max_element() <= FAR * extent {
                (low, high) = (low.min(p), high.max(p));
            }
        }
        let size = high - low;
        let area = |along: &usize| size[(along + 1) % 3] * size[(along + 2) % 3];
        // Down, unless another axis shows more.
        let along = [1, 2, 0].into_iter().rev().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or(1);
        let mut view = View { along, middle: DVec2::ZERO, scale: 1.0 };
        view.middle = view.flat((low + high) * 0.5);
        let flat = (view.flat(high) - view.flat(low)).abs().max(DVec2::splat(1e-300));
        let room = DVec2::new(f64::from(WIDTH) - 2.0 * SIDE, f64::from(HEIGHT) - HEAD - FOOT - 2.0 * SIDE);
        view.scale = (room / flat).min_element().min(1e300);
        view
    }

    /// Right and down: x and z seen from above, x and -y from the front, z and -y from the side.
    fn flat(&self, p: DVec3) -> DVec2 {
        match self.along {
            0 => DVec2::new(p.z, -p.y),
            1 => DVec2::new(p.x, p.z),
            _ => DVec2::new(p.x, -p.y),
        }
    }

    fn place(&self, p: DVec3) -> (i32, i32) {
        let centre = DVec2::new(0.5 * f64::from(WIDTH), HEAD + 0.5 * (f64::from(HEIGHT) - HEAD - FOOT));
        pixel(centre + (self.flat(p) - self.middle) * self.scale)
    }

    fn direction(&self, d: DVec3) -> DVec2 {
        self.flat(d.normalize_or_zero())
    }
}

fn bounds(points: &[DVec3]) -> Option<(DVec3, DVec3)> {
    points.iter().map(|&p| (p, p)).reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hard_cases::{self, judge_situations};
    use crate::shadow::{BuildInput, testers};

    struct Silent;

    impl crate::verdict::Progress for Silent {
        fn stage(&self, _: &str) {}
        fn advance(&self, _: u64) {}
    }

    #[test]
    fn every_point_is_in_its_picture() {
        let truth: Vec<_> = testers().filter(|entry| entry.basis == Basis::Truth).collect();
        for case in [10, 27, 36, 42].map(|number| hard_cases::find(number).unwrap()) {
            let situations = case.situations();
            let inputs: &hard_cases::Inputs = &|scene, index, light| BuildInput::new(scene, index, light);
            let verdicts = judge_situations(&situations, &truth, inputs, &Silent).unwrap();
            let one = most_telling(&verdicts);
            assert_eq!(one, 0, "nobody is wrong anywhere");
            let svg = picture(case, &situations[one], &verdicts[one]).unwrap();
            // Up to what SVG writes in another way.
            assert!(svg.contains(case.name.split('\'').next().unwrap()), "{svg}");
            let view = View::of(&situations[one]);
            for point in &situations[one].points {
                let (x, y) = view.place(point.position);
                assert!((0..WIDTH as i32).contains(&x) && (0..HEIGHT as i32).contains(&y), "{x}, {y}");
                assert!(svg.contains(&format!("cx=\"{x}\" cy=\"{y}\"")), "no mark at {x}, {y}");
            }
        }
    }
}
