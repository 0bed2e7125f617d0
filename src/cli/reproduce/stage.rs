//! A scene, what its camera sees of it, and who asks its light: what a picture of a figure is drawn from.

use super::super::output;
use super::super::picture::{self, Lighting};
use super::super::view::{LookRules, Seen, View};
use super::Args;
use crate::error::{Error, Result};
use crate::film::{FileSet, add_exr};
use crate::geometry::LightPosition;
use crate::measure::Answers;
use crate::measure::raghuvanshi_dhande::{Contender, buffer_of_rows};
use crate::report::raghuvanshi_dhande::Picture;
use crate::scene::animation::Motion;
use crate::scene::formats::SceneFiles;
use crate::scene::{ImageSize, Scene};
use crate::shading::{Following, Textures, TreeRules, USUAL_DEPTH};
use crate::shadow::shadow_buffer::sphere::Sphere;
use crate::shadow::{BuildInput, EmbreeSettings, Queries, SceneIndex};
use crate::verdict::{EdgeCounts, ShadowEdges};
use crate::visibility::{FirstHitMethod, classical};

/// What of a picture is switched, beside its shadows.
#[derive(Debug, Clone, Copy)]
pub struct Appearance {
    /// Rays of mirrors.
    pub reflections: Following,
    /// Checkers.
    pub textures: Textures,
}

impl Appearance {
    /// All that there is.
    pub const FULL: Appearance = Appearance { reflections: Following::On, textures: Textures::On };

    fn left_out(self) -> Vec<&'static str> {
        let reflections = (self.reflections == Following::Off).then_some("reflections");
        let textures = (self.textures == Textures::Off).then_some("textures");
        reflections.into_iter().chain(textures).collect()
    }
}

/// Everything but the answers to the shadow rays.
pub struct Stage {
    view: View,
    seen: Seen,
    index: SceneIndex,
    appearance: Appearance,
    /// Of the scene's light.
    pub queries: Queries,
}

impl Stage {
    /// Looks at a scene of one light through its first camera, first hits by the t-buffer.
    ///
    /// # Errors
    /// If the scene has no camera of a size or not one light, or the image needs too much memory.
    pub fn new(args: &Args, scene: Scene, appearance: Appearance) -> Result<Stage> {
        let size = picture_size(args, &scene)?;
        let camera = scene.cameras[0].clone();
        let view = View {
            scene,
            motion: Motion::default(),
            rate: None,
            camera,
            size,
            files: SceneFiles::default(),
            added: Vec::new(),
        };
        let trees = TreeRules { reflections: appearance.reflections, ..TreeRules::of_depth(USUAL_DEPTH) };
        let rules = LookRules { first_hits: FirstHitMethod::TBuffer, trees };
        let seen = view.look(rules, args.memory_limit())?;
        let queries = Queries::new(&view.scene, &seen.forest.nodes, &view.scene.lights[0]);
        let index = SceneIndex::new(&view.scene);
        Ok(Stage { view, seen, index, appearance, queries })
    }

    /// The size of its pictures.
    pub fn size(&self) -> ImageSize {
        self.view.size
    }

    /// What testers of the light are built from.
    pub fn input(&self) -> BuildInput<'_> {
        let scene = &self.view.scene;
        let embree = EmbreeSettings { threads: rayon::current_num_threads(), ..EmbreeSettings::default() };
        let usual = BuildInput::new(scene, &self.index, scene.lights[0].position());
        BuildInput { memory: self.seen.memory, embree, ..usual }
    }

    /// Pixels at which the classical tracer sees something else.
    pub fn unlike_classical(&self) -> u64 {
        let traced = classical::first_hits(&self.view.scene, &self.view.camera, self.view.size);
        let pairs = traced.primitives.iter().zip(&self.seen.hits.primitives);
        pairs.filter(|(one, other)| one != other).count() as u64
    }

    /// Edges of its shadows, from the truth about its queries; `None` unless the light is at a point.
    pub fn edges(&self, truth: &[bool]) -> Option<ShadowEdges<'_>> {
        let View { scene, size, .. } = &self.view;
        let LightPosition::At(light) = scene.lights[0].position() else { return None };
        Some(ShadowEdges::new(scene, light, *size, &self.seen.forest.nodes, &self.queries, truth))
    }

    /// Wrong answers, and those of them within a cell of a shadow-buffer of an edge.
    pub fn wrong_near(
        &self,
        edges: &ShadowEdges,
        answers: &Answers,
        truth: &[bool],
        rows: u32,
    ) -> EdgeCounts {
        let width = Sphere::new(rows, 2 * rows).map_or(0.0, |sphere| sphere.cell_width());
        let visible = &self.seen.forest.nodes;
        edges.wrong_answers(visible, &self.queries, [&answers.occluded, truth], width)
    }

    /// Draws it with a tester's shadows into `NAME.png` and `NAME.exr`.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn draw(
        &self,
        args: &Args,
        files: &mut FileSet,
        name: &str,
        contender: Contender,
        answers: &Answers,
    ) -> Result<Picture> {
        let crossings = answers.crossings.as_ref();
        let lighting = Lighting::Shadowed { occluded: &answers.occluded, crossings };
        let lights = [(&self.queries, lighting)];
        let mut planes = picture::shaded(&self.view.shot(), &self.seen, &lights, self.appearance.textures)?;
        let (tester, visible) = (contender.tester(), &self.seen.forest.nodes);
        let light = &self.view.scene.lights[0].name;
        picture::add_mask(&mut planes, light, visible, &self.queries, tester, &answers.occluded)?;
        let settings = contender.rows().map(buffer_of_rows).unwrap_or_default();
        picture::add_attributes(&mut planes, &self.view.shot(), &[tester], Some(tester), None, &settings)?;
        let left_out = self.appearance.left_out();
        picture::add_left_out(&mut planes, &left_out)?;
        let (png, exr) = (format!("{name}.png"), format!("{name}.exr"));
        add_exr(files, &args.output.join(&exr), &planes)?;
        output::add_preview(files, &args.output.join(&png), &planes, self.view.scene.background, 0.0)?;
        Ok(Picture {
            png,
            exr,
            scene: self.view.scene.name.clone(),
            objects: self.view.scene.objects.len() as u32,
            left_out,
            shadow: contender.name(),
            queries: self.queries.points.len() as u64,
            shadowed: answers.occluded.iter().filter(|&&occluded| occluded).count() as u64,
            errors: None,
            edges: None,
            unlike_classical: None,
        })
    }
}

fn picture_size(args: &Args, scene: &Scene) -> Result<ImageSize> {
    let ([camera, ..], [_]) = (&scene.cameras[..], &scene.lights[..]) else {
        return Err(Error::Usage(format!("{}: expected a camera and one light", scene.name)));
    };
    let no_size = || Error::Usage(format!("{}: its camera has no size", scene.name));
    args.size.or(camera.size).ok_or_else(no_size)
}
