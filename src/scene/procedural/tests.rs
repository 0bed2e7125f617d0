//! What every built-in scene must hold.

use super::{BUILTIN, find};
use crate::error::Error;
use crate::scene::{ImageSize, Scene};

/// A row of the paper's table.
#[derive(Debug, PartialEq, Eq)]
struct Tally {
    objects: usize,
    polygons: u32,
    spheres: usize,
    cylinders: usize,
    quadrics: usize,
    lights: usize,
}

impl Tally {
    fn of(scene: &Scene) -> Tally {
        let count = |wanted: &[&str]| {
            scene.curved.iter().filter(|curved| wanted.contains(&curved.shape.kind())).count()
        };
        let tally = Tally {
            objects: scene.objects.len(),
            polygons: scene.objects.iter().map(|object| object.polygons).sum(),
            spheres: count(&["sphere"]),
            cylinders: count(&["cylinder"]),
            quadrics: count(&["cone", "ellipsoid", "quadric"]),
            lights: scene.lights.len(),
        };
        assert_eq!(tally.spheres + tally.cylinders + tally.quadrics, scene.curved.len());
        tally
    }
}

/// The captions of figures 5 to 11: objects, polygons, spheres, cylinders, quadrics, lights.
const CAPTIONS: [(&str, [usize; 6]); 7] = [
    ("chessboard", [132, 4944, 0, 0, 0, 4]),
    ("house-of-cards", [41, 3286, 0, 0, 0, 5]),
    ("highchair", [33, 6702, 0, 2, 8, 3]),
    ("gazebo", [80, 3222, 0, 0, 0, 8]),
    ("glass-leaved-tree", [768, 6, 256, 0, 511, 3]),
    ("counter-top", [224, 1298, 4, 76, 35, 5]),
    ("kitchen", [224, 1298, 4, 76, 35, 5]),
];

fn built(name: &str) -> Scene {
    find(name).unwrap().build(None).unwrap()
}

#[test]
fn the_environments_have_the_counts_of_the_paper() {
    for (name, [objects, polygons, spheres, cylinders, quadrics, lights]) in CAPTIONS {
        let expected = Tally { objects, polygons: polygons as u32, spheres, cylinders, quadrics, lights };
        let scene = built(name);
        assert_eq!(Tally::of(&scene), expected, "{name}");
        let (width, height) = if name == "kitchen" { (436, 479) } else { (512, 480) };
        assert_eq!(scene.cameras[0].size, Some(ImageSize { width, height }), "{name}");
    }
}

#[test]
fn the_kitchen_is_the_counter_top_from_elsewhere() {
    let (near, far) = (built("counter-top"), built("kitchen"));
    assert_eq!(near.hash(), far.hash());
    assert_ne!(near.cameras, far.cameras);
}

#[test]
fn nothing_is_dropped_and_nothing_is_warned_of() {
    for builtin in BUILTIN {
        let scene = builtin.build(None).unwrap();
        assert_eq!(scene.name, format!("builtin:{}", builtin.name));
        assert_eq!(scene.dropped, Default::default(), "{}", builtin.name);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        assert!(scene.objects.iter().all(|object| object.count + object.curved_count > 0));
    }
}

#[test]
fn names_and_size_factors_that_do_not_exist_are_one_line() {
    let line = |error: Error| {
        assert!(matches!(error, Error::Usage(_)));
        error.to_string()
    };
    assert!(line(find("chess").unwrap_err()).contains("no built-in scene `chess`; there are chessboard, "));
    let error = line(find("gazebo").unwrap().build(Some(3)).unwrap_err());
    assert_eq!(error, "builtin:gazebo: the scene has one size; expected no size factor");
}
