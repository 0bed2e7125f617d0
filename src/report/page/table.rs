//! Tables that can be sorted.

use crate::film::grouped;
use askama::Template;

/// A table with a caption; the first cell of a row names the row.
#[derive(Debug, Clone, Template)]
#[template(path = "table.html")]
pub(super) struct Table {
    pub(super) caption: String,
    pub(super) columns: Vec<Column>,
    pub(super) rows: Vec<Vec<Cell>>,
}

impl Table {
    /// On paper there are no more rows than these; the style sheet knows the number too.
    const MOST_PRINTED: usize = 30;
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Words,
    /// To the right, so that digits stand below each other.
    Numbers,
}

#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) title: &'static str,
    /// What it means, if its title does not say so.
    pub(super) hint: &'static str,
    pub(super) kind: Kind,
}

impl Column {
    pub(super) fn words(title: &'static str) -> Column {
        Column { title, hint: "", kind: Kind::Words }
    }

    pub(super) fn numbers(title: &'static str) -> Column {
        Column { title, hint: "", kind: Kind::Numbers }
    }

    pub(super) fn hint(self, hint: &'static str) -> Column {
        Column { hint, ..self }
    }

    fn is_number(&self) -> bool {
        self.kind == Kind::Numbers
    }
}

/// What a cell says, and what its row is sorted by.
#[derive(Debug, Clone, Default)]
pub(super) struct Cell {
    pub(super) text: String,
    /// By its text if there is none.
    pub(super) sort: Option<f64>,
    /// Whether it is something that must not be overlooked.
    pub(super) alarm: bool,
    /// The viewer, the light and the pixel that it leads to.
    pub(super) place: Option<Place>,
}

/// A pixel of a map on the page.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) viewer: String,
    pub(super) light: usize,
    pub(super) pixel: [u32; 2],
}

impl Cell {
    pub(super) fn words(text: impl Into<String>) -> Cell {
        Cell { text: text.into(), ..Cell::default() }
    }

    pub(super) fn count(count: u64) -> Cell {
        Cell { sort: Some(count as f64), ..Cell::words(grouped(count)) }
    }

    /// A count of what should not be.
    pub(super) fn wrong(count: u64) -> Cell {
        Cell { alarm: count > 0, ..Cell::count(count) }
    }

    /// With so many digits behind the point.
    pub(super) fn number(value: f64, digits: usize) -> Cell {
        Cell { sort: Some(value), ..Cell::words(format!("{value:.digits$}")) }
    }

    /// With as many digits as it takes to see it.
    pub(super) fn small(value: f64) -> Cell {
        let text = if value == 0.0 { "0".into() } else { format!("{value:.3e}") };
        Cell { sort: Some(value), ..Cell::words(text) }
    }

    pub(super) fn bytes(bytes: u64) -> Cell {
        let text = crate::report::table::bytes(usize::try_from(bytes).unwrap_or(usize::MAX));
        Cell { sort: Some(bytes as f64), ..Cell::words(text) }
    }

    /// Nothing to say.
    pub(super) fn none() -> Cell {
        Cell::words("–")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_escaped_and_sorted_by_their_numbers() {
        let table = Table {
            caption: "a < b".into(),
            columns: vec![Column::words("who"), Column::numbers("wrong").hint("both ways")],
            rows: vec![vec![Cell::words("<script>"), Cell::wrong(12_345)]],
        };
        let html = table.render().unwrap();
        assert!(!html.contains("<script>") && html.contains("a &#60; b"), "{html}");
        assert!(html.contains("data-sort=\"12345\"") && html.contains("12,345"), "{html}");
        assert!(html.contains("title=\"both ways\"") && html.contains("scope=\"row\""), "{html}");
        assert_eq!(html.matches("<button").count(), 2);
    }

    #[test]
    fn what_is_small_is_still_seen() {
        assert_eq!(Cell::small(0.0).text, "0");
        assert_eq!(Cell::small(1.25e-9).text, "1.250e-9");
        assert!(!Cell::wrong(0).alarm && Cell::wrong(1).alarm);
    }
}
