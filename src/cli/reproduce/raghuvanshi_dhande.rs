//! Figures 9 to 18 of Raghuvanshi and Dhande, Raytraced rendering using t-buffer and shadow-buffer, 2004.

use super::super::Outcome;
use super::super::progress::Messages;
use super::Args;
use super::stage::{Appearance, Stage};
use crate::error::Result;
use crate::film::FileSet;
use crate::measure::raghuvanshi_dhande::{
    Contender, MeasuredFrame, ObjectKind, Plan, Series, answers_of, judged, measure,
};
use crate::report::raghuvanshi_dhande::document::{Document, ErrorReport, Figure, SeriesReport};
use crate::report::raghuvanshi_dhande::paper::{
    COARSE_ROWS, FIGURES, FINE_ROWS, OBJECTS, OBJECTS_OF_17, PICTURED_OBJECTS, ROWS_OF_17, ROWS_OF_18,
};
use crate::report::raghuvanshi_dhande::{csv, figures, plots, table};
use crate::scene::ImageSize;
use crate::scene::procedural::find;
use crate::shading::{Following, Textures};

/// The images of figures 13 to 17, which the paper says nothing about: small, so that the classical tracer is through
/// with 6000 objects in a few seconds.
const TIMED_SIZE: ImageSize = ImageSize { width: 240, height: 180 };

/// What is for this paper alone.
#[derive(Debug, clap::Args)]
pub struct FigureOptions {
    /// Figures from 9 to 18, separated by commas [default: all]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = parse_figure)]
    figures: Vec<u32>,
    /// No scenes of more objects than this in figures 12 to 17 [default: 6000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    most_objects: Option<u32>,
}

fn parse_figure(text: &str) -> std::result::Result<u32, String> {
    let found = FIGURES.iter().find(|(figure, _)| figure.to_string() == text);
    found.map(|(figure, _)| *figure).ok_or_else(|| {
        let (first, last) = (FIGURES[0].0, FIGURES[FIGURES.len() - 1].0);
        format!("expected figures from {first} to {last}")
    })
}

impl FigureOptions {
    /// The first of these options that was given.
    pub fn given(&self) -> Option<&'static str> {
        [(!self.figures.is_empty(), "--figures"), (self.most_objects.is_some(), "--most-objects")]
            .into_iter()
            .find_map(|(given, name)| given.then_some(name))
    }

    fn wants(&self, figure: u32) -> bool {
        self.figures.is_empty() || self.figures.contains(&figure)
    }

    fn most_objects(&self) -> u32 {
        self.most_objects.unwrap_or(OBJECTS[OBJECTS.len() - 1])
    }

    /// Numbers of objects of figures 13 to 16: the largest wanted is among them.
    fn series(&self) -> Vec<u32> {
        let most = self.most_objects();
        OBJECTS.into_iter().filter(|&objects| objects < most).chain([most]).collect()
    }
}

/// Makes the figures.
///
/// # Errors
/// Whatever a scene or a tester reports, or that a file cannot be written.
pub fn run(args: &Args, messages: Messages) -> Result<Outcome> {
    let options = &args.raghuvanshi_dhande;
    let plan = Plan {
        size: args.size.unwrap_or(TIMED_SIZE),
        repetitions: args.repetitions,
        memory: args.memory_limit(),
    };
    let mut files = FileSet::new();
    files.folder(&args.output)?;
    let mut document = Document::new(&plan, rayon::current_num_threads());
    for figure in [9, 10, 11] {
        if options.wants(figure) {
            messages.say(&format!("drawing figure {figure}"));
            document.figures.push(switched(args, &mut files, figure, &mut document.native_wrong)?);
        }
    }
    if options.wants(12) {
        messages.say("drawing figure 12");
        document.figures.push(figure_12(args, &mut files, &mut document.native_wrong)?);
    }
    if (13..=16).any(|figure| options.wants(figure)) {
        let series = measure_series(options, &plan, messages)?;
        document.native_wrong +=
            series.iter().flat_map(|one| &one.frames).map(MeasuredFrame::native_wrong).sum::<u64>();
        for (figure, make) in [
            (13, figures::figure_13 as fn(&[Series], ImageSize) -> Figure),
            (14, figures::figure_14),
            (15, figures::figure_15),
            (16, figures::figure_16),
        ] {
            if options.wants(figure) {
                document.figures.push(make(&series, plan.size));
            }
        }
        document.series = series.iter().map(SeriesReport::new).collect();
    }
    if options.wants(17) {
        let objects = OBJECTS_OF_17.min(options.most_objects());
        messages.say(&format!("measuring {objects} spheres with shadow-buffers of rising resolution"));
        let frame = measure(&ObjectKind::Spheres.stacked(objects)?, &with_others(&ROWS_OF_17), &plan)?;
        document.native_wrong += frame.native_wrong();
        document.figures.push(figures::figure_17(&frame, plan.size));
    }
    if options.wants(18) {
        messages.say("drawing figure 18");
        document.figures.push(figure_18(args, &mut files, &mut document.native_wrong)?);
    }
    for figure in &document.figures {
        if let Some(name) = &figure.plot {
            args.write(&mut files, name, &plots::plot(figure)?)?;
        }
    }
    args.finish(files, &document, &table::tables(&document), &csv::csv(&document))?;
    Ok(if document.native_wrong > 0 { Outcome::NativeWrong } else { Outcome::Right })
}

