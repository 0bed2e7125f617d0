//! Whom to ask: points behind corners, edges and borders of cells, beside the light, on what eyes see.

use super::super::aimed::nudged;
use super::super::parts::Corners;
use super::place::{Place, direction};
use super::recipe::{Aim, Recipe};
use crate::geometry::LightPosition;
use crate::random::Random;
use crate::shadow::{Receivers, Resolution};
use glam::{DVec3, Vec3};

/// What aims are made for.
pub struct Aims<'a> {
    place: &'a Place,
    light: LightPosition,
    triangles: Vec<Corners>,
    /// Of curved surfaces, places within them or near.
    middles: Vec<DVec3>,
    resolutions: Vec<u32>,
}

/// Cells along an edge; of a small scene as many, if nobody says how many.
fn cells(resolution: Resolution) -> u32 {
    match resolution {
        Resolution::Auto => 256,
        Resolution::Cells(cells) => cells,
    }
}

impl<'a> Aims<'a> {
    /// For a recipe that has all but its aims.
    pub fn new(recipe: &Recipe, place: &'a Place) -> Aims<'a> {
        let shapes = recipe.parts.iter().flat_map(|part| &part.shapes);
        let middle = |(low, high): (Vec3, Vec3)| (low.as_dvec3() + high.as_dvec3()) * 0.5;
        Aims {
            place,
            light: recipe.light,
            triangles: recipe.parts.iter().flat_map(|part| part.triangles.iter().copied()).collect(),
            middles: shapes.filter_map(|shape| shape.bounds()).map(middle).collect(),
            resolutions: recipe.settings.iter().map(|settings| cells(settings.resolution)).collect(),
        }
    }

    /// One, in space only if receivers are anywhere.
    pub fn aim(&self, receivers: Receivers, random: &mut Random) -> Option<Aim> {
        let target = self.target(random);
        if receivers == Receivers::Anywhere && random.chance(0.5) {
            let point = self.behind(target, random);
            let point = if random.chance(0.5) { point.as_vec3() } else { nudged(point, random) };
            return point.is_finite().then_some(Aim::At(point));
        }
        let eye = self.eye(target, random);
        let direction = (target - eye.as_dvec3()).as_vec3();
        let sound = eye.is_finite() && direction.is_finite() && direction != Vec3::ZERO;
        sound.then_some(Aim::Seen { eye, direction })
    }

    /// A place that a segment or ray should pass through.
    fn target(&self, random: &mut Random) -> DVec3 {
        match random.below(10) {
            0..=5 if !self.triangles.is_empty() => {
                let mut corners = random.pick(&self.triangles).map(|corner| corner.as_dvec3());
                corners.rotate_left(random.below(3));
                let [a, b, c] = corners;
                match random.below(6) {
                    0 => a,
                    1 => (a + b) * 0.5,
                    2 => a.lerp(b, random.unit()),
                    3 => (a + b + c) / 3.0,
                    4 => a * 0.5 + b * 0.25 + c * 0.25,
                    _ => {
                        let (u, v) = (random.unit(), random.unit());
                        a.lerp(b, u).lerp(c, v)
                    }
                }
            }
            6 if !self.middles.is_empty() => {
                *random.pick(&self.middles) + self.place.way(random) * self.place.size()
            }
            7 => match self.light {
                LightPosition::At(light) => light.as_dvec3() + self.border(random) * self.place.size(),
                LightPosition::Towards(_) => self.place.exact(self.place.lattice(random)),
            },
            8 => self.place.exact(self.place.anywhere(random)),
            _ => self.place.exact(self.place.lattice(random)),
        }
    }

    /// A direction on the border of cells of the light's cube, or on its seams.
    fn border(&self, random: &mut Random) -> DVec3 {
        let cells = f64::from(*random.pick(&self.resolutions));
        let mut border = || 2.0 * random.below(cells as usize + 1) as f64 / cells - 1.0;
        let mut turned = [border(), border(), if random.chance(0.5) { 1.0 } else { -1.0 }];
        if random.chance(0.4) {
            turned[0] = random.signed();
        }
        turned.rotate_left(random.below(3));
        DVec3::from_array(turned) * *random.pick(&[1.0, 2.0, 0.5])
    }

    /// A point on the line from the light through the target: before it, in it, behind it or at the light.
    fn behind(&self, target: DVec3, random: &mut Random) -> DVec3 {
        match self.light {
            LightPosition::At(light) => {
                let light = light.as_dvec3();
                let far = *random.pick(&[1.0, 1.0 + 1e-6, 1.25, 1.5, 2.0, 2.0, 2.0, 4.0, 0.5, 0.0]);
                light + (target - light) * far
            }
            LightPosition::Towards(way) => {
                let step = way.as_dvec3() / f64::from(way.abs().max_element());
                let far = *random.pick(&[0.0, 0.5, 1.0, 1.0, 2.0, 4.0, -1.0, 1e-6]);
                target - step * (far * self.place.size())
            }
        }
    }

    /// Somewhere to look from: often on the light's side of things, sometimes the light itself.
    fn eye(&self, target: DVec3, random: &mut Random) -> Vec3 {
        let beside = direction(random) * self.place.size();
        match self.light {
            LightPosition::At(light) => match random.below(6) {
                0 => light,
                1 => (light.as_dvec3() + beside).as_vec3(),
                2 | 3 => (target.lerp(light.as_dvec3(), 0.125) + beside * 0.25).as_vec3(),
                4 => self.place.of(self.place.anywhere(random) * 2.0),
                _ => self.place.of(self.place.lattice(random) * 2.0),
            },
            LightPosition::Towards(way) => {
                let step = way.as_dvec3() * (self.place.size() / f64::from(way.abs().max_element()));
                match random.below(4) {
                    0 => (target + step).as_vec3(),
                    1 | 2 => (target + step * 0.5 + beside * 0.25).as_vec3(),
                    _ => self.place.of(self.place.lattice(random) * 2.0),
                }
            }
        }
    }
}
