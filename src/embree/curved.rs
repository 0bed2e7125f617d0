//! Curved surfaces as the shim takes them.

use std::fmt;

use glam::{DMat3, Vec3};

use super::ffi;
use super::scene::LARGEST_COORDINATE;
use crate::geometry::curved::Shape;
use crate::{Error, Result};

/// Where a plane without end ends for Embree, which asks only about rays that meet its box: just inside the range of
/// coordinates, so that no ray misses it there that Embree can be asked about.
const END_OF_PLANES: f32 = 1.8e18;

/// The curved surfaces of a scene.
#[derive(Default)]
pub(super) struct CurvedSurfaces(Vec<ffi::LbCurved>);

impl CurvedSurfaces {
    /// Light passes through those for which `transparent` says so, and through none if that is empty.
    ///
    /// # Errors
    ///
    /// A surface that reaches beyond Embree's range, which would be left out silently.
    pub(super) fn new(shapes: &[Shape], transparent: &[bool]) -> Result<CurvedSurfaces> {
        let passes = |index: usize| transparent.get(index).copied().unwrap_or(false);
        let surface =
            |(index, shape)| surface(shape, passes(index)).ok_or_else(|| out_of_range(index, shape));
        shapes.iter().enumerate().map(surface).collect::<Result<_>>().map(CurvedSurfaces)
    }

    pub(super) fn as_slice(&self) -> &[ffi::LbCurved] {
        &self.0
    }
}

impl fmt::Debug for CurvedSurfaces {
    /// What a surface's numbers mean is known with its kind alone, so their number has to do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "CurvedSurfaces({})", self.0.len())
    }
}

fn out_of_range(index: usize, shape: &Shape) -> Error {
    Error::Embree(format!(
        "curved surface {index}, a {}, reaches beyond coordinates of 1.844e18, which Embree needs",
        shape.kind()
    ))
}

/// `None` if it is beyond Embree's range.
fn surface(shape: &Shape, transparent: bool) -> Option<ffi::LbCurved> {
    let (low, high) = bounds(shape);
    // Written so that NaN fails.
    let fits = |coordinate: f32| coordinate.abs() < LARGEST_COORDINATE;
    let (kind, anchor, surface) = numbers(shape);
    let is_there = low.to_array().into_iter().chain(high.to_array()).all(fits);
    (is_there && anchor.to_array().into_iter().all(fits)).then(|| ffi::LbCurved {
        kind,
        transparent: transparent.into(),
        low: low.to_array(),
        high: high.to_array(),
        anchor: doubles(anchor),
        surface,
    })
}

/// The kind, the anchor and the other numbers.
fn numbers(shape: &Shape) -> (u32, Vec3, ffi::LbSurface) {
    match *shape {
        Shape::Sphere(s) => {
            let sphere = ffi::LbSphere { radius: s.radius.into() };
            (ffi::LB_SPHERE, s.centre, ffi::LbSurface { sphere })
        }
        Shape::Ellipsoid(e) => {
            let [a, b, c] = e.axes.map(Vec3::as_dvec3);
            let to_unit = DMat3::from_cols(a, b, c).inverse().transpose().to_cols_array_2d();
            (ffi::LB_ELLIPSOID, e.centre, ffi::LbSurface { ellipsoid: ffi::LbEllipsoid { to_unit } })
        }
        Shape::Cone(c) => {
            let cone = ffi::LbCone {
                axis: (c.apex.as_dvec3() - c.base.as_dvec3()).to_array(),
                base_radius: c.base_radius.into(),
                growth: f64::from(c.apex_radius) - f64::from(c.base_radius),
            };
            (ffi::LB_CONE, c.base, ffi::LbSurface { cone })
        }
        Shape::Disc(d) => {
            let disc = ffi::LbDisc { normal: doubles(d.normal), radius: d.radius.into() };
            (ffi::LB_DISC, d.centre, ffi::LbSurface { disc })
        }
        Shape::Plane(p) => {
            (ffi::LB_PLANE, p.point, ffi::LbSurface { plane: ffi::LbPlane { normal: doubles(p.normal) } })
        }
        Shape::Quadric(q) => {
            let quadric = ffi::LbQuadric {
                second: q.second.map(f64::from),
                first: doubles(q.first),
                constant: q.constant.into(),
            };
            (ffi::LB_QUADRIC, q.reference, ffi::LbSurface { quadric })
        }
    }
}

