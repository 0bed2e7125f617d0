//! Image planes of a run, and previews of its maps.

use crate::error::Result;
use crate::film::{Category, CategoryMap, ImagePlanes, palette};
use crate::scene::{ImageSize, Scene};
use crate::shading::ShadedPoint;
use crate::shadow::Queries;
use crate::verdict::{Cause, LightVerdict, PixelVerdict};
use crate::visibility::VisibleSurfaces;

/// R G B A, Z, P, N, albedo and identifiers of a picture. The background is 0 with alpha 0 and Z infinite.
///
/// # Errors
/// Never for points of an image of this size.
pub fn picture_planes(
    size: ImageSize,
    scene: &Scene,
    visible: &VisibleSurfaces,
    shaded: &[ShadedPoint],
) -> Result<ImagePlanes> {
    let mut planes = ImagePlanes::new(size);
    let spread = |background: f32, value: &dyn Fn(usize) -> f32| {
        let mut samples = vec![background; size.pixels()];
        for (i, &pixel) in visible.pixels[..visible.seen].iter().enumerate() {
            samples[pixel as usize] = value(i);
        }
        samples
    };
    for (k, name) in ["R", "G", "B"].into_iter().enumerate() {
        planes.add_channel(name, spread(0.0, &|i| shaded[i].radiance[k]))?;
    }
    planes.add_channel("A", spread(0.0, &|_| 1.0))?;
    planes.add_channel("Z", spread(f32::INFINITY, &|i| shaded[i].depth as f32))?;
    for (k, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
        planes.add_channel(format!("P.{axis}"), spread(0.0, &|i| visible.points[i].position[k] as f32))?;
        planes.add_channel(format!("N.{axis}"), spread(0.0, &|i| shaded[i].normal[k] as f32))?;
    }
    for (k, name) in ["R", "G", "B"].into_iter().enumerate() {
        planes.add_channel(format!("albedo.{name}"), spread(0.0, &|i| shaded[i].albedo[k]))?;
    }
    let object =
        |i: usize| visible.points[i].primitive().map_or(0.0, |p| scene.object_and_surface(p).0 as f32);
    planes.add_channel("id.object", spread(0.0, &object))?;
    Ok(planes)
}

/// What is known of a pixel.
#[derive(Debug, Clone, Copy)]
struct Judged {
    verdict: PixelVerdict,
    touching: bool,
    /// Why Embree is wrong there, if it is.
    cause: Option<Cause>,
}

impl Judged {
    /// A pixel without a query.
    fn unasked(verdict: PixelVerdict) -> Judged {
        Judged { verdict, touching: false, cause: None }
    }

    /// The code of the channel.
    fn code(&self) -> f32 {
        let touching = if self.touching { 10 } else { 0 };
        f32::from(u16::from(self.verdict.code()) + touching + self.cause.map_or(0, Cause::code))
    }

    /// The category of the map: the first nine are those of the verdict.
    fn class(&self) -> u8 {
        const TOUCHING: u8 = 9;
        match (self.verdict, self.cause) {
            (PixelVerdict::Lit | PixelVerdict::Occluded, _) if self.touching => TOUCHING,
            (PixelVerdict::EmbreeWrong, Some(Cause::Epsilon)) => TOUCHING + 1,
            (PixelVerdict::EmbreeWrong, Some(Cause::InputRounding)) => TOUCHING + 2,
            (PixelVerdict::EmbreeWrong, Some(Cause::Traversal)) => TOUCHING + 3,
            (verdict, _) => verdict.code(),
        }
    }
}

/// Classes of the difference map: what a tester and Embree say of each pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Difference {
    Background,
    /// Nobody is asked, and it is dark: it faces away or is outside the cone.
    Unlit,
    /// Nobody is asked, and it is lit: it receives no shadows.
    NotReceiving,
    BothLit,
    BothOccluded,
    OnlyTesterOccluded,
    OnlyEmbreeOccluded,
}

/// The maps of one light: where a tester and Embree differ, and who is right.
pub struct LightMaps {
    size: ImageSize,
    light: String,
    tester: &'static str,
    difference: Option<Vec<Difference>>,
    verdict: Vec<Judged>,
}

