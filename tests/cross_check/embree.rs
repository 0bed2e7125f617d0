//! Every mode of Embree over the same queries. Its errors are measured and not forgiven without bound: where
//! arithmetic leaves no doubt, every mode must say what is so.

use crate::cases;
use crate::runner::{Asked, EMBREE_EPSILON, Setting, ask};
use glam::DVec3;
use lightbuffer::embree::{Device, EmbreeMode};
use lightbuffer::geometry::LightPosition;
use lightbuffer::shadow::{Basis, Resolution, TesterEntry, testers};

const SETTING: Setting = Setting::of(Resolution::Cells(1));

/// Embree's testers, whose errors are measured, but for modes that this Embree lacks.
fn measured() -> Vec<&'static TesterEntry> {
    let device = Device::new(1).unwrap();
    let there =
        |entry: &&TesterEntry| entry.name.parse().is_ok_and(|m: EmbreeMode| m.expect_in(&device).is_err());
    let is_embree = |entry: &&TesterEntry| entry.name.starts_with("embree");
    let measured = testers().filter(|entry| entry.basis == Basis::Measured);
    measured.filter(|entry| is_embree(entry) && !there(entry)).collect()
}

#[test]
fn every_mode_is_cross_checked() {
    let streams = Device::new(1).unwrap().has_streams();
    let modes = EmbreeMode::all().filter(|mode| streams || !mode.to_string().contains("stream"));
    let expected: Vec<_> =
        ["embree", "embree-fast"].map(String::from).into_iter().chain(modes.map(|m| m.to_string())).collect();
    assert_eq!(measured().iter().map(|entry| entry.name).collect::<Vec<_>>(), expected);
}

#[test]
fn every_mode_is_right_where_there_is_no_doubt_and_mostly_right_elsewhere() {
    let (mut clear, mut queries) = (0, 0);
    for case in cases::all() {
        let asked = Asked::of(&case);
        let truth = asked.plain_truth();
        let beyond_doubt = beyond_doubt(&asked);
        clear += beyond_doubt.iter().flatten().count();
        queries += truth.len();
        for entry in measured() {
            let answers = ask(entry, &asked, SETTING);
            let wrong = answers.iter().zip(&truth).filter(|(a, t)| a != t).count();
            let (name, asked) = (entry.name, truth.len());
            // A broken oracle gets most answers wrong.
            assert!(wrong * 20 <= asked, "{}: {name} wrong {wrong} of {asked}", case.name);
            let doubtless =
                answers.iter().zip(&beyond_doubt).filter(|(a, c)| c.is_some_and(|c| c != **a)).count();
            assert_eq!(doubtless, 0, "{}: {name} wrong without doubt", case.name);
        }
    }
    // All but those in scenes so far from the origin or so small that floats leave doubt about everything.
    assert!(clear * 5 > queries * 2, "only {clear} of {queries} queries are clear");
}

/// What Embree's segments meet, as far as arithmetic with a wide margin can tell.
fn beyond_doubt(asked: &Asked) -> Vec<Option<bool>> {
    let scene = asked.scene();
    let casts = |t: &u32| scene.objects[scene.triangles[*t as usize].object as usize].shadowing.casts;
    let casting: Vec<u32> = (0..scene.triangles.len() as u32).filter(casts).collect();
    let triangle = |t: &u32| scene.corners(*t).map(|p| p.as_dvec3());
    let corners = || casting.iter().flat_map(triangle);
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    let epsilon = f64::from(EMBREE_EPSILON);
    let diameter = (high - low).length();
    let answer = |light: LightPosition, point: DVec3| {
        let (towards, near, far) = match light {
            LightPosition::At(light) => {
                let way = light.as_dvec3() - point;
                (way.normalize(), epsilon * way.length(), (1.0 - epsilon) * way.length())
            }
            LightPosition::Towards(way) => (way.as_dvec3().normalize(), epsilon * diameter, f64::INFINITY),
        };
        // Nothing is farther away than this.
        let past = (point - low).length() + diameter;
        let (from, to) = (point + near * towards, point + far.min(past) * towards);
        let met: Vec<_> = casting
            .iter()
            // What is crossed may be a hole.
            .map(|t| crosses(from, to, triangle(t)).filter(|met| !met || scene.masked(*t).is_none()))
            .collect();
        let undoubted = met.iter().all(Option::is_some);
        (undoubted || met.contains(&Some(true))).then(|| met.contains(&Some(true)))
    };
    asked.queries().map(|(light, point)| answer(light, point.position)).collect()
}

/// Whether the segment crosses the triangle; `None` if moving its points by some float steps might change that.
fn crosses(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> Option<bool> {
    let points = [from, to, a, b, c];
    let far = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let size = points.iter().map(|p| (*p - from).length()).fold(0.0, f64::max);
    // Some roundings of floats, and as many products that a mode flushes to zero.
    let margin = 32.0 * (f64::from(f32::EPSILON) * far * size * size + f64::from(f32::MIN_POSITIVE));
    let volume = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| (a - d).dot((b - d).cross(c - d));
    let ends = [volume(a, b, c, from), volume(a, b, c, to)];
    let edges = [volume(from, to, a, b), volume(from, to, b, c), volume(from, to, c, a)];
    let apart = |v: &[f64]| v.iter().any(|&x| x > margin) && v.iter().any(|&x| x < -margin);
    let together = |v: &[f64]| v.iter().all(|&x| x > margin) || v.iter().all(|&x| x < -margin);
    if together(&ends) || apart(&edges) {
        Some(false)
    } else if apart(&ends) && together(&edges) {
        Some(true)
    } else {
        None
    }
}
