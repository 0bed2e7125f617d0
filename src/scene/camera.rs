//! The pinhole camera and its rays.

use glam::{DAffine3, DVec3, Vec3};

/// Width and height of an image in pixels, both at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageSize {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl ImageSize {
    /// A size of at least one pixel and at most so many.
    ///
    /// # Errors
    /// A line that says which of the two it is.
    pub fn checked(width: u32, height: u32, most_pixels: u64) -> Result<ImageSize, String> {
        if width == 0 || height == 0 {
            return Err("both sides must be at least 1".into());
        }
        if u64::from(width) * u64::from(height) > most_pixels {
            return Err(format!("more than {most_pixels} pixels"));
        }
        Ok(ImageSize { width, height })
    }

    /// Number of pixels.
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// Whole rows of an image that are an image of their own: the part of it that one process draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// The whole image.
    pub of: ImageSize,
    /// Its row, from 0 at the top, that is the first of the part.
    pub first_row: u32,
}

/// A pinhole camera. Rays begin at `origin`; pixel (0, 0) is the top left corner of the image.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// The name that the scene file gives it.
    pub name: String,
    /// The pinhole, world space.
    pub origin: Vec3,
    /// Unit vector from the pinhole to the centre of the image.
    pub forward: Vec3,
    /// Unit vector to the right of the image.
    pub right: Vec3,
    /// Unit vector to the top of the image.
    pub up: Vec3,
    /// Tangent of half the vertical field of view.
    pub tan_half_height: f64,
    /// The size of the image, if the scene file says one. Pixels are square whatever it is.
    pub size: Option<ImageSize>,
    /// Which rows the image holds, if it is a part of a larger one.
    pub window: Option<Window>,
}

impl Camera {
    /// A camera at `origin` that looks at `target`, with a full vertical field of view in degrees.
    ///
    /// `up` need not be perpendicular to the view; if it is parallel to it, another axis is taken.
    /// Trigonometry is `libm`'s, the same on every platform.
    pub fn look_at(name: &str, origin: Vec3, target: Vec3, up: Vec3, vertical_degrees: f64) -> Camera {
        let view = (target - origin).as_dvec3();
        let forward = if view.length_squared() > 0.0 { view.normalize() } else { DVec3::NEG_Z };
        let across = forward.cross(up.as_dvec3());
        let right = if across.length_squared() > 1e-12 {
            across.normalize()
        } else {
            forward.any_orthonormal_vector()
        };
        Camera {
            name: name.into(),
            origin,
            forward: forward.as_vec3(),
            right: right.as_vec3(),
            up: right.cross(forward).as_vec3(),
            tan_half_height: libm::tan(vertical_degrees.to_radians() * 0.5),
            size: None,
            window: None,
        }
    }

    /// The camera where a transform takes it, or `None` if that leaves no position or no direction to look
    /// in. Scale and shear are taken out again; field of view and size stay as they are.
    pub fn transformed(&self, transform: &DAffine3) -> Option<Camera> {
        let turn = |direction: Vec3| transform.transform_vector3(direction.as_dvec3());
        let origin = transform.transform_point3(self.origin.as_dvec3()).as_vec3();
        let forward = turn(self.forward).try_normalize()?;
        let across = turn(self.right);
        let right = (across - across.dot(forward) * forward).try_normalize()?;
        let up = right.cross(forward).as_vec3();
        let camera =
            Camera { origin, forward: forward.as_vec3(), right: right.as_vec3(), up, ..self.clone() };
        origin.is_finite().then_some(camera)
    }

    /// The camera and the image whose pixel centres are the pixel corners of an image of this size.
    pub fn through_corners(self, size: ImageSize) -> (Camera, ImageSize) {
        let corners = ImageSize { width: size.width + 1, height: size.height + 1 };
        let tan_half_height = self.tan_half_height * f64::from(corners.height) / f64::from(size.height);
        (Camera { tan_half_height, ..self }, corners)
    }

    /// Offsets of the image plane at distance 1, in units of `right` and `up`: the centre of pixel
    /// (0, 0) and the step to the next column and row (the latter negative). Of a camera with a window, `size` is that
    /// of the part.
    pub fn raster(&self, size: ImageSize) -> Raster {
        let (size, first_row) = self.window.map_or((size, 0), |window| (window.of, window.first_row));
        let half_height = self.tan_half_height;
        let half_width = half_height * f64::from(size.width) / f64::from(size.height);
        let step_x = 2.0 * half_width / f64::from(size.width);
        let step_y = -2.0 * half_height / f64::from(size.height);
        let (x0, y0) = (-half_width + 0.5 * step_x, half_height + 0.5 * step_y);
        Raster { x0, y0, step_x, step_y, first_row }
    }

    /// The direction of the ray through the centre of pixel (x, y): the one routine that makes camera
    /// rays. It is computed in f64 without fused operations and rounded once to f32; from then on these
    /// bits are the ray, exactly (not normalised).
    pub fn direction(&self, raster: &Raster, x: u32, y: u32) -> Vec3 {
        // The number of the row in the whole image goes into the one product, so that a part has the whole's bits.
        let row = y + raster.first_row;
        let (sx, sy) = (raster.x0 + f64::from(x) * raster.step_x, raster.y0 + f64::from(row) * raster.step_y);
        let (f, r, u) = (self.forward.as_dvec3(), self.right.as_dvec3(), self.up.as_dvec3());
        DVec3::new(f.x + (sx * r.x + sy * u.x), f.y + (sx * r.y + sy * u.y), f.z + (sx * r.z + sy * u.z))
            .as_vec3()
    }
}

/// The grid of pixel centres on the image plane at distance 1 from the pinhole. `x0` and `y0` are the first pixel of the
/// whole image, of which the rows from `first_row` on are looked at.
#[derive(Debug, Clone, Copy)]
pub struct Raster {
    pub(crate) x0: f64,
    pub(crate) y0: f64,
    pub(crate) step_x: f64,
    pub(crate) step_y: f64,
    pub(crate) first_row: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_of_a_window_have_the_rays_of_the_whole_in_bits() {
        let target = Vec3::new(0.3, -0.7, -2.1);
        let camera = Camera::look_at("c", Vec3::new(0.1, 0.2, 0.3), target, Vec3::Y, 37.3);
        let of = ImageSize { width: 31, height: 97 };
        let whole = camera.raster(of);
        for first_row in [0, 16, 48, 96] {
            let part = Camera { window: Some(Window { of, first_row }), ..camera.clone() };
            let raster = part.raster(ImageSize { width: 31, height: of.height - first_row });
            for (x, y) in (0..31).flat_map(|x| (0..of.height - first_row).map(move |y| (x, y))) {
                let bits = |direction: Vec3| direction.to_array().map(f32::to_bits);
                let expected = camera.direction(&whole, x, y + first_row);
                assert_eq!(bits(part.direction(&raster, x, y)), bits(expected), "{x} {y} from {first_row}");
            }
        }
    }

    #[test]
    fn corner_rays_go_from_corner_to_corner() {
        let camera = Camera::look_at("c", Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 90.0);
        let (wider, size) = camera.clone().through_corners(ImageSize { width: 8, height: 4 });
        assert_eq!((size.width, size.height), (9, 5));
        let raster = wider.raster(size);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(raster.x0, -2.0) && close(raster.y0, 1.0));
        assert!(close(raster.step_x, 0.5) && close(raster.step_y, -0.5));
    }
}
