//! The camera of an NFF file.

use super::words::{Complaint, Words, shown};
use crate::scene::formats::limits::MAX_CAMERA_PIXELS;
use crate::scene::formats::looking;
use crate::scene::{Camera, ImageSize};
use glam::Vec3;

/// The lines that follow `v`, in any order. Only `hither` may be missing.
#[derive(Default)]
struct Lines {
    from: Option<Vec3>,
    at: Option<Vec3>,
    up: Option<Vec3>,
    angle: Option<f64>,
    hither: Option<f64>,
    size: Option<ImageSize>,
}

/// A camera, and what its picture lacks of what the file asks for.
pub(super) struct Viewpoint {
    pub(super) camera: Camera,
    /// Whether the file asks for pixels that are not square.
    pub(super) oblong: bool,
}

/// Reads the lines that follow `v`.
///
/// # Errors
/// A line that is missing, twice there or not readable, and numbers that leave no direction to look in.
pub(super) fn read(words: &mut Words) -> Result<Viewpoint, Complaint> {
    let first = words.line();
    let mut lines = Lines::default();
    while let Some(b"from" | b"at" | b"up" | b"angle" | b"hither" | b"resolution") = words.peek_entity() {
        let keyword = words.entity()?.unwrap_or_default();
        let line = words.line();
        let is_second = match keyword {
            b"from" => lines.from.replace(words.finite()?.into()).is_some(),
            b"at" => lines.at.replace(words.finite()?.into()).is_some(),
            b"up" => lines.up.replace(words.finite()?.into()).is_some(),
            b"angle" => lines.angle.replace(words.parsed("an angle")?).is_some(),
            b"hither" => lines.hither.replace(words.parsed("a distance")?).is_some(),
            _ => lines.size.replace(size(words)?).is_some(),
        };
        if is_second {
            return Err((line, format!("a second `{}` of one viewpoint", shown(keyword))));
        }
    }
    lines.camera().map_err(|why| (first, why))
}

fn size(words: &mut Words) -> Result<ImageSize, Complaint> {
    let (width, height) = (words.parsed("a number of pixels")?, words.parsed("a number of pixels")?);
    let size = ImageSize::checked(width, height, MAX_CAMERA_PIXELS);
    size.map_err(|why| (words.line(), format!("resolution {width} {height}: {why}")))
}

impl Lines {
    fn camera(self) -> Result<Viewpoint, String> {
        let missing = |keyword: &str| format!("the viewpoint has no line `{keyword}`");
        let from = self.from.ok_or_else(|| missing("from"))?;
        let at = self.at.ok_or_else(|| missing("at"))?;
        let up = self.up.ok_or_else(|| missing("up"))?;
        let angle = self.angle.ok_or_else(|| missing("angle"))?;
        let size = self.size.ok_or_else(|| missing("resolution"))?;
        if !(angle > 0.0 && angle < 180.0) {
            return Err(format!("angle {angle}, expected one between 0 and 180"));
        }
        let looking = looking::camera("view", [from, at, up], angle);
        let camera = looking.map_err(|why| why.message("`from` and `at`"))?;
        // What lies between the centres of the first and the last row, and half a row more on either side.
        let rows = f64::from(size.height);
        let widened = if size.height > 1 { rows / (rows - 1.0) } else { 1.0 };
        let camera = Camera {
            tan_half_height: libm::tan(angle.to_radians() * 0.5) * widened,
            size: Some(size),
            ..camera
        };
        Ok(Viewpoint { camera, oblong: size.width != size.height })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn read_text(text: &str) -> Result<Viewpoint, Complaint> {
        let mut words = Words::new(text.as_bytes());
        words.entity().unwrap();
        read(&mut words)
    }

    const USUAL: &str = "v\nfrom 1 2 3\nat 1 2 -7\nup 0 9 5\nangle 90\nhither 1\nresolution 5 5\n";

    #[test]
    fn a_camera_sees_half_a_row_more_than_its_angle() {
        let Viewpoint { camera, oblong } = read_text(USUAL).map_err(|(_, why)| why).unwrap();
        assert_eq!((camera.origin, camera.forward), (Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z));
        assert_eq!((camera.right, camera.up), (Vec3::X, Vec3::Y));
        assert_eq!(camera.size, Some(ImageSize { width: 5, height: 5 }));
        assert!((camera.tan_half_height - 1.25).abs() < 1e-12 && !oblong);
        // So that the centres of the first row and column lie at the angle.
        let raster = camera.raster(camera.size.unwrap());
        let corner = camera.direction(&raster, 0, 0).as_dvec3();
        assert!((corner - DVec3::new(-1.0, 1.0, -1.0)).length() < 1e-6, "{corner}");
    }

    #[test]
    fn lengths_mean_nothing() {
        for up in ["0 1e-30 0", "0 1e30 0"] {
            let text = USUAL.replace("0 9 5", up);
            assert_eq!(read_text(&text).map_err(|(_, why)| why).unwrap().camera.up, Vec3::Y);
        }
        let text = USUAL.replace("1 2 -7", "1 2 2.9999");
        assert_eq!(read_text(&text).map_err(|(_, why)| why).unwrap().camera.forward, Vec3::NEG_Z);
    }
}
