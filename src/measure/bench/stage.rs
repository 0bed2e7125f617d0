//! A scene, a view of it, and the shadow queries of each light in every order.

use super::Order;
use crate::error::Result;
use crate::geometry::LightPosition;
use crate::geometry::batch::InstructionSet;
use crate::memory::MemoryLimit;
use crate::scene::{ImageSize, Scene};
use crate::shadow::{Queries, SceneIndex};
use crate::visibility::{Points, RoundedPoint, SurfacePoint, VisibleSurfaces};

/// What all contenders are given.
pub struct Stage<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What the arbiter makes use of; contenders make their own within the time that is taken.
    pub index: SceneIndex,
    /// Of the image.
    pub size: ImageSize,
    /// The queries of each light.
    pub lights: Vec<LightQueries>,
    /// What is left for testers.
    pub memory: MemoryLimit,
    /// Orders in which there are queries.
    pub orders: Vec<Order>,
    /// What native testers run on: the widest that this machine has, unless it is changed.
    pub instruction_set: InstructionSet,
}

/// The queries of one light.
pub struct LightQueries {
    /// Where it is.
    pub light: LightPosition,
    /// The points in each order.
    orders: Vec<Ordered>,
}

struct Ordered {
    order: Order,
    points: Vec<SurfacePoint>,
    rounded: Vec<RoundedPoint>,
    /// For each point its place in rows; nothing for rows.
    places: Vec<u32>,
}

impl<'a> Stage<'a> {
    /// The queries of all lights of a scene.
    ///
    /// # Errors
    /// If they need more memory than there may be.
    pub fn new(
        scene: &'a Scene,
        visible: &VisibleSurfaces,
        size: ImageSize,
        orders: &[Order],
        memory: MemoryLimit,
    ) -> Result<Stage<'a>> {
        let queries = visible.points.len() as u64 * scene.lights.len() as u64;
        let a_query = size_of::<SurfacePoint>() + size_of::<RoundedPoint>() + size_of::<u32>();
        let bytes = queries * a_query as u64 * orders.len() as u64;
        let memory = memory.beside(format!("the queries of {} lights", scene.lights.len()), bytes)?;
        let of_light = |light: &crate::scene::Light| {
            let queries = Queries::new(scene, visible, light);
            let pixels: Vec<u32> = queries.nodes.iter().map(|&node| visible.pixels[node as usize]).collect();
            let ordered = |&order: &Order| {
                let (points, places) = match order {
                    Order::Rows => (queries.points.clone(), Vec::new()),
                    Order::Tiles => {
                        let places = order.of(&pixels, size);
                        (places.iter().map(|&place| queries.points[place as usize]).collect(), places)
                    }
                };
                Ordered { order, rounded: RoundedPoint::all(&points), points, places }
            };
            LightQueries { light: light.position(), orders: orders.iter().map(ordered).collect() }
        };
        let lights = scene.lights.iter().map(of_light).collect();
        let (index, orders) = (SceneIndex::new(scene), orders.to_vec());
        Ok(Stage { scene, index, size, lights, memory, orders, instruction_set: InstructionSet::best() })
    }

    /// Queries of all lights.
    pub fn queries(&self) -> u64 {
        self.lights.iter().map(|light| light.count() as u64).sum()
    }
}

impl LightQueries {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.orders.first().map_or(0, |ordered| ordered.points.len())
    }

    fn ordered(&self, order: Order) -> &Ordered {
        self.orders.iter().find(|ordered| ordered.order == order).expect("an order that was asked for")
    }

    /// The points in an order.
    pub fn points(&self, order: Order) -> Points<'_> {
        let ordered = self.ordered(order);
        Points::new(&ordered.rounded, &ordered.points)
    }

    /// Any point by its place in rows. Slow unless there are rows.
    pub fn point(&self, place: u32) -> SurfacePoint {
        let ordered = &self.orders[0];
        match ordered.places.is_empty() {
            true => ordered.points[place as usize],
            false => {
                let found = ordered.places.iter().position(|&other| other == place);
                ordered.points[found.expect("a place of a query")]
            }
        }
    }

    /// Answers that were given in an order, in rows.
    pub fn in_rows(&self, order: Order, answers: Vec<bool>) -> Vec<bool> {
        let places = &self.ordered(order).places;
        if places.is_empty() {
            return answers;
        }
        let mut rows = vec![false; answers.len()];
        for (&place, answer) in places.iter().zip(answers) {
            rows[place as usize] = answer;
        }
        rows
    }
}
