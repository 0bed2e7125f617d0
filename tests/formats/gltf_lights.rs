//! Lights of `KHR_lights_punctual`.

use crate::fixtures::{Folder, triangle};
use glam::Vec3;
use lightbuffer::scene::{Cone, DirectionalLight, Emitter, Falloff, Scene, formats};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};

/// The triangle and a node for each pair of a light and the node's own entries.
fn shine(lights: &[(Value, Value)]) -> Scene {
    let mut document = triangle();
    let entries: Vec<&Value> = lights.iter().map(|(light, _)| light).collect();
    document["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    document["extensions"]["KHR_lights_punctual"]["lights"] = json!(entries);
    for (index, (_, node)) in lights.iter().enumerate() {
        let mut node = node.clone();
        node["extensions"]["KHR_lights_punctual"]["light"] = json!(index);
        document["nodes"].as_array_mut().unwrap().push(node);
    }
    document["scenes"][0]["nodes"] = json!((0..=lights.len()).collect::<Vec<_>>());
    let folder = Folder::new();
    let scene = formats::load(&folder.write("test.gltf", document.to_string())).unwrap();
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

#[test]
fn point_lights() {
    let lamp = json!({ "type": "point", "name": "lamp", "color": [1, 0.5, 0], "intensity": 8, "range": 20 });
    let scene = shine(&[
        (lamp.clone(), json!({ "translation": [1, 0, 0] })),
        (lamp, json!({ "translation": [2, 0, 0] })),
        (json!({ "type": "point" }), json!({ "translation": [4, 0, 0] })),
    ]);
    let found: Vec<_> =
        scene.lights.iter().map(|l| (l.name.as_str(), l.position().homogeneous().0.x)).collect();
    assert_eq!(found, [("lamp", 1.0), ("lamp-2", 2.0), ("light-2", 4.0)]);
    assert_eq!(scene.lights[0].strength(), [8.0, 4.0, 0.0]);
    let falloff = |light: usize| match &scene.lights[light].emitter {
        Emitter::Point(light) => light.falloff,
        other => panic!("{other:?}"),
    };
    assert_eq!(falloff(0), Falloff::Range(20.0));
    assert_eq!((scene.lights[2].strength(), falloff(2)), ([1.0; 3], Falloff::InverseSquare));
}

#[test]
fn directional_lights_come_from_plus_z_of_their_node() {
    let sun = json!({ "type": "directional", "color": [1, 0.5, 0.25], "intensity": 3 });
    let matrix = json!([1, 0, 0, 0, 0, 1, 0, 0, 0.1, 0.2, 3, 0, 7, 8, 9, 1]);
    let scene = shine(&[
        (sun.clone(), json!({ "name": "sun", "matrix": matrix })),
        // A quarter turn about x and a scale, which stays in the length.
        (sun, json!({ "rotation": [-FRAC_1_SQRT_2, 0, 0, FRAC_1_SQRT_2], "scale": [1, 1, 2] })),
    ]);
    let emitter = |light: usize| match &scene.lights[light].emitter {
        Emitter::Directional(light) => light.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(scene.lights[0].name, "sun");
    let irradiance = [3.0, 1.5, 0.75];
    // Rounded once from what the file says.
    assert_eq!(emitter(0), DirectionalLight { towards: Vec3::new(0.1, 0.2, 3.0), irradiance });
    assert!((emitter(1).towards - Vec3::new(0.0, 2.0, 0.0)).length() < 1e-6);
}

#[test]
fn spot_lights_look_along_minus_z_into_a_cone() {
    let spot = |inner: Option<f64>, outer: Option<f64>| json!({ "type": "spot", "intensity": 2, "range": 5, "spot": { "innerConeAngle": inner, "outerConeAngle": outer } });
    let node = json!({ "translation": [1, 2, 3], "scale": [2, 2, 2] });
    let right_angle_of_f32 = f64::from(std::f32::consts::FRAC_PI_2);
    let angles = [
        (None, None),
        (Some(0.25), Some(0.5)),
        (Some(0.0), Some(FRAC_PI_2)),
        (None, Some(right_angle_of_f32)),
        (Some(0.5), Some(0.5f64.next_up())),
    ];
    let mut lights: Vec<_> =
        angles.iter().map(|&(inner, outer)| (spot(inner, outer), node.clone())).collect();
    lights.push((json!({ "type": "spot" }), node.clone()));
    let scene = shine(&lights);
    let cones: Vec<Cone> = scene.lights.iter().map(|light| *light.cone().unwrap()).collect();
    assert!(cones.iter().all(|cone| cone.axis == Vec3::new(0.0, 0.0, -2.0)));
    let cos = |angle: f64| libm::cos(angle) as f32;
    let cosines: Vec<_> = cones.iter().map(|cone| (cone.cos_inner, cone.cos_outer)).collect();
    assert_eq!(cosines[0], (1.0, cos(FRAC_PI_4)));
    assert_eq!(cosines[1], (cos(0.25), cos(0.5)));
    assert_eq!(cosines[2], (1.0, cos(FRAC_PI_2)));
    // Rounded up by an exporter the angle is obtuse, and its cosine below 0.
    assert_eq!(cosines[3], (1.0, 0.0));
    assert_eq!(cosines[4], (cos(0.5).next_up(), cos(0.5)));
    assert_eq!(cosines[5], cosines[0]);
    match &scene.lights[0].emitter {
        Emitter::Spot(light) => {
            assert_eq!(light.point.position, Vec3::new(1.0, 2.0, 3.0));
            assert_eq!((light.point.intensity, light.point.falloff), ([2.0; 3], Falloff::Range(5.0)));
        }
        other => panic!("{other:?}"),
    }
}