/// Shadow-buffers of these rows, and the testers that the paper has not.
fn with_others(rows: &[u32]) -> Vec<Contender> {
    let buffers = rows.iter().map(|&rows| Contender::ShadowBuffer(rows));
    buffers.chain(Contender::OTHERS.iter().copied()).collect()
}

fn measure_series(options: &FigureOptions, plan: &Plan, messages: Messages) -> Result<Vec<Series>> {
    let rows: Vec<u32> = [(COARSE_ROWS, [15, 16]), (FINE_ROWS, [16, 16])]
        .into_iter()
        .filter(|(_, figures)| figures.iter().any(|&figure| options.wants(figure)))
        .map(|(rows, _)| rows)
        .collect();
    let contenders = with_others(&rows);
    let series = |kind: ObjectKind| {
        let frame = |objects: u32| {
            messages.say(&format!("measuring {objects} {}", kind.name()));
            measure(&kind.stacked(objects)?, &contenders, plan)
        };
        let frames = options.series().into_iter().map(frame).collect::<Result<_>>()?;
        Ok(Series { kind, frames })
    };
    ObjectKind::ALL.into_iter().map(series).collect()
}

/// Figures 9, 10 and 11: switch after switch is turned on.
fn switched(args: &Args, files: &mut FileSet, figure: u32, native_wrong: &mut u64) -> Result<Figure> {
    let (appearance, contender) = match figure {
        9 => (Appearance { reflections: Following::Off, textures: Textures::Off }, Contender::BruteForce),
        10 => (Appearance { reflections: Following::On, textures: Textures::Off }, Contender::BruteForce),
        // The size of the shadow-buffer of figure 11 is not said; this is that of figure 15.
        _ => (Appearance::FULL, Contender::ShadowBuffer(COARSE_ROWS)),
    };
    let stage = Stage::new(args, find("three-spheres")?.build(None)?, appearance)?;
    let judged = judged(&stage.input(), &stage.queries, &[contender])?;
    let tester = &judged.testers[0];
    let mut picture = stage.draw(args, files, &format!("figure-{figure}"), contender, &tester.answers)?;
    let unlike = stage.unlike_classical();
    picture.errors = Some(ErrorReport::new(tester.errors, judged.queries));
    picture.unlike_classical = Some(unlike);
    *native_wrong += unlike;
    if contender == Contender::BruteForce {
        *native_wrong += tester.errors.wrong();
    }
    Ok(Figure { pictures: vec![picture], ..Figure::new(figure, stage.size()) })
}

/// The procedural scene, both kinds.
fn figure_12(args: &Args, files: &mut FileSet, native_wrong: &mut u64) -> Result<Figure> {
    let most = args.raghuvanshi_dhande.most_objects();
    let mut pictures = Vec::new();
    let mut size = TIMED_SIZE;
    for kind in ObjectKind::ALL {
        for objects in PICTURED_OBJECTS.into_iter().filter(|&objects| objects <= most) {
            let stage = Stage::new(args, kind.stacked(objects)?, Appearance::FULL)?;
            let contender = Contender::BruteForce;
            let answers = answers_of(contender, &stage.input(), &stage.queries)?;
            let name = format!("figure-12-{}-{objects}", kind.name());
            let mut picture = stage.draw(args, files, &name, contender, &answers)?;
            let unlike = stage.unlike_classical();
            picture.unlike_classical = Some(unlike);
            *native_wrong += unlike;
            size = stage.size();
            pictures.push(picture);
        }
    }
    Ok(Figure { pictures, ..Figure::new(12, size) })
}

/// The same scene by pure ray tracing, and by shadow-buffers of rising resolution, all held against the arbiter.
fn figure_18(args: &Args, files: &mut FileSet, native_wrong: &mut u64) -> Result<Figure> {
    let stage = Stage::new(args, find("three-spheres")?.build(None)?, Appearance::FULL)?;
    let buffers = ROWS_OF_18.into_iter().map(Contender::ShadowBuffer);
    let contenders: Vec<Contender> = [Contender::BruteForce].into_iter().chain(buffers).collect();
    let judged = judged(&stage.input(), &stage.queries, &contenders)?;
    *native_wrong += judged.testers[0].errors.wrong();
    let edges = stage.edges(&judged.truth);
    let mut pictures = Vec::new();
    for tester in &judged.testers {
        let name = tester.contender.rows().map_or("ray-traced".into(), |rows| format!("rows-{rows}"));
        let name = format!("figure-18-{name}");
        let mut picture = stage.draw(args, files, &name, tester.contender, &tester.answers)?;
        picture.errors = Some(ErrorReport::new(tester.errors, judged.queries));
        let near = |edges, rows| stage.wrong_near(edges, &tester.answers, &judged.truth, rows).into();
        picture.edges = edges.as_ref().zip(tester.contender.rows()).map(|(edges, rows)| near(edges, rows));
        pictures.push(picture);
    }
    Ok(Figure { pictures, ..figures::figure_18(&judged, stage.size()) })
}
