//! The image of a run: shaded points, the masks of every light, and what made them.

use super::view::{Seen, Shot};
use crate::error::{Error, Result};
use crate::film::{CategoryMap, ImageMetrics, ImagePlanes};
use crate::report::images::{LightMaps, picture_planes};
use crate::report::validation::EmbreeFacts;
use crate::scene::FrameRate;
use crate::shading::{ShadedPoint, Textures, shade_picture};
use crate::shadow::shadow_buffer::{self, ShadowBufferSettings};
use crate::shadow::{Basis, Crossings, Queries};
use crate::verdict::{LightVerdict, TesterResult, TesterRun};
use crate::visibility::VisibleSurfaces;
use std::collections::BTreeMap;

/// A preview and the word for it in its file name.
pub struct Preview {
    /// `difference` or `verdict`.
    pub kind: &'static str,
    /// The map.
    pub colours: CategoryMap,
}

/// The light that one light of the scene casts.
#[derive(Clone, Copy)]
pub enum Lighting<'a> {
    /// Where a tester says that it arrives.
    Shadowed {
        /// Of each query.
        occluded: &'a [bool],
        /// What the segments of the others cross, if that was asked for.
        crossings: Option<&'a Crossings>,
    },
    /// This share of it, of each query.
    Soft(&'a [[f32; 3]]),
    /// Wherever it is faced.
    Unshadowed,
}

impl<'a> From<&'a TesterRun> for Lighting<'a> {
    fn from(run: &'a TesterRun) -> Lighting<'a> {
        match &run.soft_light {
            Some(light) => Lighting::Soft(light),
            None => Lighting::Shadowed { occluded: &run.occluded, crossings: run.crossings.as_ref() },
        }
    }
}

/// The picture, with the queries and the lighting of each light of the scene.
///
/// # Errors
/// Never for the points of a view.
pub fn shaded(
    shot: &Shot,
    seen: &Seen,
    lighting: &[(&Queries, Lighting)],
    textures: Textures,
) -> Result<ImagePlanes> {
    let arriving: Vec<_> =
        lighting.iter().map(|(queries, lighting)| arriving(shot, seen, queries, lighting)).collect();
    let Shot { scene, camera, lights, .. } = shot;
    let shaded = shade_picture(scene, camera, lights, &seen.forest, &arriving, textures);
    picture_planes(seen.hits.size, scene, &seen.forest.nodes, &shaded)
}

fn arriving(shot: &Shot, seen: &Seen, queries: &Queries, lighting: &Lighting) -> Vec<[f32; 3]> {
    let points = seen.forest.nodes.points.len();
    let scene = shot.scene;
    match lighting {
        Lighting::Shadowed { occluded, crossings } => queries.arriving(scene, points, occluded, *crossings),
        Lighting::Soft(light) => queries.arriving_by(scene, points, |query| light[query]),
        Lighting::Unshadowed => queries.arriving(scene, points, &vec![false; queries.points.len()], None),
    }
}

/// The run of one tester at every light.
///
/// # Errors
/// If that tester was skipped.
pub fn runs_of<'v>(
    judged: &'v [(Queries, LightVerdict)],
    tester: &str,
) -> Result<Vec<(&'v Queries, &'v TesterRun)>> {
    let run = |(queries, verdict): &'v (Queries, LightVerdict)| Some((queries, &verdict.tester(tester)?.run));
    judged.iter().map(run).collect::<Option<Vec<_>>>().ok_or_else(|| {
        Error::Usage(format!("{tester} would need more than 2e11 tests here; choose another --shadow"))
    })
}

/// Bytes of a pixel while pictures are held against each other: two of them with their shading, and what SSIM and FLIP make
/// of both.
pub const METRICS_BYTES: u64 = 2 * (15 * 4 + size_of::<ShadedPoint>() as u64) + 2 * (24 + 12 + 10 * 4);

/// The picture by the shadows of each tester that was asked at every light, against that by the truth's. Whoever is right
/// everywhere has the same picture, which need not be made.
///
/// # Errors
/// Never for the points of a view.
pub fn metrics(
    shot: &Shot,
    seen: &Seen,
    judged: &[(Queries, LightVerdict)],
) -> Result<BTreeMap<&'static str, ImageMetrics>> {
    let by = |tester: &str| {
        let runs = runs_of(judged, tester)?;
        let lighting: Vec<_> = runs.iter().map(|&(queries, run)| (queries, run.into())).collect();
        shaded(shot, seen, &lighting, Textures::On)
    };
    let (Some(truth), Some((_, first))) = (truth_of(judged), judged.first()) else {
        return Ok(BTreeMap::new());
    };
    let mut reference = None;
    let mut metrics = BTreeMap::new();
    for tester in &first.testers {
        let name = tester.run.name;
        let results: Option<Vec<_>> = judged.iter().map(|(_, verdict)| verdict.tester(name)).collect();
        let Some(results) = results else { continue };
        let is_right = |result: &&TesterResult| result.counts.wrong == 0 && result.run.soft_light.is_none();
        if results.iter().all(is_right) {
            metrics.insert(name, ImageMetrics::SAME);
            continue;
        }
        if reference.is_none() {
            reference = Some(by(truth)?);
        }
        if let Some(reference) = &reference {
            metrics.insert(name, ImageMetrics::new(&by(name)?, reference)?);
        }
    }
    Ok(metrics)
}

