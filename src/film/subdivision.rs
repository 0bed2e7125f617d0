//! Anti-aliasing by pixel subdivision, as in the pictures of the 1986 paper: an image of n x n samples a pixel
//! becomes one of a value a pixel.

use super::ImagePlanes;
use crate::error::{Error, Result};
use crate::scene::ImageSize;

/// How the samples of a pixel become one.
#[derive(Clone, Copy)]
enum Rule {
    /// Their mean: colours with the background as black, coverage, shares of light.
    Mean,
    /// The mean of those that see a surface.
    MeanOfSurfaces,
    /// The least.
    Nearest,
    /// The first that sees a surface: numbers of things have no mean.
    First,
}

impl Rule {
    fn of(channel: &str) -> Rule {
        match channel.split('.').next().unwrap_or(channel) {
            "Z" => Rule::Nearest,
            "id" => Rule::First,
            "P" | "N" | "albedo" => Rule::MeanOfSurfaces,
            _ => Rule::Mean,
        }
    }

    /// `samples` with their coverage.
    fn apply(self, samples: impl Iterator<Item = (f32, f32)> + Clone) -> f32 {
        let seen = samples.clone().filter(|&(_, alpha)| alpha > 0.0).map(|(value, _)| value);
        match self {
            Rule::Mean => mean(samples.map(|(value, _)| value)),
            Rule::MeanOfSurfaces => mean(seen),
            Rule::Nearest => samples.map(|(value, _)| value).fold(f32::INFINITY, f32::min),
            Rule::First => seen.into_iter().next().unwrap_or(0.0),
        }
    }
}

fn mean(values: impl Iterator<Item = f32>) -> f32 {
    let (sum, count) = values.fold((0.0, 0u32), |(sum, count), value| (sum + f64::from(value), count + 1));
    if count == 0 { 0.0 } else { (sum / f64::from(count)) as f32 }
}

/// The image of one value a pixel, of `samples` x `samples` each in the given one.
///
/// # Errors
/// [`Error::Usage`] if the sides are no multiples of `samples`, or there is no channel `A`.
pub fn subdivided(planes: &ImagePlanes, samples: u32) -> Result<ImagePlanes> {
    let fine = planes.size();
    if !(fine.width.is_multiple_of(samples) && fine.height.is_multiple_of(samples)) {
        let ImageSize { width, height } = fine;
        return Err(Error::Usage(format!("{width}x{height} samples: not {samples}x{samples} a pixel")));
    }
    let alpha = planes.channel("A").ok_or_else(|| Error::Usage("samples without a channel `A`".into()))?;
    let size = ImageSize { width: fine.width / samples, height: fine.height / samples };
    let mut coarse = ImagePlanes::new(size);
    for plane in planes.channels() {
        let rule = Rule::of(&plane.name);
        let pixel = |pixel: u32| {
            let (x, y) = (pixel % size.width * samples, pixel / size.width * samples);
            let places = (0..samples * samples).map(|i| {
                let (column, row) = (x + i % samples, y + i / samples);
                (row as usize) * fine.width as usize + column as usize
            });
            rule.apply(places.map(|place| (plane.samples[place], alpha[place])))
        };
        coarse.add_channel(&plane.name, (0..size.pixels() as u32).map(pixel).collect())?;
    }
    for (name, text) in planes.attributes() {
        coarse.add_attribute(name, text)?;
    }
    planes.frame_rate().into_iter().for_each(|rate| coarse.set_frame_rate(rate));
    Ok(coarse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_channel_has_its_rule() {
        let mut fine = ImagePlanes::new(ImageSize { width: 4, height: 2 });
        let background = f32::INFINITY;
        for (name, samples) in [
            ("A", [0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]),
            ("R", [0.0, 0.3, 0.0, 0.0, 0.6, 0.9, 0.0, 0.0]),
            ("Z", [background, 3.0, background, background, 2.0, 5.0, background, background]),
            ("N.X", [0.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
            ("id.object", [0.0, 7.0, 0.0, 0.0, 8.0, 8.0, 0.0, 0.0]),
            ("shadow.sun.exact", [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        ] {
            fine.add_channel(name, samples.to_vec()).unwrap();
        }
        fine.add_attribute("scene", "s").unwrap();
        let coarse = subdivided(&fine, 2).unwrap();
        let pixels = |name: &str| coarse.channel(name).unwrap().to_vec();
        assert_eq!(pixels("A"), [0.75, 0.0]);
        assert_eq!(pixels("R"), [0.45, 0.0]);
        assert_eq!(pixels("Z"), [2.0, background]);
        assert_eq!(pixels("N.X"), [0.5, 0.0]);
        assert_eq!(pixels("id.object"), [7.0, 0.0]);
        assert_eq!(pixels("shadow.sun.exact"), [0.5, 0.0]);
        assert_eq!(coarse.attribute("scene"), Some("s"));
        assert!(subdivided(&fine, 3).is_err());
    }
}
