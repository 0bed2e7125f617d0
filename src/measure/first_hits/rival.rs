//! Embree's turns.

use super::{Look, Row, Turn, own_turn};
use crate::embree::{
    CheckedDirections, Device, EmbreeMode, EmbreeScene, NO_HIT, Robustness, SceneBuffers, SceneParts,
};
use crate::error::Result;
use crate::measure::bench::Order;
use crate::measure::{Repeated, timed};
use crate::scene::{ImageSize, PrimitiveIndex, Scene};
use rayon::prelude::*;
use std::sync::Arc;

/// Rays of one task.
const TASK: usize = 1 << 12;

/// A mode and the order of its rays.
#[derive(Clone, Copy)]
struct Contender {
    mode: EmbreeMode,
    order: Order,
}

/// Why first hits are not asked of Embree.
pub(super) fn why_not(scene: &Scene) -> Option<String> {
    let is_plain = scene.curved.is_empty() && scene.alpha_masks.is_empty();
    (!is_plain)
        .then(|| "the scene has curved surfaces or holes, which Embree is not asked first hits of".into())
}

/// What is there before a clock starts.
struct Table {
    device: Device,
    buffers: Arc<SceneBuffers>,
    origin: [f32; 3],
    /// The directions of all pixels and their numbers, in each order.
    orders: Vec<(Order, Vec<u32>, Vec<[f32; 3]>)>,
}

impl Table {
    fn new(look: Look) -> Result<Table> {
        let vertices: Vec<[f32; 3]> = look.scene.vertices.iter().map(|v| v.to_array()).collect();
        let triangles: Vec<[u32; 3]> = look.scene.triangles.iter().map(|t| t.vertices).collect();
        let parts = SceneParts { vertices: &vertices, triangles: &triangles, ..SceneParts::default() };
        let ImageSize { width, .. } = look.size;
        let raster = look.camera.raster(look.size);
        let pixels: Vec<u32> = (0..look.size.pixels() as u32).collect();
        let in_order = |order: Order| {
            let pixels = order.of(&pixels, look.size);
            let direction =
                |&pixel: &u32| look.camera.direction(&raster, pixel % width, pixel / width).to_array();
            let directions = pixels.iter().map(direction).collect();
            (order, pixels, directions)
        };
        Ok(Table {
            device: Device::new(rayon::current_num_threads())?,
            buffers: Arc::new(SceneBuffers::new(parts)?),
            origin: look.camera.origin.to_array(),
            orders: Order::ALL.map(in_order).into(),
        })
    }

    fn build(&self, mode: EmbreeMode) -> Result<(f64, EmbreeScene)> {
        let built = timed(|| EmbreeScene::of_buffers(&self.device, &self.buffers, mode.scene));
        Ok((built.seconds, built.value?))
    }

    fn ask(&self, scene: &EmbreeScene, build: f64, who: Contender) -> Result<Turn> {
        let found = self.orders.iter().find(|(order, ..)| *order == who.order);
        let (_, pixels, directions) = found.expect("all orders are there");
        let rays = CheckedDirections::new(self.origin, directions)?;
        let mut answers = vec![NO_HIT; directions.len()];
        let asked = timed(|| {
            answers.par_chunks_mut(TASK).enumerate().try_for_each(|(task, answers)| {
                let first = task * TASK;
                scene.first_hits(rays.part(first..first + answers.len()), who.mode.query, answers)
            })
        });
        asked.value?;
        let mut primitives: Vec<Option<PrimitiveIndex>> = vec![None; answers.len()];
        for (&pixel, &answer) in pixels.iter().zip(&answers) {
            primitives[pixel as usize] = (answer != NO_HIT).then_some(answer);
        }
        Ok(Turn { build, query: asked.seconds, primitives })
    }
}

/// Adds a row for each mode and order, and the turns of the t-buffer to the first row.
pub(super) fn measure(
    look: Look,
    rows: &mut Vec<Row>,
    truth: &Turn,
    rounds: u32,
    finalists: usize,
) -> Result<()> {
    let truth = &truth.primitives;
    let table = Table::new(look)?;
    let is_wanted = |mode: &EmbreeMode| {
        mode.is_for_speed()
            && mode.scene.robustness == Robustness::Fast
            && mode.expect_in(&table.device).is_ok()
    };
    let modes: Vec<EmbreeMode> = EmbreeMode::all().filter(is_wanted).collect();
    let mut contenders = Vec::new();
    for same_build in modes.chunk_by(|one, other| one.scene == other.scene) {
        // The better of two: one that has to ask the system for its memory takes twice as long, and would not be in the rounds.
        let (first, _) = table.build(same_build[0])?;
        let (second, scene) = table.build(same_build[0])?;
        let build = first.min(second);
        for &mode in same_build {
            for order in Order::ALL {
                let who = Contender { mode, order };
                let mut row = Row::new(mode.to_string(), Some(order.name()));
                row.add(&table.ask(&scene, build, who)?, truth);
                rows.push(row);
                contenders.push(who);
            }
        }
    }
    let best = |time: fn(&Row) -> &Repeated| {
        let rivals = rows.iter().enumerate().skip(1);
        Repeated::fastest(rivals.map(|(number, row)| (number, time(row))), finalists)
    };
    let mut finalists: Vec<usize> = [best(|row| &row.query), best(|row| &row.frame)].concat();
    finalists.sort_unstable();
    finalists.dedup();
    for &number in &finalists {
        let row = &mut rows[number];
        *row = Row { in_rounds: true, ..Row::new(row.method.clone(), row.order) };
    }
    // The t-buffer is number 0 and has a turn a round too.
    let turns: Vec<usize> = [0].into_iter().chain(finalists).collect();
    for round in 0..rounds as usize {
        for turn in 0..turns.len() {
            let number = turns[(turn + round) % turns.len()];
            let turn = match number {
                0 => own_turn(look),
                _ => {
                    let who = contenders[number - 1];
                    let (build, scene) = table.build(who.mode)?;
                    table.ask(&scene, build, who)?
                }
            };
            rows[number].add(&turn, truth);
        }
    }
    Ok(())
}