/// The arbiter's name, if it was asked.
fn truth_of(judged: &[(Queries, LightVerdict)]) -> Option<&'static str> {
    let (_, verdict) = judged.first()?;
    verdict.testers.iter().find(|tester| tester.run.basis == Basis::Truth).map(|tester| tester.run.name)
}

/// Adds one `shadow.<light>.<tester>` channel.
///
/// # Errors
/// If the planes have it already.
pub fn add_mask(
    planes: &mut ImagePlanes,
    name: &str,
    visible: &VisibleSurfaces,
    queries: &Queries,
    tester: &str,
    occluded: &[bool],
) -> Result<()> {
    let mut samples = vec![0.0; planes.size().pixels()];
    let pixels = queries.nodes.iter().map_while(|&node| visible.pixel_seen(node));
    for (pixel, &occluded) in pixels.zip(occluded) {
        samples[pixel as usize] = f32::from(u8::from(occluded));
    }
    planes.add_channel(format!("shadow.{name}.{tester}"), samples)
}

/// Adds the channels `shadow.<light>.*` and returns the previews of the light's maps.
///
/// # Errors
/// If the planes have such channels already.
pub fn add_light(
    planes: &mut ImagePlanes,
    name: &str,
    visible: &VisibleSurfaces,
    queries: &Queries,
    verdict: &LightVerdict,
    tester: &str,
) -> Result<Vec<Preview>> {
    for result in &verdict.testers {
        add_mask(planes, name, visible, queries, result.run.name, &result.run.occluded)?;
    }
    let Some(maps) = LightMaps::new(planes.size(), name, visible, queries, verdict, tester) else {
        return Ok(Vec::new());
    };
    maps.add_to(planes)?;
    let difference = maps.difference_map()?.map(|colours| Preview { kind: "difference", colours });
    let verdict = Preview { kind: "verdict", colours: maps.verdict_map()? };
    Ok(difference.into_iter().chain([verdict]).collect())
}

/// Says in the file what it shows without, if something was left out.
///
/// # Errors
/// If the attribute is there already.
pub fn add_left_out(planes: &mut ImagePlanes, left_out: &[&str]) -> Result<()> {
    match left_out {
        [] => Ok(()),
        _ => planes.add_attribute("leftOut", left_out.join(" ")),
    }
}

/// Says in the file what it shows and what made it; `tester` is whose shadows it has, if any. Times and machines stay out, so that equal pictures
/// are equal files.
///
/// # Errors
/// If an attribute is there already.
pub fn add_attributes(
    planes: &mut ImagePlanes,
    shot: &Shot,
    testers: &[&str],
    tester: Option<&str>,
    embree: Option<&EmbreeFacts>,
    settings: &ShadowBufferSettings,
) -> Result<()> {
    planes.add_attribute("version", env!("CARGO_PKG_VERSION"))?;
    planes.add_attribute("scene", &shot.scene.name)?;
    planes.add_attribute("sceneHash", format!("{:016x}", shot.hash()))?;
    planes.add_attribute("camera", &shot.camera.name)?;
    planes.add_attribute("testers", testers.join(" "))?;
    if let Some(tester) = tester {
        planes.add_attribute("shadow", tester)?;
    }
    if testers.contains(&shadow_buffer::ENTRY.name) {
        // They decide its answers.
        planes.add_attribute("shadowBuffer", settings.to_string())?;
    }
    if let Some(embree) = embree {
        planes.add_attribute("embree", &embree.version)?;
        planes.add_attribute("embreeEpsilon", format!("{:e}", embree.epsilon))?;
    }
    Ok(())
}

/// Says in the file which frame it is, and how many there are a second.
///
/// # Errors
/// If the attribute is there already.
pub fn add_frame(planes: &mut ImagePlanes, frame: u32, rate: FrameRate) -> Result<()> {
    planes.set_frame_rate(rate);
    planes.add_attribute("frame", frame.to_string())
}
