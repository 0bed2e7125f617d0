//! Meshes that are solids, meshes that are not, and where points are, against integers.

use super::common_points::Facet;
use super::*;
use proptest::prelude::*;
use std::collections::HashMap;

type Mesh = Vec<[Vec3; 3]>;

fn mesh(corners: &[Vec3], triangles: impl IntoIterator<Item = [usize; 3]>) -> Mesh {
    triangles.into_iter().map(|t| t.map(|i| corners[i])).collect()
}

/// Normals point outwards.
fn cuboid(low: Vec3, high: Vec3) -> Mesh {
    let corner =
        |i: usize| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let corners: Vec<_> = (0..8).map(corner).collect();
    mesh(&corners, faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]))
}

/// A unit octahedron whose faces are cut in four as often as said, each corner moved along its own ray.
fn ball(cuts: u32, mut distance: impl FnMut() -> f32) -> Mesh {
    let signs = [1.0, -1.0];
    let octants = signs.iter().flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| [x, y, z])));
    let mut triangles: Mesh = octants
        .map(|[x, y, z]| {
            let [a, b, c] = [Vec3::X * x, Vec3::Y * y, Vec3::Z * z];
            if x * y * z > 0.0 { [a, b, c] } else { [a, c, b] }
        })
        .collect();
    for _ in 0..cuts {
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [(a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let mut moved = HashMap::new();
    let mut place = |p: Vec3| *moved.entry(key(p)).or_insert_with(|| p.normalize() * distance());
    triangles.into_iter().map(|t| t.map(&mut place)).collect()
}

fn sphere() -> Mesh {
    ball(2, || 1.0)
}

/// A torus around z.
fn torus(around: usize, across: usize, [outer, inner]: [f32; 2]) -> Mesh {
    let turn = |i: usize, n: usize| 2.0 * std::f32::consts::PI * (i % n) as f32 / n as f32;
    let corner = |i: usize, j: usize| {
        let (u, v) = (turn(i, around), turn(j, across));
        let r = outer + inner * v.cos();
        Vec3::new(r * u.cos(), r * u.sin(), inner * v.sin())
    };
    (0..around)
        .flat_map(|i| (0..across).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

fn turned_inwards(triangles: &Mesh) -> Mesh {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// The only part.
fn only(triangles: &Mesh) -> Result<Solid, Refusal> {
    let mut parts = recognise(triangles);
    assert_eq!(parts.solids.len(), 1);
    assert!(parts.of.iter().all(|&part| part == 0));
    parts.solids.remove(0)
}

fn solids() -> Vec<Mesh> {
    vec![
        cuboid(Vec3::ZERO, Vec3::ONE),
        cuboid(Vec3::splat(-1e-30), Vec3::new(3.0, 1e-30, 1e30)),
        ball(0, || 1.0),
        sphere(),
        torus(7, 5, [2.0, 0.75]),
        torus(40, 24, [1.0, 0.999]),
    ]
}

#[test]
fn either_way_round_a_closed_mesh_is_a_solid() {
    for triangles in solids() {
        let (outwards, inwards) = (only(&triangles).unwrap(), only(&turned_inwards(&triangles)).unwrap());
        assert_eq!([outwards.outer_side(), inwards.outer_side()], [Sign::Negative, Sign::Positive]);
        assert_eq!(volume(&triangles), exact_volume(&triangles, Vec3::X).sign());
        for solid in [outwards, inwards] {
            assert!(solid.is_outside(LightPosition::At(Vec3::splat(-7.0))));
            assert!(solid.is_outside(LightPosition::Towards(Vec3::X)));
        }
    }
}

#[test]
fn a_volume_that_f64_cannot_tell_is_exact() {
    // A tetrahedron as high as the smallest float, far away.
    let far = Vec3::new(3e38, -3e38, 0.0);
    let [a, b, c] = [far, far + Vec3::X * 1e32, far + Vec3::Y * 1e32];
    let d = a + Vec3::Z * f32::from_bits(1);
    let tetrahedron = vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
    assert_eq!(only(&tetrahedron).unwrap().outer_side(), Sign::Negative);
}

#[test]
fn meshes_that_do_not_close_are_refused() {
    for triangles in solids() {
        for t in [0, triangles.len() / 2, triangles.len() - 1] {
            let changed = |change: &dyn Fn(&mut Mesh)| {
                let mut changed = triangles.clone();
                change(&mut changed);
                only(&changed)
            };
            let [a, b, c] = triangles[t];
            assert_eq!(changed(&|m| m.retain(|&other| other != [a, b, c])), Err(Refusal::Open));
            assert_eq!(changed(&|m| m.push(m[t])), Err(Refusal::Open));
            assert_eq!(changed(&|m| m.push([a, c, b])), Err(Refusal::Open));
            assert_eq!(changed(&|m| m[t] = [a, c, b]), Err(Refusal::Turned));
            let beside = |x: f32| if x == 0.0 { f32::from_bits(1) } else { x.next_up() };
            assert_eq!(changed(&|m| m[t] = [Vec3::new(beside(a.x), a.y, a.z), b, c]), Err(Refusal::Open));
        }
    }
}

#[test]
fn meshes_that_cross_themselves_are_refused() {
    let moved = |triangles: &Mesh, from: Vec3, to: Vec3| -> Mesh {
        triangles.iter().map(|t| t.map(|p| if p == from { to } else { p })).collect()
    };
    let (ball, ring) = (sphere(), torus(7, 5, [2.0, 0.75]));
    let opposite = ring[0][0] * -1.5;
    for crossing in [
        moved(&ball, Vec3::X, Vec3::new(-2.0, 0.01, 0.02)),
        // Onto a face, an edge and a corner from inside; the last is a corner where two fans touch.
        moved(&ball, Vec3::X, ball[0].iter().fold(Vec3::ZERO, |s, p| s - p * (1.0 / 3.0)) * 1.0001),
        moved(&ring, ring[0][0], opposite),
        // Flat: two triangles on each other.
        vec![[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::ZERO, Vec3::Y, Vec3::X]],
        // Four in a plane, cut along one diagonal above and along the other below.
        {
            let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
            vec![[a, b, c], [a, c, d], [a, d, b], [b, d, c]]
        },
        // A fifth triangle's edge along the top of a box.
        moved(&cuboid(Vec3::ZERO, Vec3::ONE), Vec3::ONE, Vec3::new(-0.5, -0.5, 1.0)),
    ] {
        assert_eq!(only(&crossing), Err(Refusal::Crossing));
    }
    let edge_on_face = moved(&ball, Vec3::X, Vec3::new(-1.0, 0.25, 0.0));
    assert_eq!(only(&edge_on_face), Err(Refusal::Crossing));
}

#[test]
fn fans_that_touch_in_a_corner_are_no_harm() {
    // One corner of a ball is pulled through its inside to the opposite corner: the dent ends there.
    let dented: Mesh =
        sphere().into_iter().map(|t| t.map(|p| if p == Vec3::X { Vec3::NEG_X } else { p })).collect();
    let solid = only(&dented).unwrap();
    assert_eq!(solid.outer_side(), Sign::Negative);
    let is_outside = |x: f32, y: f32, z: f32| solid.is_outside(LightPosition::At(Vec3::new(x, y, z)));
    assert!(is_outside(0.3, 0.01, 0.02) && is_outside(-0.9, 0.001, 0.002));
    assert!(!is_outside(0.0, 0.8, 0.1) && !is_outside(-1.0, 0.0, 0.0));
}

#[test]
fn parts_stand_for_themselves() {
    let unit = cuboid(Vec3::ZERO, Vec3::ONE);
    let moved = |by: Vec3, scale: f32| -> Mesh { unit.iter().map(|t| t.map(|p| p * scale + by)).collect() };
    let with = |other: Mesh| recognise(&[unit.clone(), other].concat());
    let outer_sides = |parts: &Parts| -> Vec<_> {
        parts.solids.iter().map(|s| s.as_ref().map(Solid::outer_side).map_err(|r| *r)).collect()
    };
    let outwards = Ok(Sign::Negative);
    // Apart, touching in a corner, crossing, one in the other.
    for other in [moved(Vec3::X * 2.0, 1.0), moved(Vec3::ONE, 1.0), moved(Vec3::splat(0.5), 1.0)] {
        assert_eq!(outer_sides(&with(other)), [outwards; 2]);
    }
    let cavity = with(turned_inwards(&moved(Vec3::splat(0.25), 0.5)));
    assert_eq!(outer_sides(&cavity), [outwards, Ok(Sign::Positive)]);
    assert_eq!((cavity.of[0], cavity.of[12]), (0, 1));
    let [shell, hollow] = &cavity.solids[..] else { panic!() };
    let is_outside = |solid: &Result<Solid, Refusal>, x: f32| {
        solid.as_ref().unwrap().is_outside(LightPosition::At(Vec3::new(x, 0.4, 0.45)))
    };
    assert_eq!([0.1, 0.5, 2.0].map(|x| is_outside(shell, x)), [false, false, true]);
    assert_eq!([0.1, 0.5, 2.0].map(|x| is_outside(hollow, x)), [true, false, true]);
    // A common edge is one of four triangles.
    assert_eq!(outer_sides(&with(moved(Vec3::new(1.0, 1.0, 0.0), 1.0))), [Err(Refusal::Open)]);
    // An open part takes nothing from the others.
    let flap = vec![[Vec3::splat(5.0), Vec3::X, Vec3::Y * 9.0]];
    assert_eq!(outer_sides(&with(flap)), [outwards, Err(Refusal::Open)]);
}

#[test]
fn what_rays_cannot_tell_is_not_outside() {
    // Every ray from the light hits two triangles first, in one point and with different sides.
    let [a, b, c] = [Vec3::new(-1.0, -1.0, 2.0), Vec3::new(1.0, -1.0, 2.0), Vec3::new(0.0, 1.0, 2.0)];
    let bounds = (Vec3::splat(-9.0), Vec3::splat(9.0));
    for triangles in [[[a, b, c], [a, c, b]], [[a, c, b], [a, b, c]]] {
        for outer_side in [Sign::Negative, Sign::Positive] {
            assert!(!outside::is_outside(Vec3::ZERO, &triangles, bounds, outer_side));
            assert!(outside::is_outside(Vec3::X * 9.5, &triangles, bounds, outer_side));
        }
    }
}

#[test]
fn a_crowd_around_one_corner_is_given_up() {
    let flat: Vec<_> = (0..3000).map(|_| Boxed { low: Vec3::ZERO, high: Vec3::ONE }).collect();
    assert_eq!(pairs::any(&flat, 1_000_000, |_, _| false), Search::GivenUp);
    assert_eq!(pairs::any(&flat[..100], 1_000_000, |_, _| false), Search::Nothing);
    assert_eq!(pairs::any(&flat, 1_000_000, |i, j| (i, j) == (1, 2999)), Search::Found);
}

type Integers = [i64; 3];

fn minus(a: Integers, b: Integers) -> Integers {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn cross(a: Integers, b: Integers) -> Integers {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Integers, b: Integers) -> i128 {
    (0..3).map(|k| i128::from(a[k]) * i128::from(b[k])).sum()
}

fn floats(p: Integers) -> Vec3 {
    Vec3::from_array(p.map(|x| x as f32))
}

/// Whether some plane strictly separates two triangles: across the normal of one, along an edge of each, or
/// in a common plane along an edge of one.
fn are_separate(s: [Integers; 3], t: [Integers; 3]) -> bool {
    let edges = |t: [Integers; 3]| [minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])];
    let normals = [s, t].map(|t| cross(edges(t)[0], edges(t)[1]));
    let across = edges(s).into_iter().flat_map(|e| edges(t).map(|f| cross(e, f)));
    // Both normals for both: one of the two may be a segment, which has none.
    let edges_of_both = edges(s).into_iter().chain(edges(t));
    let within = edges_of_both.flat_map(|e| normals.map(|n| cross(e, n)));
    normals.into_iter().chain(across).chain(within).any(|axis| {
        let range = |t: [Integers; 3]| {
            let values = t.map(|p| dot(p, axis));
            (values.into_iter().min().unwrap(), values.into_iter().max().unwrap())
        };
        range(s).1 < range(t).0 || range(t).1 < range(s).0
    })
}

/// How often a triangle mesh winds around a point off it, from the crossings of one ray; `None` if the ray
/// meets an edge or the point is on the mesh.
fn winding(point: Integers, triangles: &[[Integers; 3]], ray: Integers) -> Option<i32> {
    let mut winding = 0;
    for &corners in triangles {
        let [a, b, c] = corners.map(|p| minus(p, point));
        let sides = [dot(ray, cross(a, b)), dot(ray, cross(b, c)), dot(ray, cross(c, a))].map(i128::signum);
        let volume = dot(a, cross(b, c)).signum();
        let is_missed = sides.contains(&1) && sides.contains(&-1);
        if !is_missed && (sides.contains(&0) || volume == 0) {
            return None;
        }
        // The ray passes through it forwards if all agree: it leaves where normals point along it.
        if !is_missed && sides[0] as i128 == volume {
            winding += volume as i32;
        }
    }
    Some(winding)
}

fn any_winding(point: Integers, triangles: &[[Integers; 3]]) -> Option<i32> {
    let rays = [[10_007, 331, 7], [-5, 9001, 77], [13, -17, 8009], [-7001, -911, 3001]];
    rays.into_iter().find_map(|ray| winding(point, triangles, ray))
}

fn integers(triangles: &Mesh) -> Vec<[Integers; 3]> {
    triangles.iter().map(|t| t.map(|p| p.to_array().map(|x| x as i64))).collect()
}

fn point(bound: i64) -> impl Strategy<Value = Integers> {
    prop::array::uniform3(-bound..=bound)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn common_points_of_triangles_equal_integers(s in prop::array::uniform3(point(3)), t in prop::array::uniform3(point(3))) {
        let area = |t: [Integers; 3]| cross(minus(t[1], t[0]), minus(t[2], t[0])) != [0; 3];
        prop_assume!(area(s) && area(t));
        let facet = |t: [Integers; 3], first: u32| Facet { corners: t.map(floats), numbers: [first, first + 1, first + 2] };
        // Corners keep numbers of their own, even where they are at the same place: all common points count.
        let (s3, t3) = (facet(s, 0), facet(t, 3));
        prop_assert_eq!(s3.meets_beyond_shared(&t3), !are_separate(s, t));
        prop_assert_eq!(t3.meets_beyond_shared(&s3), !are_separate(s, t));
    }

    #[test]
    fn what_lies_beyond_a_common_corner_equals_integers(a in point(3), others in prop::array::uniform4(point(3))) {
        let [b, c, d, e] = others;
        let area = |b: Integers, c: Integers| cross(minus(b, a), minus(c, a)) != [0; 3];
        prop_assume!(area(b, c) && area(d, e));
        let facet = |b, c, n: u32| Facet { corners: [a, b, c].map(floats), numbers: [0, n, n + 1] };
        // The corner moved out of the second triangle, towards its middle, by a little of coordinates that are
        // a thousand times as large: what only touched there no longer does.
        let large = |p: Integers| p.map(|x| x * 1000);
        let towards = [0, 1, 2].map(|k| (d[k] + e[k] - 2 * a[k]) * 3);
        let away = [0, 1, 2].map(|k| 1000 * a[k] + towards[k]);
        let meets = facet(b, c, 1).meets_beyond_shared(&facet(d, e, 3));
        // The segment between the two outer corners of each against the other decides.
        let direct = !are_separate([b, b, c], [a, d, e]) || !are_separate([d, d, e], [a, b, c]);
        prop_assert_eq!(meets, direct);
        if !are_separate([large(a), large(b), large(c)], [away, large(d), large(e)]) {
            prop_assert!(meets);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]
    #[test]
    fn balls_with_corners_in_and_out_are_solids(distances in prop::collection::vec(0.3f32..1.5, 66)) {
        let mut next = distances.into_iter();
        let triangles = ball(2, || next.next().unwrap());
        prop_assert_eq!(only(&triangles).map(|s| s.outer_side()), Ok(Sign::Negative));
    }

    /// Balls and rings on a coarse grid, where many points lie in planes of faces, and on them.
    #[test]
    fn outside_equals_integers(
        distances in prop::collection::vec(3.0f32..9.0, 18),
        is_ring in any::<bool>(),
        points in prop::collection::vec(point(9), 40),
    ) {
        let mut next = distances.into_iter();
        let triangles = if is_ring { torus(6, 4, [6.0, 3.0]) } else { ball(1, || next.next().unwrap()) };
        let triangles: Mesh = triangles.into_iter().map(|t| t.map(Vec3::round)).collect();
        let solid = recognise(&triangles).solids.remove(0);
        prop_assert!(solid.is_ok() || !is_ring);
        let Ok(solid) = solid else { return Ok(()) };
        let exact = integers(&triangles);
        let off_all_planes = |p: Integers| exact.iter().all(|&[a, b, c]| dot(minus(a, p), cross(minus(b, p), minus(c, p))) != 0);
        for p in points {
            let winding = any_winding(p, &exact);
            let answer = solid.is_outside(LightPosition::At(floats(p)));
            if answer {
                prop_assert_eq!(winding, Some(0), "{:?}", p);
            } else if off_all_planes(p) {
                prop_assert_eq!(winding, Some(1), "{:?}", p);
            }
        }
    }
}

#[test]
fn the_bound_of_a_volume_is_what_is_derived() {
    // The absolute terms of the determinant are 1 * 320, 2 * 238 and 3 * 176.
    let one = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(5.0, 7.0, 11.0), Vec3::new(13.0, 17.0, 19.0)];
    for (triangles, count) in [(vec![one], 1.0), (vec![one; 3], 3.0)] {
        let (sum, bound) = rounded_volume(&triangles, Vec3::ZERO);
        assert_eq!(sum, 24.0 * count);
        assert!(
            (bound / (2.0 * (count + 8.0) * 1324.0 * count * crate::geometry::ROUNDOFF) - 1.0).abs() < 1e-9
        );
        let origin = Vec3::new(-2.0, 4.0, 8.0);
        let moved: Vec<_> = triangles.iter().map(|t| t.map(|p| p + origin)).collect();
        assert_eq!(rounded_volume(&moved, origin), (sum, bound));
    }
}

#[test]
fn triangles_in_one_plane_cross_unless_their_common_edge_parts_them() {
    let flat = [[0.0, 0.0], [4.0, 0.0], [1.0, 3.0], [1.0, -3.0], [2.0, 2.0]];
    for axis in 0..3 {
        let corner = |i: usize| {
            let mut p = [flat[i][0], flat[i][1], 7.0];
            p.rotate_right(axis);
            Vec3::from(p)
        };
        let facet = |t: [usize; 3]| Facet { corners: t.map(corner), numbers: t.map(|i| i as u32) };
        let meet = |a: [usize; 3], b: [usize; 3]| facet(a).meets_beyond_shared(&facet(b));
        assert!(!meet([0, 1, 2], [1, 0, 3]) && !meet([1, 2, 0], [0, 1, 3]), "axis {axis}");
        assert!(meet([0, 1, 2], [1, 0, 4]) && meet([2, 0, 1], [4, 0, 1]), "axis {axis}");
    }
}

#[test]
fn parts_of_more_triangles_than_that_are_not_examined() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let facets = vec![Facet { corners, numbers: [0, 1, 2] }; MOST_TRIANGLES + 1];
    assert_eq!(Solid::of_closed(&facets).unwrap_err(), Refusal::TooLarge);
    // As many as that are: these lie on each other.
    assert_eq!(Solid::of_closed(&facets[1..]).unwrap_err(), Refusal::Crossing);
}
