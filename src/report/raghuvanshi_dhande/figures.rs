//! Figures 13 to 18 from what was measured: their curves, and what they come to.

use super::document::{Curve, Fact, Figure, FitReport};
use super::paper::{
    COARSE_ROWS, CORRELATION, FINE_ROWS, OBJECTS_OF_17, SATURATED_AT, SATURATED_GAIN, SATURATED_ROWS,
};
use crate::measure::fit::{Degree, Fit};
use crate::measure::raghuvanshi_dhande::{Contender, Judged, MeasuredFrame, ObjectKind, Series};
use crate::scene::ImageSize;

/// Beyond as many objects what each of them costs the t-buffer shows in the gain.
const FEW_OBJECTS: f64 = 1000.0;

/// Curves of figures 13 to 16 run over this.
const OBJECTS: &str = "objects";

/// Running times, the shadow-buffer off.
pub fn figure_13(series: &[Series], size: ImageSize) -> Figure {
    let mut curves = Vec::new();
    let mut facts = Vec::new();
    for one in series {
        curves.push(curve(one, "classical", |frame| Some(frame.classical_seconds())));
        curves.push(curve(one, "t-buffer", |frame| Some(frame.t_buffer_seconds(frame.brute_force()))));
        for &other in Contender::OTHERS {
            let name = format!("t-buffer and {}", other.name());
            curves.push(curve(one, &name, |frame| Some(frame.t_buffer_seconds(frame.tester(other)?))));
        }
        let faster = one.frames.iter().filter(|frame| frame.gain(frame.brute_force()) > 1.0).count();
        let what = format!("{}: share of the scenes in which the t-buffer is faster", one.kind.name());
        let share = faster as f64 / one.frames.len().max(1) as f64;
        facts.push(Fact::new(what, share).said("the t-buffer consistently performs better"));
    }
    Figure::new(13, size).with_curves([OBJECTS, "seconds"], curves, facts)
}

/// The gain of the t-buffer, the shadow-buffer off.
pub fn figure_14(series: &[Series], size: ImageSize) -> Figure {
    let mut curves = Vec::new();
    let mut facts = Vec::new();
    for one in series {
        let kind = one.kind.name();
        curves.push(curve(one, "gain", |frame| Some(frame.gain(frame.brute_force()))));
        curves.push(curve(one, "predicted by counted tests", |frame| Some(frame.predicted_gain())));
        curves.push(curve(one, "limit: first hits for nothing", |frame| Some(frame.gain_limit())));
        let Some(frame) = largest_up_to(one, SATURATED_AT) else { continue };
        let at = format!("{kind}: at {} objects", frame.objects);
        let gain = Fact::new(format!("{at} gain"), frame.gain(frame.brute_force()));
        facts.push(match one.kind {
            ObjectKind::Spheres => gain.beside(SATURATED_GAIN).said("saturates near 5000 objects"),
            ObjectKind::Triangles => gain,
        });
        facts.push(Fact::new(format!("{at} gain predicted by counted tests"), frame.predicted_gain()));
        facts.push(Fact::new(format!("{at} the most that the gain can be"), frame.gain_limit()));
        let share = frame.shadow_test_share();
        facts.push(Fact::new(format!("{at} share of shadow rays in the classical tests"), share));
        facts
            .push(Fact::new(format!("{at} shadow rays a pixel"), frame.queries as f64 / frame.pixels as f64));
        let nanoseconds = |seconds: f64, tests: u64| 1e9 * seconds / tests.max(1) as f64;
        let (eye, shadow) = (frame.classical, frame.brute_force());
        let eye = nanoseconds(eye.seconds, eye.tests);
        facts.push(Fact::new(format!("{at} nanoseconds of a test from the eye"), eye));
        let shadow = nanoseconds(shadow.query_seconds, shadow.tests);
        facts.push(Fact::new(format!("{at} nanoseconds of a test of a shadow ray"), shadow));
        let whole = frame.frame_gain(frame.brute_force());
        facts.push(Fact::new(format!("{at} gain of the whole picture with shading"), whole));
    }
    Figure::new(14, size).with_curves([OBJECTS, "gain"], curves, facts)
}

