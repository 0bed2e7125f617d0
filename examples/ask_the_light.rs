//! Builds a light buffer for a scene and asks it about points of its own.
//!
//! `cargo run --example ask_the_light -- scenes/blocks.obj`

use glam::Vec3;
use lightbuffer::scene::formats;
use lightbuffer::shadow::light_buffer::LightBuffer;
use lightbuffer::shadow::{BuildInput, Receivers, SceneIndex, ShadowTester};
use lightbuffer::{Error, Result, SurfacePoint};
use std::path::Path;

fn main() -> Result<()> {
    let path = std::env::args().nth(1).ok_or_else(|| Error::Usage("expected a scene file".into()))?;
    let scene = formats::load(Path::new(&path))?;
    let (low, high) = scene.bounds().expect("a loaded scene has triangles");
    let light = Vec3::new(low.x, 2.0 * high.y, high.z);

    // What all lights share, then one light's buffer, for points anywhere in space.
    let index = SceneIndex::new(&scene);
    let input = BuildInput { receivers: Receivers::Anywhere, ..BuildInput::new(&scene, &index, light) };
    let buffer = LightBuffer::new(&input)?;

    // A row of points near the ground; queries are asked in batches.
    let at = |i: usize| low + (high - low) * Vec3::new(i as f32 / 8.0, 0.05, 0.3);
    let points: Vec<_> = (0..=8).filter_map(|i| SurfacePoint::bare(at(i))).collect();
    let mut occluded = vec![false; points.len()];
    let counters = buffer.occluded(&points, &mut occluded)?;
    for (point, occluded) in points.iter().zip(&occluded) {
        println!("{} is {}", point.position, if *occluded { "occluded" } else { "lit" });
    }
    println!("{} triangles tested for {} points", counters.tests, points.len());
    Ok(())
}
