//! The strip under a false-colour map that says what its colours mean and how many pixels have each.

use super::canvas::{Canvas, GLYPH};
use super::grouped;
use crate::scene::ImageSize;

const PAPER: [u8; 3] = [18, 18, 22];
const INK: [u8; 3] = [236, 236, 240];
/// For what has no pixel; still readable.
const FAINT_INK: [u8; 3] = [136, 136, 144];
const SWATCH_EDGE: [u8; 3] = [120, 120, 128];

/// One entry of the legend.
pub(super) struct Entry<'a> {
    pub(super) label: &'a str,
    pub(super) colour: [u8; 3],
    pub(super) count: u64,
    /// A ring is drawn around these pixels.
    pub(super) ringed: bool,
}

/// The most lines of a title.
const TITLE_LINES: usize = 3;

/// Where everything goes; lengths in pixels. Entries stand in columns of equal width, filled row by row.
pub(super) struct Layout {
    /// Font pixels are squares of this side: 1 up to 959 pixels of width, 2 at 1280, 3 at 1920.
    pub(super) scale: u32,
    /// Width of the picture.
    width: u32,
    title: Vec<String>,
    columns: u32,
    rows: u32,
    /// Characters of the longest count.
    count_digits: usize,
}

impl Layout {
    pub(super) fn new(width: u32, title: &str, entries: &[Entry]) -> Layout {
        let mut layout = Layout {
            scale: ((width + 320) / 640).clamp(1, 6),
            width,
            title: Vec::new(),
            columns: 1,
            rows: 0,
            count_digits: entries.iter().map(|entry| grouped(entry.count).len()).max().unwrap_or(0),
        };
        let room = (width - 2 * layout.margin()) / layout.glyph();
        layout.title = wrapped(title, room as usize);
        let text_width = |entry| layout.entry_text(entry, usize::MAX).chars().count() as u32 * layout.glyph();
        let widest = entries.iter().map(text_width).max().unwrap_or(0) + layout.text_offset();
        let most = entries.len().max(1) as u32;
        layout.columns = (layout.inner_width() / (widest + layout.gap())).clamp(1, most);
        layout.rows = (entries.len() as u32).div_ceil(layout.columns);
        layout
    }

    /// Height of the strip.
    pub(super) fn height(&self) -> u32 {
        2 * self.margin() + (self.title.len() as u32 + self.rows) * self.line() - self.leading()
    }

    fn glyph(&self) -> u32 {
        GLYPH * self.scale
    }

    fn leading(&self) -> u32 {
        4 * self.scale
    }

    fn line(&self) -> u32 {
        self.glyph() + self.leading()
    }

    fn margin(&self) -> u32 {
        6 * self.scale
    }

    fn gap(&self) -> u32 {
        2 * self.glyph()
    }

    /// Width for the columns; the gap after the last one may run into the margin.
    fn inner_width(&self) -> u32 {
        self.width - 2 * self.margin() + self.gap()
    }

    /// From the left edge of a swatch to its text.
    fn text_offset(&self) -> u32 {
        self.glyph() + self.glyph() / 2
    }

    /// The count, then the label, shortened to what `room` characters leave it, and whether it is ringed.
    fn entry_text(&self, entry: &Entry, room: usize) -> String {
        let ringed = if entry.ringed { " (ringed)" } else { "" };
        let label = shortened(entry.label, room.saturating_sub(self.count_digits + 1 + ringed.len()));
        format!("{:>width$} {label}{ringed}", grouped(entry.count), width = self.count_digits)
    }
}

/// Draws the strip; its top edge is at row `top`.
pub(super) fn draw(canvas: &mut Canvas, layout: &Layout, top: u32, entries: &[Entry]) {
    let (scale, margin) = (layout.scale, layout.margin());
    let mut y = top + margin;
    for line in &layout.title {
        canvas.text(margin, y, scale, INK, line);
        y += layout.line();
    }
    let column = layout.inner_width() / layout.columns;
    let room = ((column - layout.gap()).saturating_sub(layout.text_offset()) / layout.glyph()) as usize;
    for (index, entry) in (0..).zip(entries) {
        let left = margin + index % layout.columns * column;
        let line = y + index / layout.columns * layout.line();
        canvas.square(left, line, layout.glyph(), SWATCH_EDGE);
        let inside = layout.glyph() - 2 * scale;
        canvas.square(left + scale, line + scale, inside, entry.colour);
        let ink = if entry.count == 0 { FAINT_INK } else { INK };
        canvas.text(left + layout.text_offset(), line, scale, ink, &layout.entry_text(entry, room));
    }
}

/// The strip's ground, and what surrounds an image narrower than its legend.
pub(super) fn blank(size: ImageSize) -> Canvas {
    Canvas::new(size, PAPER)
}

/// Lines of at most `room` characters, broken between words; what three lines do not hold is left out.
fn wrapped(text: &str, room: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let full = lines.len() == TITLE_LINES;
        match lines.last_mut() {
            Some(line) if full || line.chars().count() + 1 + word.chars().count() <= room => {
                *line = format!("{line} {word}");
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines.iter().map(|line| shortened(line, room)).collect()
}

fn shortened(text: &str, room: usize) -> String {
    if text.chars().count() <= room {
        return text.to_string();
    }
    let kept: String = text.chars().take(room.saturating_sub(2)).collect();
    kept + &".."[..room.min(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped_and_labels_give_way_to_counts() {
        assert_eq!([0, 999, 1000, 1234567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        let entry = |count| Entry { label: "false shadow", colour: [0; 3], count, ringed: false };
        let layout = Layout::new(320, "", &[entry(1200), entry(7)]);
        assert_eq!(layout.entry_text(&entry(7), 18), "    7 false shadow");
        assert_eq!(layout.entry_text(&entry(1200), 14), "1,200 false ..");
        assert_eq!(shortened("abc", 1), ".");
    }

    #[test]
    fn titles_are_wrapped_and_end() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("a b c d e", 1), ["a", "b", "."]);
        assert!(wrapped(" ", 10).is_empty());
    }

    #[test]
    fn the_font_grows_with_the_picture() {
        let scale = |width| Layout::new(width, "", &[]).scale;
        assert_eq!([240, 320, 640, 1280, 1920, 3840].map(scale), [1, 1, 1, 2, 3, 6]);
    }
}