/// The gain with the coarse shadow-buffer.
pub fn figure_15(series: &[Series], size: ImageSize) -> Figure {
    let (curves, facts) = gains(series, &[COARSE_ROWS]);
    Figure::new(15, size).with_curves([OBJECTS, "gain"], curves, facts)
}

/// The gain with the fine shadow-buffer, beside the coarse one.
pub fn figure_16(series: &[Series], size: ImageSize) -> Figure {
    let (curves, mut facts) = gains(series, &[FINE_ROWS, COARSE_ROWS]);
    for one in series {
        let slope =
            |rows: u32| Some(linear(&gain_curve(one, Contender::ShadowBuffer(rows)))?.coefficients[1]);
        if let (Some(fine), Some(coarse)) = (slope(FINE_ROWS), slope(COARSE_ROWS)) {
            let what = format!("{}: growth of the gain against that of figure 15", one.kind.name());
            facts.push(Fact::new(what, fine / coarse).said("still increases but not at the same rate"));
        }
    }
    Figure::new(16, size).with_curves([OBJECTS, "gain"], curves, facts)
}

fn gains(series: &[Series], rows: &[u32]) -> (Vec<Curve>, Vec<Fact>) {
    let mut curves = Vec::new();
    let mut facts = Vec::new();
    for one in series {
        let kind = one.kind.name();
        let buffers = rows.iter().map(|&rows| Contender::ShadowBuffer(rows));
        for contender in buffers.chain(Contender::OTHERS.iter().copied()) {
            let mut curve = gain_curve(one, contender);
            let fit = linear(&curve);
            if let (Some(fit), true) = (&fit, contender == Contender::ShadowBuffer(rows[0])) {
                let r_squared = Fact::new(format!("{kind}: r^2 of a line through the gain"), fit.r_squared);
                facts.push(r_squared.said("approximately linear in the number of objects"));
                let few = places(&curve).into_iter().filter(|(objects, _)| *objects <= FEW_OBJECTS);
                if let Some(fit) = Fit::new(&few.collect::<Vec<_>>(), Degree::Linear) {
                    let what = format!("{kind}: the same up to {FEW_OBJECTS} objects");
                    facts.push(Fact::new(what, fit.r_squared));
                }
                let slope = 1000.0 * fit.coefficients[1];
                facts.push(Fact::new(format!("{kind}: gain for every 1000 objects"), slope));
            }
            curve.fit = fit.as_ref().filter(|_| contender.rows().is_some()).map(FitReport::from);
            curves.push(curve);
        }
        let ([first, ..], [.., last]) = (&one.frames[..], &one.frames[..]) else { continue };
        let times = |seconds: &dyn Fn(&MeasuredFrame) -> Option<f64>| Some(seconds(last)? / seconds(first)?);
        let buffer = Contender::ShadowBuffer(rows[0]);
        let grown = format!("{kind}: time with {} objects against {}", last.objects, first.objects);
        if let Some(ratio) = times(&|frame| Some(frame.t_buffer_seconds(frame.tester(buffer)?))) {
            let fact = Fact::new(format!("{grown} with the shadow-buffer"), ratio);
            facts.push(fact.said("shows very little variation"));
        }
        if let Some(ratio) = times(&|frame| Some(frame.classical_seconds())) {
            let fact = Fact::new(format!("{grown} of the classical tracer"), ratio);
            facts.push(fact.said("linear in scene complexity"));
        }
        if let Some(tester) = last.tester(buffer) {
            let wrong = tester.errors.wrong() as f64 / last.queries.max(1) as f64;
            let what = format!("{kind}: wrong answers of the shadow-buffer with {} objects", last.objects);
            facts.push(Fact::new(what, wrong));
        }
    }
    (curves, facts)
}

