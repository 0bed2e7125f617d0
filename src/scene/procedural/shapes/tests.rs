//! Shapes are closed, look outwards, and have the polygons that their descriptions promise.

use super::*;
use glam::DVec3;
use std::f64::consts::TAU;

#[test]
fn every_shape_is_closed_and_has_the_polygons_it_promises() {
    let section = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.4], [0.0, 0.4]];
    let profile = [[1.0, 0.0], [0.5, 1.0], [0.7, 2.0]];
    let ring = [[1.2, 0.0], [1.2, 0.3], [1.0, 0.3], [1.0, 0.0]];
    let hexagon = circle(1.0, 6, 0.1);
    let path = |closing: Closing| {
        let last = if closing == Closing::Loop { 8 } else { 7 };
        let point = |i: usize| {
            let (sin, cos) = libm::sincos(TAU * i as f64 / 8.0);
            (DVec3::new(cos, 0.0, sin), 0.2)
        };
        tube(&(0..last).map(point).collect::<Vec<_>>(), 5, closing)
    };
    for (name, mesh, polygons) in [
        ("box", cuboid([0.0; 3], [1.0, 2.0, 3.0]), 6),
        ("frame", mitred_frame([2.0, 1.0], &section), 16),
        ("prism", prism(&hexagon, 0.0, 1.0), 8),
        ("bevelled", bevelled_prism(&hexagon, &[[0.0, 0.9], [0.1, 1.0], [1.0, 0.8]]), 14),
        ("card", prism(&rounded_rectangle([1.0, 0.7], 0.1, 20), 0.0, 0.01), 82),
        ("flat lathe", lathe(&profile, 12, Caps::Flat), 26),
        ("pointed lathe", lathe(&profile, 12, Caps::Pointed { tip: 3.0 }), 37),
        ("turned ring", turned_ring(&ring, 10), 40),
        ("loop", path(Closing::Loop), 40),
        ("arc", path(Closing::Capped), 32),
    ] {
        assert!(mesh.is_closed(), "{name}");
        assert_eq!(mesh.faces.len(), polygons, "{name}");
        let mirrored = glam::DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let moved = mirrored * moved(3.0, -1.0, 2.0) * turned_x(0.4) * turned_y(1.3) * turned_z(-0.7);
        let placed = mesh.placed(&moved);
        assert!(placed.is_closed(), "{name} mirrored");
        assert!((placed.volume() - mesh.volume()).abs() < 1e-9, "{name}");
    }
}

#[test]
fn what_is_put_between_two_points_reaches_from_one_to_the_other() {
    let (from, to) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 5.0, 2.0));
    let transform = along(from, to, 2.0);
    assert!((transform.transform_point3(DVec3::ZERO) - from).length() < 1e-12);
    assert!((transform.transform_point3(DVec3::Y * 2.0) - to).length() < 1e-12);
    assert!(transform.matrix3.determinant() > 0.0);
}

#[test]
fn smooth_shapes_have_normals_and_edged_ones_none() {
    let edged = cuboid([0.0; 3], [1.0; 3]).into_object("box").unwrap();
    assert!(edged.normals.is_none());
    assert_eq!((edged.polygons, edged.triangles.len()), (Some(6), 12));
    let round = prism(&circle(1.0, 24, 0.0), 0.0, 1.0).into_object("column").unwrap();
    let normals = round.normals.unwrap();
    assert_eq!(normals.corners.len(), round.triangles.len());
    // Around the wall they point away from the axis, at the ends along it.
    for (triangle, corners) in round.triangles.iter().zip(&normals.corners) {
        for (&vertex, &corner) in triangle.iter().zip(corners) {
            let (place, normal) = (round.positions[vertex as usize], normals.normals[corner as usize]);
            let outwards = glam::Vec3::new(place.x, 0.0, place.z);
            assert!(normal.y.abs() > 0.999 || (normal - outwards).length() < 1e-5, "{normal}");
        }
    }
}
