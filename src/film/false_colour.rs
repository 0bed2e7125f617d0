//! Maps of categories in false colour, with a legend under the image.

use super::canvas::Canvas;
use super::legend::{self, Entry, Layout};
use super::markers::draw_rings;
use super::{FileSet, Marking, RARE_PIXELS, add_png_rgb};
use crate::error::{Error, Result};
use crate::scene::ImageSize;
use std::path::Path;

/// The narrowest picture; a smaller image stands at its left edge. Room for 28 characters.
const NARROWEST: u32 = 240;

/// One category of a map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Category {
    /// What the legend calls it: a few words.
    pub label: String,
    /// Its colour in sRGB; see [`super::palette`].
    pub colour: [u8; 3],
    /// Whether single pixels of it must catch the eye.
    pub marking: Marking,
    /// When the legend lists it.
    pub listed: Listed,
}

/// When a legend lists a category.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Listed {
    /// Always: that there is none of it says something.
    Always,
    /// Only if the map has a pixel of it.
    IfPresent,
}

impl Category {
    /// A category that is never marked.
    pub fn plain(label: impl Into<String>, colour: [u8; 3]) -> Category {
        Category { label: label.into(), colour, marking: Marking::Never, listed: Listed::Always }
    }

    /// A category that is never marked, and listed only where there is some of it.
    pub fn if_present(label: impl Into<String>, colour: [u8; 3]) -> Category {
        Category { listed: Listed::IfPresent, ..Category::plain(label, colour) }
    }

    /// A category that is ringed when it is rare.
    pub fn marked_when_rare(label: impl Into<String>, colour: [u8; 3]) -> Category {
        Category { marking: Marking::WhenRare, ..Category::plain(label, colour) }
    }
}

/// An image in which every pixel belongs to one category.
#[derive(Debug, Clone)]
pub struct CategoryMap {
    title: String,
    size: ImageSize,
    classes: Vec<u8>,
    legend: Vec<Category>,
    counts: Vec<u64>,
}

impl CategoryMap {
    /// A map from one class a pixel, row by row from the top left; a class is an index into `legend`. The
    /// title stands above the legend in at most three lines; an empty one takes no room.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is not one class for each pixel, or a class without a category.
    pub fn new(
        title: impl Into<String>,
        size: ImageSize,
        classes: Vec<u8>,
        legend: Vec<Category>,
    ) -> Result<CategoryMap> {
        if classes.len() != size.pixels() {
            let (have, want) = (classes.len(), size.pixels());
            return Err(Error::Usage(format!("false colour: {have} classes for {want} pixels")));
        }
        let mut counts = vec![0; legend.len()];
        for &class in &classes {
            match counts.get_mut(usize::from(class)) {
                Some(count) => *count += 1,
                None => return Err(Error::Usage(format!("false colour: class {class} has no category"))),
            }
        }
        Ok(CategoryMap { title: title.into(), size, classes, legend, counts })
    }

    /// Pixels of each category, in the order of the legend.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// The picture: its size and three sRGB bytes a pixel. The image is at the top left, one pixel for one
    /// pixel, with rings around rare categories that want them; the legend is below.
    pub fn render(&self) -> (ImageSize, Vec<u8>) {
        let entries: Vec<Entry> = (0..self.legend.len()).map(|class| self.entry(class)).collect();
        let is_listed =
            |&class: &usize| self.legend[class].listed == Listed::Always || self.counts[class] > 0;
        let listed: Vec<Entry> =
            (0..self.legend.len()).filter(is_listed).map(|class| self.entry(class)).collect();
        let width = self.size.width.max(NARROWEST);
        let layout = Layout::new(width, &self.title, &listed);
        let mut canvas = legend::blank(ImageSize { width, height: self.size.height + layout.height() });
        self.draw_image(&mut canvas);
        if entries.iter().any(|entry| entry.ringed) {
            draw_rings(&mut canvas, self.size, layout.scale, |at| {
                let entry = &entries[usize::from(self.classes[at])];
                entry.ringed.then_some(entry.colour)
            });
        }
        legend::draw(&mut canvas, &layout, self.size.height, &listed);
        canvas.into_rgb()
    }

    fn draw_image(&self, canvas: &mut Canvas) {
        let mut classes = self.classes.iter();
        for y in 0..self.size.height {
            for (x, &class) in (0..self.size.width).zip(classes.by_ref()) {
                canvas.set(x, y, self.legend[usize::from(class)].colour);
            }
        }
    }

    fn entry(&self, class: usize) -> Entry<'_> {
        let (category, count) = (&self.legend[class], self.counts[class]);
        let rare = (1..=RARE_PIXELS).contains(&count);
        Entry {
            label: &category.label,
            colour: category.colour,
            count,
            ringed: rare && category.marking == Marking::WhenRare,
        }
    }
}

/// Writes the rendered map as PNG, complete or not at all.
///
/// # Errors
/// [`Error::Io`] if the file cannot be written.
pub fn write_false_colour(path: &Path, map: &CategoryMap) -> Result<()> {
    let mut files = FileSet::new();
    add_false_colour(&mut files, path, map)?;
    files.publish()
}

/// The same as one file of several that appear together.
///
/// # Errors
/// As [`write_false_colour`].
pub fn add_false_colour(files: &mut FileSet, path: &Path, map: &CategoryMap) -> Result<()> {
    let (size, rgb) = map.render();
    add_png_rgb(files, path, size, &rgb)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::palette;

    fn two_categories() -> Vec<Category> {
        vec![Category::plain("right", palette::LIT), Category::marked_when_rare("wrong", palette::VERMILLION)]
    }

    #[test]
    fn classes_are_counted_and_checked() {
        let size = ImageSize { width: 3, height: 1 };
        let map = CategoryMap::new("", size, vec![0, 1, 0], two_categories()).unwrap();
        assert_eq!(map.counts(), [2, 1]);
        CategoryMap::new("", size, vec![0, 1, 2], two_categories()).unwrap_err();
        CategoryMap::new("", size, vec![0, 1], two_categories()).unwrap_err();
    }

    #[test]
    fn the_tiniest_image_and_the_longest_label_have_a_picture() {
        let size = ImageSize { width: 1, height: 1 };
        let legend = vec![Category::marked_when_rare("label ".repeat(50), palette::BLUE)];
        let (picture, rgb) = CategoryMap::new("t".repeat(500), size, vec![0], legend).unwrap().render();
        assert_eq!(rgb.len(), picture.pixels() * 3);
        assert_eq!(rgb[..3], palette::BLUE);
        assert!(CategoryMap::new("", size, vec![], vec![]).is_err());
    }

    #[test]
    fn more_than_the_rare_are_not_ringed() {
        let size = ImageSize { width: 320, height: 100 };
        let picture = |count: usize| {
            let classes = (0..size.pixels()).map(|i| u8::from(i < count)).collect();
            let map = CategoryMap::new("", size, classes, two_categories()).unwrap();
            let (_, rgb) = map.render();
            rgb[..size.pixels() * 3].chunks(3).filter(|p| *p == palette::VERMILLION).count()
        };
        assert!(picture(200) > 300);
        assert_eq!(picture(201), 201);
    }
}
