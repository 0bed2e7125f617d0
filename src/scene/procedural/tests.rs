//! What every built-in scene must hold.

use super::{BUILTIN, find, large};
use crate::error::Error;
use crate::scene::formats::{self, limits};
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

#[test]
fn loading_by_name_is_building() {
    let loaded = formats::load("builtin:highchair".as_ref()).unwrap();
    assert_eq!(loaded.hash(), built("highchair").hash());
    let error = formats::load("builtin:nothing".as_ref()).unwrap_err();
    assert!(error.to_string().starts_with("no built-in scene `nothing`"));
}

/// Triangles, curved surfaces, objects and polygons of a scene by its size factor.
fn expected(name: &str, size: u32) -> [u64; 4] {
    let n = u64::from(size);
    let flat = |triangles: u64, objects: u64| [triangles, 0, objects, triangles];
    match name {
        "balls" => {
            let balls = (9u64.pow(size + 1) - 1) / 8;
            [2, balls, balls + 1, 1]
        }
        "gears" => [n.pow(3) * (2 * 142 + 2 * 144) + 2, 0, n.pow(3) + 1, n.pow(3) * 146 + 1],
        "mount" => [2 * 4u64.pow(size), 4, 5, 2 * 4u64.pow(size)],
        "rings" => {
            let rings = n * (n + 1) * (2 * n + 1);
            [2, 10 * rings, rings + 1, 1]
        }
        "teapot" => {
            // Lid and bottom come to a point in four patches each.
            let pot = 64 * n * n - 8 * n;
            [pot + 2 * n * n, 0, 8, pot + n * n]
        }
        "tetra" => [4u64.pow(size), 0, 4u64.pow(size - 1), 4u64.pow(size)],
        "tree" => {
            let branches = 2u64.pow(size + 1) - 1;
            [2, 2 * branches, branches + 1, 1]
        }
        "stacked-spheres" => [0, n, n, 0],
        "stacked-triangles" => [n, 0, n, n],
        "sphereflake" => flat(960 * (9u64.pow(size) - 1) / 8 + 2, 2),
        "terrain" => flat(2 * n * n, 1),
        "hair-ball" => flat(64 * 15 * n + 960 + 2, 3),
        "city" => flat(large::city_triangles(size), n * n + 2),
        "forest" => flat(large::forest_triangles(size), 2 * n * n + 1),
        _ => panic!("{name}"),
    }
}

#[test]
fn the_databases_have_the_published_counts_and_grow_as_described() {
    let published = [7382, 9345, 8196, 8401, 9264, 4096, 8191];
    let databases = BUILTIN.iter().filter_map(|builtin| Some((builtin, builtin.size_factor?)));
    for ((builtin, size), published) in databases.zip(published) {
        for factor in [size.smallest, 2, 3, size.standard] {
            let scene = builtin.build(Some(factor)).unwrap();
            let polygons: u64 = scene.objects.iter().map(|object| u64::from(object.polygons)).sum();
            let counts = [scene.triangles.len(), scene.curved.len(), scene.objects.len()].map(|n| n as u64);
            let [triangles, curved, objects] = counts;
            let found = [triangles, curved, objects, polygons];
            assert_eq!(found, expected(builtin.name, factor), "{} {factor}", builtin.name);
            if factor == size.standard {
                assert_eq!(polygons + curved, published, "{}", builtin.name);
            }
        }
    }
}

#[test]
fn the_large_scenes_have_their_counts_at_every_size() {
    let standard = [
        ("sphereflake", 787_202),
        ("terrain", 980_000),
        ("hair-ball", 999_362),
        ("city", 994_850),
        ("forest", 5_064_032),
    ];
    for (name, triangles) in standard {
        let builtin = find(name).unwrap();
        let size = builtin.size_factor.unwrap();
        for factor in [size.smallest, size.smallest + 1, 3.max(size.smallest)] {
            let scene = builtin.build(Some(factor)).unwrap();
            let counts = [scene.triangles.len(), scene.curved.len(), scene.objects.len()].map(|n| n as u64);
            assert_eq!(counts, expected(name, factor)[..3], "{name} {factor}");
            assert_eq!((scene.lights.len(), scene.cameras.len()), (1, 1));
        }
        assert_eq!(expected(name, size.standard)[0], triangles, "{name}");
    }
}

#[test]
fn the_largest_databases_are_within_the_limits_and_no_larger_ones_are_made() {
    for builtin in BUILTIN {
        let Some(size) = builtin.size_factor else { continue };
        let [triangles, curved, objects, _] = expected(builtin.name, size.largest);
        assert!(triangles <= limits::MAX_TRIANGLES, "{}", builtin.name);
        assert!(curved <= limits::MAX_CURVED && objects <= limits::MAX_OBJECTS, "{}", builtin.name);
        for factor in [size.smallest - 1, size.largest + 1, u32::MAX] {
            let error = builtin.build(Some(factor)).unwrap_err().to_string();
            let line = format!("builtin:{}: expected a size factor from {} to", builtin.name, size.smallest);
            assert!(error.starts_with(&line), "{error}");
        }
    }
}