/// Running time against the rows of the shadow-buffer.
pub fn figure_17(frame: &MeasuredFrame, size: ImageSize) -> Figure {
    let buffers = || frame.testers.iter().filter_map(|tester| Some((tester, tester.contender.rows()?)));
    let of = |name: &str, seconds: &dyn Fn(&_) -> f64| {
        let points = buffers().map(|(tester, rows)| [f64::from(rows), seconds(tester)]).collect();
        fitted(Curve { name: name.into(), kind: None, points, fit: None }, Degree::Quadratic)
    };
    let mut curves = vec![
        of("t-buffer and shadow-buffer", &|tester| frame.t_buffer_seconds(tester)),
        of("filling the shadow-buffer", &|tester| tester.build_seconds),
        Curve { fit: None, ..of("looking it up", &|tester| tester.query_seconds) },
    ];
    let rows: Vec<u32> = buffers().map(|(_, rows)| rows).collect();
    for &other in Contender::OTHERS {
        if let (Some(tester), [first, .., last]) = (frame.tester(other), &rows[..]) {
            let seconds = frame.t_buffer_seconds(tester);
            let points = [first, last].map(|&rows| [f64::from(rows), seconds]).to_vec();
            let name = format!("t-buffer and {}", other.name());
            curves.push(Curve { name, kind: None, points, fit: None });
        }
    }
    let mut facts = vec![Fact::new("objects", f64::from(frame.objects)).beside(f64::from(OBJECTS_OF_17))];
    if let Some(fit) = &curves[0].fit {
        let correlation = Fact::new("correlation of a quadratic curve with the times", fit.correlation);
        facts.push(correlation.beside(CORRELATION).said("the performance drop is quadratic"));
    }
    if let Some(fit) = &curves[1].fit {
        facts.push(Fact::new("the same for filling alone", fit.correlation));
    }
    Figure::new(17, size).with_curves(["rows", "seconds"], curves, facts)
}

/// Errors against the rows of the shadow-buffer.
pub fn figure_18(judged: &Judged, size: ImageSize) -> Figure {
    let share = |errors: u64| errors as f64 / judged.queries.max(1) as f64;
    let buffers = || judged.testers.iter().filter_map(|tester| Some((tester, tester.contender.rows()?)));
    let of = |name: &str, errors: &dyn Fn(&crate::measure::Errors) -> u64| {
        let points = buffers().map(|(tester, rows)| [f64::from(rows), share(errors(&tester.errors))]);
        Curve { name: name.into(), kind: None, points: points.collect(), fit: None }
    };
    let curves = vec![
        of("wrong", &|errors| errors.wrong()),
        of("false shadow", &|errors| errors.false_shadow),
        of("false light", &|errors| errors.false_light),
    ];
    let wrong_at = |rows: u32| curves[0].points.iter().find(|point| point[0] == f64::from(rows));
    let mut facts: Vec<Fact> = buffers()
        .map(|(tester, rows)| {
            let what = format!("share of wrong answers at {rows} rows");
            Fact::new(what, share(tester.errors.wrong()))
        })
        .collect();
    if let ([first, .., last], Some(middle)) = (&curves[0].points[..], wrong_at(SATURATED_ROWS)) {
        let words = "a large improvement from 400 to 1200";
        facts.push(Fact::new("error at 400 rows against that at 1200", first[1] / middle[1]).said(words));
        let words = "not the same kind of gain from 1200 to 2000";
        facts.push(Fact::new("error at 1200 rows against that at 2000", middle[1] / last[1]).said(words));
    }
    Figure::new(18, size).with_curves(["rows", "share of shadow rays"], curves, facts)
}

fn curve(series: &Series, name: &str, value: impl Fn(&MeasuredFrame) -> Option<f64>) -> Curve {
    let point = |frame: &MeasuredFrame| Some([f64::from(frame.objects), value(frame)?]);
    let points = series.frames.iter().filter_map(point).collect();
    Curve { name: name.into(), kind: Some(series.kind.name()), points, fit: None }
}

fn gain_curve(series: &Series, contender: Contender) -> Curve {
    curve(series, &contender.name(), |frame| Some(frame.gain(frame.tester(contender)?)))
}

fn linear(curve: &Curve) -> Option<Fit> {
    Fit::new(&places(curve), Degree::Linear)
}

fn fitted(curve: Curve, degree: Degree) -> Curve {
    let fit = Fit::new(&places(&curve), degree).as_ref().map(FitReport::from);
    Curve { fit, ..curve }
}

fn places(curve: &Curve) -> Vec<(f64, f64)> {
    curve.points.iter().map(|&[x, y]| (x, y)).collect()
}

fn largest_up_to(series: &Series, objects: u32) -> Option<&MeasuredFrame> {
    series.frames.iter().rev().find(|frame| frame.objects <= objects)
}
