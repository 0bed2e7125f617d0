//! A city from above: towers in blocks, with windows that are deep in their walls and roofs behind parapets. A segment to
//! the light passes many boxes, and a ray from the camera sees few of many walls: great depth complexity.

use super::skin::Skin;
use super::{SIZE, studio};
use crate::error::Result;
use crate::random::Random;
use crate::scene::Scene;
use crate::scene::procedural::studio::matt;
use glam::{DAffine3, DVec2, DVec3};

/// Windows along each side of a tower.
const WINDOWS: usize = 5;

/// Triangles of a piece of wall with a window: its frame, the depth of the wall, and the pane.
#[cfg(test)]
const A_WINDOW: u64 = 8 + 8 + 2;

/// Sizes in widths of a lot.
const STREET: f64 = 0.7;
const FLOOR: f64 = 0.17;
const WINDOW_DEPTH: f64 = 0.03;
const PLINTH: f64 = 0.03;

const WALLS: [(&str, [f32; 3]); 4] = [
    ("brick", [0.52, 0.33, 0.26]),
    ("sandstone", [0.66, 0.57, 0.44]),
    ("concrete", [0.56, 0.57, 0.58]),
    ("render", [0.7, 0.68, 0.62]),
];

/// So many lots along each side; a street between each two.
pub(in crate::scene::procedural) fn build(lots: u32) -> Result<Scene> {
    let mut studio = studio("city", [0.55, 0.65, 0.8], [-1.9, 1.7, 0.9]);
    let street = studio.material(matt("street", [0.3, 0.3, 0.32]));
    let pavement = studio.material(matt("pavement", [0.5, 0.5, 0.48]));
    let walls = WALLS.map(|(name, colour)| studio.material(matt(name, colour)));
    // From lots to a square from -1 to 1; what is small is not blown up.
    let half = 0.5 * (edge(lots) - STREET);
    let scale = 1.0 / half.max(3.0);
    let to_scene =
        DAffine3::from_scale(DVec3::splat(scale)) * DAffine3::from_translation(DVec3::new(-half, 0.0, -half));
    let mut ground = Skin::default();
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let corners = corners.map(|[x, z]| ground.point(DVec3::new(4.0 * x, 0.0, 4.0 * z)));
    ground.quadrangle(corners);
    studio.add_input(ground.into_object("street", street))?;
    let mut plinths = Skin::default();
    for block in 0..lots.div_ceil(2).pow(2) {
        let [column, row] = [block % lots.div_ceil(2), block / lots.div_ceil(2)];
        let end = |number: u32| edge((2 * number + 2).min(lots)) - STREET;
        let low = DVec3::new(edge(2 * column), -PLINTH, edge(2 * row));
        plinths.cuboid(low, DVec3::new(end(column), PLINTH, end(row)));
    }
    let mut placed = Skin::default();
    placed.add(&plinths, &to_scene);
    studio.add_input(placed.into_object("pavements", pavement))?;
    for lot in 0..lots * lots {
        let [column, row] = [lot % lots, lot / lots];
        let (plan, mut random) = Plan::new([column, row], lots);
        let corner = DVec3::new(edge(column) + 0.5, 0.0, edge(row) + 0.5);
        let mut placed = Skin::default();
        placed.add(&plan.tower(), &(to_scene * DAffine3::from_translation(corner)));
        studio.add_input(placed.into_object(format!("tower {}", lot + 1), *random.pick(&walls)))?;
    }
    studio.camera([0.62, 0.62, 1.2], [0.0, 0.0, 0.1], 40.0, SIZE);
    Ok(studio.finish())
}

/// Where a lot begins: streets lie behind each two.
fn edge(lot: u32) -> f64 {
    f64::from(lot) + STREET * f64::from(lot / 2)
}

/// How a tower is built.
struct Plan {
    floors: usize,
    /// Half of its sides.
    half: DVec2,
}

impl Plan {
    /// Of the tower on a lot; the generator goes on.
    fn new([column, row]: [u32; 2], lots: u32) -> (Plan, Random) {
        let mut random = Random::new((u64::from(column) << 32) | u64::from(row));
        let from_centre = |number: u32| (f64::from(number) + 0.5) / f64::from(lots) - 0.5;
        let distance = DVec2::new(from_centre(column), from_centre(row)).length();
        // Higher towards the centre, and not everywhere.
        let downtown = (1.0 - 2.2 * distance).max(0.0);
        let high = random.unit();
        let floors = 5.0 + 8.0 * random.unit() + 26.0 * downtown * high * high;
        let half = DVec2::new(0.3 + 0.12 * random.unit(), 0.3 + 0.12 * random.unit());
        (Plan { floors: floors as usize, half }, random)
    }

