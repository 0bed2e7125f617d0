//! Curved surfaces.

use super::schema::{
    ConeEntry, CylinderEntry, DiscEntry, EllipsoidEntry, PlaneEntry, QuadricEntry, SphereEntry,
};
use super::values::{Exactly, Number, Point};
use crate::geometry::curved::{Disc, Ellipsoid, InfinitePlane, Quadric, Shape};
use glam::Vec3;

/// A length above 0, in 32 bits.
fn radius(Number(radius): Number) -> Result<f32, String> {
    let rounded = radius as f32;
    match rounded > 0.0 && rounded.is_finite() {
        true => Ok(rounded),
        false => Err(format!("expected a radius above 0 and in the range of 32-bit floats, found {radius}")),
    }
}

/// The same from 0 up.
fn radius_or_none(given: Number) -> Result<f32, String> {
    if given.0 == 0.0 { Ok(0.0) } else { radius(given) }
}

/// A number in 32 bits.
pub(super) fn rounded(Number(number): Number) -> Result<f32, String> {
    let rounded = number as f32;
    match rounded.is_finite() {
        true => Ok(rounded),
        false => Err(format!("expected a number in the range of 32-bit floats, found {number}")),
    }
}

pub(super) fn sphere(entry: &SphereEntry) -> Result<Shape, String> {
    Ok(Shape::sphere(entry.centre.0, radius(entry.radius)?))
}

pub(super) fn ellipsoid(entry: &EllipsoidEntry) -> Result<Shape, String> {
    let axes = match (entry.radii, entry.axes) {
        (Some(Point(radii)), None) if radii.cmpgt(Vec3::ZERO).all() => {
            [Vec3::X * radii.x, Vec3::Y * radii.y, Vec3::Z * radii.z]
        }
        (Some(Point(radii)), None) => {
            return Err(format!("expected radii above 0, found {:?}", radii.to_array()));
        }
        (None, Some(Exactly(axes))) => axes.map(|Point(axis)| axis),
        (None, None) => return Err("expected `radii` or `axes`, found neither".into()),
        (Some(_), Some(_)) => return Err("expected either `radii` or `axes`, found both".into()),
    };
    Ok(Shape::Ellipsoid(Ellipsoid { centre: entry.centre.0, axes }))
}

pub(super) fn cylinder(entry: &CylinderEntry) -> Result<Shape, String> {
    Ok(Shape::cylinder(entry.base.0, entry.apex.0, radius(entry.radius)?))
}

pub(super) fn cone(entry: &ConeEntry) -> Result<Shape, String> {
    let base_radius = radius_or_none(entry.base_radius)?;
    let apex_radius = entry.apex_radius.map_or(Ok(0.0), radius_or_none)?;
    if base_radius == 0.0 && apex_radius == 0.0 {
        return Err("expected a radius above 0 at one end at least".into());
    }
    Ok(Shape::cone(entry.base.0, base_radius, entry.apex.0, apex_radius))
}

pub(super) fn disc(entry: &DiscEntry) -> Result<Shape, String> {
    let (centre, normal) = (entry.centre.0, entry.normal.0);
    Ok(Shape::Disc(Disc { centre, normal, radius: radius(entry.radius)? }))
}

pub(super) fn plane(entry: &PlaneEntry) -> Result<Shape, String> {
    Ok(Shape::Plane(InfinitePlane { point: entry.point.0, normal: entry.normal.0 }))
}

pub(super) fn quadric(entry: &QuadricEntry) -> Result<Shape, String> {
    let or_zero = |given: Option<Point>| given.map_or(Vec3::ZERO, |point| point.0);
    let [xx, yy, zz] = or_zero(entry.squares).to_array();
    let [xy, yz, zx] = or_zero(entry.mixed).to_array();
    let (low, high) = (entry.low.0, entry.high.0);
    if !low.cmplt(high).all() {
        let [low, high] = [low, high].map(|corner| corner.to_array());
        return Err(format!("expected `low` below `high` along each axis, found {low:?} and {high:?}"));
    }
    Ok(Shape::Quadric(Quadric {
        reference: or_zero(entry.centre),
        second: [xx, yy, zz, xy, yz, zx],
        first: or_zero(entry.linear),
        constant: entry.constant.map_or(Ok(0.0), rounded)?,
        low,
        high,
    }))
}