impl LightMaps {
    /// The maps of the tester of a name, which the verdict must hold.
    pub fn new(
        size: ImageSize,
        light: &str,
        visible: &VisibleSurfaces,
        queries: &Queries,
        verdict: &LightVerdict,
        tester: &str,
    ) -> Option<LightMaps> {
        let native = &verdict.tester(tester)?.run;
        let embree = verdict.tester("embree").map(|t| &t.run);
        let explained = verdict.tester("embree").and_then(|t| t.explained.as_deref()).unwrap_or_default();
        let cause = |query: usize| {
            let place = explained.binary_search_by_key(&query, |wrong| wrong.query).ok()?;
            Some(explained[place].cause)
        };
        let mut pixels = vec![Judged::unasked(PixelVerdict::Background); size.pixels()];
        let mut difference = vec![Difference::Background; size.pixels()];
        for (unasked, verdict, class) in [
            (&queries.facing_away, PixelVerdict::FacingAway, Difference::Unlit),
            (&queries.outside_cone, PixelVerdict::OutsideCone, Difference::Unlit),
            (&queries.not_receiving, PixelVerdict::NotReceiving, Difference::NotReceiving),
        ] {
            for pixel in unasked.iter().filter_map(|&node| visible.pixel_seen(node)) {
                pixels[pixel as usize] = Judged::unasked(verdict);
                difference[pixel as usize] = class;
            }
        }
        for (i, pixel) in queries.nodes.iter().map_while(|&node| visible.pixel_seen(node)).enumerate() {
            let other = embree.map(|e| e.occluded[i]);
            let judged = PixelVerdict::new(native.occluded[i], other, verdict.truth[i]);
            pixels[pixel as usize] =
                Judged { verdict: judged, touching: verdict.touching[i], cause: cause(i) };
            difference[pixel as usize] = match (native.occluded[i], other.unwrap_or(native.occluded[i])) {
                (false, false) => Difference::BothLit,
                (true, true) => Difference::BothOccluded,
                (true, false) => Difference::OnlyTesterOccluded,
                (false, true) => Difference::OnlyEmbreeOccluded,
            };
        }
        let difference = embree.is_some().then_some(difference);
        Some(LightMaps { size, light: light.into(), tester: native.name, difference, verdict: pixels })
    }

    /// Adds `shadow.<light>.difference` and `shadow.<light>.verdict`; the former only if Embree was asked.
    ///
    /// # Errors
    /// If the planes have such channels already.
    pub fn add_to(&self, planes: &mut ImagePlanes) -> Result<()> {
        if let Some(difference) = &self.difference {
            let value = |d: &Difference| match d {
                Difference::OnlyTesterOccluded => 1.0,
                Difference::OnlyEmbreeOccluded => -1.0,
                _ => 0.0,
            };
            let samples = difference.iter().map(value).collect();
            planes.add_channel(format!("shadow.{}.difference", self.light), samples)?;
        }
        planes.add_channel(
            format!("shadow.{}.verdict", self.light),
            self.verdict.iter().map(Judged::code).collect(),
        )
    }

    /// Where the tester and Embree differ, in false colour; `None` if Embree was not asked.
    ///
    /// # Errors
    /// Never for maps of this size.
    pub fn difference_map(&self) -> Result<Option<CategoryMap>> {
        let Some(difference) = &self.difference else { return Ok(None) };
        let tester = self.tester;
        let legend = vec![
            Category::plain("background", palette::BACKGROUND),
            Category::plain("faces away or outside the cone", palette::FACING_AWAY),
            Category::if_present("receives no shadows", palette::NOT_RECEIVING),
            Category::plain("both lit", palette::LIT),
            Category::plain("both occluded", palette::SHADOWED),
            Category::marked_when_rare(format!("only {tester} occluded"), palette::VERMILLION),
            Category::marked_when_rare("only embree occluded", palette::SKY_BLUE),
        ];
        let classes = difference.iter().map(|&d| d as u8).collect();
        let title = format!("light {}: {tester} against embree", self.light);
        CategoryMap::new(title, self.size, classes, legend).map(Some)
    }

    /// Who is right, in false colour.
    ///
    /// # Errors
    /// Never for maps of this size.
    pub fn verdict_map(&self) -> Result<CategoryMap> {
        let tester = self.tester;
        let legend = vec![
            Category::plain("background", palette::BACKGROUND),
            Category::plain("faces away", palette::FACING_AWAY),
            Category::plain("lit", palette::LIT),
            Category::plain("occluded", palette::SHADOWED),
            Category::marked_when_rare(format!("{tester} wrong"), palette::VERMILLION),
            // Where Embree is wrong a legend says why; this is for what cannot be said.
            Category::if_present("embree wrong", palette::BLUISH_GREEN),
            Category::marked_when_rare("both wrong", palette::REDDISH_PURPLE),
            Category::if_present("outside the cone", palette::OUTSIDE_CONE),
            Category::if_present("receives no shadows", palette::NOT_RECEIVING),
            Category::marked_when_rare("touching, all right", palette::YELLOW),
            Category::marked_when_rare("embree wrong: epsilon", palette::SKY_BLUE),
            Category::marked_when_rare("embree wrong: input rounding", palette::BLUE),
            Category::marked_when_rare("embree wrong: traversal", palette::ORANGE),
        ];
        let classes = self.verdict.iter().map(Judged::class).collect();
        CategoryMap::new(format!("light {}: verdicts", self.light), self.size, classes, legend)
    }
}