/// A closed box around all of a surface that Embree is asked about.
fn bounds(shape: &Shape) -> (Vec3, Vec3) {
    let Shape::Plane(plane) = shape else {
        return shape.bounds().expect("everything but a plane has an end");
    };
    // A plane along the coordinates has a flat box, which rays pass by. Most floors are such.
    let across = |axis: usize| (0..3).all(|other| other == axis || plane.normal[other] == 0.0);
    let end = |sign: f32| {
        let coordinate = |axis: usize| if across(axis) { plane.point[axis] } else { sign * END_OF_PLANES };
        Vec3::from_array([0, 1, 2].map(coordinate))
    };
    (end(-1.0), end(1.0))
}

fn doubles(v: Vec3) -> [f64; 3] {
    v.as_dvec3().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::{Disc, Ellipsoid, InfinitePlane};

    fn plane(point: Vec3, normal: Vec3) -> Shape {
        Shape::Plane(InfinitePlane { point, normal })
    }

    #[test]
    fn planes_along_the_coordinates_are_flat_and_others_fill_the_range() {
        let point = Vec3::new(1.0, -2.0, 3.0);
        let far = END_OF_PLANES;
        let (low, high) = bounds(&plane(point, Vec3::new(0.0, -5.0, 0.0)));
        assert_eq!((low, high), (Vec3::new(-far, -2.0, -far), Vec3::new(far, -2.0, far)));
        let (low, high) = bounds(&plane(point, Vec3::new(1e-30, 1.0, 0.0)));
        assert_eq!((low, high), (Vec3::splat(-far), Vec3::splat(far)));
    }

    #[test]
    fn an_ellipsoid_is_taken_to_the_unit_sphere() {
        let axes = [Vec3::new(2.0, 1.0, 0.0), Vec3::new(0.0, 3.0, 1.0), Vec3::new(1.0, 0.0, 5.0)];
        let shape = Shape::Ellipsoid(Ellipsoid { centre: Vec3::ONE, axes });
        let curved = surface(&shape, true).unwrap();
        assert_eq!((curved.kind, curved.transparent, curved.anchor), (ffi::LB_ELLIPSOID, 1, [1.0; 3]));
        // SAFETY: the member that an ellipsoid has.
        let rows = unsafe { curved.surface.ellipsoid }.to_unit;
        for (k, axis) in axes.into_iter().enumerate() {
            let image = rows.map(|row| glam::DVec3::from_array(row).dot(axis.as_dvec3()));
            let unit = [0, 1, 2].map(|i| if i == k { 1.0 } else { 0.0 });
            assert!(image.iter().zip(unit).all(|(a, b): (&f64, f64)| (a - b).abs() < 1e-15), "{image:?}");
        }
    }

    #[test]
    fn what_reaches_beyond_the_range_is_refused() {
        let disc = |radius| Shape::Disc(Disc { centre: Vec3::ZERO, normal: Vec3::Z, radius });
        let sphere = |x| Shape::sphere(Vec3::new(x, 0.0, 0.0), 1.0);
        for shape in [disc(1e19), sphere(2e18), plane(Vec3::splat(-3e20), Vec3::ONE)] {
            let error = CurvedSurfaces::new(&[sphere(0.0), shape], &[]).unwrap_err().to_string();
            assert!(error.contains("curved surface 1") && error.contains(shape.kind()), "{error}");
        }
        assert_eq!(CurvedSurfaces::new(&[disc(1e18), sphere(1.8e18)], &[]).unwrap().as_slice().len(), 2);
    }
}