    /// Around the origin of the ground, closed.
    fn tower(&self) -> Skin {
        let mut skin = Skin::default();
        let bottom = PLINTH * 0.5;
        let height = |floor: usize| bottom + FLOOR * floor as f64;
        let rings: Vec<Vec<u32>> = (0..=self.floors).map(|f| self.ring(&mut skin, 1.0, height(f))).collect();
        for pair in rings.windows(2) {
            self.storey(&mut skin, &pair[0], &pair[1]);
        }
        let parapet = self.ring(&mut skin, 0.94, height(self.floors));
        let roof = self.ring(&mut skin, 0.94, height(self.floors) - 0.5 * FLOOR);
        skin.wall(&rings[self.floors], &parapet);
        skin.wall(&parapet, &roof);
        let middle = skin.point(DVec3::new(0.0, height(self.floors) - 0.45 * FLOOR, 0.0));
        skin.fan(&roof, middle);
        let below: Vec<u32> = rings[0].iter().rev().copied().collect();
        let middle = skin.point(DVec3::new(0.0, bottom, 0.0));
        skin.fan(&below, middle);
        skin
    }

    /// Corners around it at a height, counter-clockwise from above, as many on each side as there are windows.
    fn ring(&self, skin: &mut Skin, size: f64, height: f64) -> Vec<u32> {
        let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(DVec2::from);
        let place = |i: usize| {
            let (from, to) = (corners[i / WINDOWS], corners[(i / WINDOWS + 1) % 4]);
            let along = (i % WINDOWS) as f64 / WINDOWS as f64;
            let DVec2 { x, y } = size * self.half * (from + along * (to - from));
            DVec3::new(x, height, y)
        };
        (0..4 * WINDOWS).map(|i| skin.point(place(i))).collect()
    }

    /// A window between each two corners of two rings.
    fn storey(&self, skin: &mut Skin, low: &[u32], high: &[u32]) {
        for i in 0..low.len() {
            let next = (i + 1) % low.len();
            let outer = [low[i], low[next], high[next], high[i]];
            let [a, b, _, d] = outer.map(|corner| skin.points[corner as usize]);
            let (across, up) = (b - a, d - a);
            let inwards = up.cross(across).normalize() * WINDOW_DEPTH;
            let opening = [[0.2, 0.22], [0.8, 0.22], [0.8, 0.86], [0.2, 0.86]];
            let frame = opening.map(|[u, v]| a + u * across + v * up);
            let front = frame.map(|place| skin.point(place));
            let back = frame.map(|place| skin.point(place + inwards));
            skin.wall(&outer, &front);
            skin.wall(&front, &back);
            skin.quadrangle(back);
        }
    }
}

/// Triangles of the whole of it.
#[cfg(test)]
pub(in crate::scene::procedural) fn triangles(lots: u32) -> u64 {
    let tower = |lot: u32| {
        let (plan, _) = Plan::new([lot % lots, lot / lots], lots);
        4 * WINDOWS as u64 * (A_WINDOW * plan.floors as u64 + 2 + 2 + 1 + 1)
    };
    let blocks = u64::from(lots.div_ceil(2)).pow(2);
    2 + 12 * blocks + (0..lots * lots).map(tower).sum::<u64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn towers_are_closed() {
        for lot in [[0, 0], [3, 2], [2, 2]] {
            let (plan, _) = Plan::new(lot, 5);
            let tower = plan.tower();
            assert_eq!(tower.open_edges(), 0);
            let whole = 4.0 * plan.half.x * plan.half.y * FLOOR * plan.floors as f64;
            assert!((0.5..1.0).contains(&(tower.volume() / whole)), "{}", tower.volume() / whole);
        }
    }

    #[test]
    fn a_street_lies_behind_each_two_lots() {
        let edges = [0, 1, 2, 3, 4].map(edge);
        assert_eq!(edges, [0.0, 1.0, 2.0 + STREET, 3.0 + STREET, 4.0 + 2.0 * STREET]);
    }
}
