//! Named planes of floats, all of one size: an image before it is a file.

use crate::error::{Error, Result};
use crate::scene::{FrameRate, ImageSize, Window};
use std::collections::HashMap;

/// The longest name, in bytes, that OpenEXR gives to a channel or an attribute.
const LONGEST_NAME: usize = 255;

/// One channel of an image.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// The full name, layers separated by dots: `R`, `P.X`, `shadow.key.difference`.
    pub name: String,
    /// One sample a pixel, row by row from the top left; any float, infinities and NaN included.
    pub samples: Vec<f32>,
}

/// The last row that a window of an OpenEXR file may have, and one more.
const MOST_ROWS: u32 = i32::MAX as u32;

/// An image as planes of one size, with text attributes. Names are unique among channels and among
/// attributes.
#[derive(Debug, Clone, PartialEq)]
pub struct ImagePlanes {
    size: ImageSize,
    channels: Vec<Plane>,
    attributes: Vec<(String, String)>,
    /// Of the animation that it is a frame of.
    rate: Option<FrameRate>,
    /// Where its rows belong, if it is a part of a larger image.
    window: Option<Window>,
    /// Places of the channels by their names: an image of 10,000 lights has 30,000 of them.
    places: HashMap<String, usize>,
}

impl ImagePlanes {
    /// An image without channels.
    pub fn new(size: ImageSize) -> ImagePlanes {
        let (channels, attributes, places) = (Vec::new(), Vec::new(), HashMap::new());
        ImagePlanes { size, channels, attributes, rate: None, window: None, places }
    }

    /// Adds a channel.
    ///
    /// # Errors
    /// [`Error::Usage`] if the name is taken, empty, longer than 255 bytes or not printable ASCII, or if
    /// there is not one sample for each pixel.
    pub fn add_channel(&mut self, name: impl Into<String>, samples: Vec<f32>) -> Result<()> {
        let name = name.into();
        check_name("channel", &name)?;
        if self.channel(&name).is_some() {
            return Err(Error::Usage(format!("two channels named `{name}`")));
        }
        if samples.len() != self.size.pixels() {
            let (have, want) = (samples.len(), self.size.pixels());
            return Err(Error::Usage(format!("channel `{name}`: {have} samples for {want} pixels")));
        }
        self.places.insert(name.clone(), self.channels.len());
        self.channels.push(Plane { name, samples });
        Ok(())
    }

    /// Adds a text attribute. In an OpenEXR file its name gets the prefix `lightbuffer:`.
    ///
    /// # Errors
    /// [`Error::Usage`] if the name is taken, empty, longer than 200 bytes or not printable ASCII. The text
    /// may be any.
    pub fn add_attribute(&mut self, name: impl Into<String>, text: impl Into<String>) -> Result<()> {
        let name = name.into();
        check_name("attribute", &name)?;
        if name.len() > 200 {
            return Err(Error::Usage(format!("attribute `{name}`: longer than 200 bytes")));
        }
        if self.attribute(&name).is_some() {
            return Err(Error::Usage(format!("two attributes named `{name}`")));
        }
        self.attributes.push((name, text.into()));
        Ok(())
    }

    /// Says how many frames a second the animation has that this is one of: `framesPerSecond` in an OpenEXR file.
    pub fn set_frame_rate(&mut self, rate: FrameRate) {
        self.rate = Some(rate);
    }

    /// Frames a second, if it is one of an animation.
    pub fn frame_rate(&self) -> Option<FrameRate> {
        self.rate
    }

    /// Says which rows of a larger image these are: the data window within the display window of an OpenEXR file.
    ///
    /// # Errors
    /// [`Error::Usage`] if they are not rows of such an image.
    pub fn set_window(&mut self, window: Window) -> Result<()> {
        let Window { of, first_row } = window;
        let ImageSize { width, height } = self.size;
        let fits = first_row.checked_add(height).is_some_and(|end| end <= of.height.min(MOST_ROWS));
        if width != of.width || !fits {
            return Err(Error::Usage(format!(
                "{width}x{height} pixels from row {first_row}: no rows of an image of {}x{}",
                of.width, of.height
            )));
        }
        self.window = Some(window);
        Ok(())
    }

    /// Which rows of a larger image these are, if they are not an image of their own.
    pub fn window(&self) -> Option<Window> {
        self.window
    }

    /// Width and height of every channel.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// All channels, in the order they were added.
    pub fn channels(&self) -> &[Plane] {
        &self.channels
    }

    /// The samples of a channel, row by row from the top left.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.places.get(name).map(|&place| self.channels[place].samples.as_slice())
    }

    /// Gives the samples of a channel away, and the channel with them.
    pub fn take_channel(&mut self, name: &str) -> Option<Vec<f32>> {
        let place = self.places.remove(name)?;
        let plane = self.channels.swap_remove(place);
        if let Some(moved) = self.channels.get(place) {
            self.places.insert(moved.name.clone(), place);
        }
        Some(plane.samples)
    }

    /// All attributes as name and text, in the order they were added.
    pub fn attributes(&self) -> &[(String, String)] {
        &self.attributes
    }

    /// The text of an attribute.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(other, _)| other == name).map(|(_, text)| text.as_str())
    }
}

fn check_name(kind: &str, name: &str) -> Result<()> {
    if name.is_empty() || name.len() > LONGEST_NAME || !name.bytes().all(|b| b.is_ascii_graphic()) {
        let shown: String = name.escape_debug().take(40).collect();
        return Err(Error::Usage(format!("{kind} `{shown}`: a name is 1 to 255 printable ASCII characters")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_in_one_line() {
        let mut image = ImagePlanes::new(ImageSize { width: 2, height: 3 });
        image.add_channel("Z", vec![0.0; 6]).unwrap();
        image.add_attribute("version", "1").unwrap();
        let errors = [
            image.add_channel("Z", vec![0.0; 6]).unwrap_err().to_string(),
            image.add_channel("R", vec![0.0; 5]).unwrap_err().to_string(),
            image.add_channel("a\nb", vec![0.0; 6]).unwrap_err().to_string(),
            image.add_channel("", vec![0.0; 6]).unwrap_err().to_string(),
            image.add_attribute("version", "2").unwrap_err().to_string(),
            image.add_attribute("a b", "2").unwrap_err().to_string(),
        ];
        assert_eq!(errors[0], "two channels named `Z`");
        assert_eq!(errors[1], "channel `R`: 5 samples for 6 pixels");
        assert_eq!(errors[4], "two attributes named `version`");
        let of = ImageSize { width: 2, height: 8 };
        image.set_window(Window { of, first_row: 5 }).unwrap();
        for (width, first_row) in [(2, 6), (2, u32::MAX), (3, 0)] {
            let of = ImageSize { width, ..of };
            image.set_window(Window { of, first_row }).unwrap_err();
        }
        assert_eq!(image.window(), Some(Window { of, first_row: 5 }));
        assert!(errors.iter().all(|line| !line.contains('\n')), "{errors:?}");
        assert_eq!((image.channels().len(), image.attribute("version")), (1, Some("1")));
    }
}
