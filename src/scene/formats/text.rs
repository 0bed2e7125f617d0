//! Text from files on its way to people.

use crate::error::breaks_line;

/// The most characters of a file's own text that a message or a name repeats.
const MAX_SHOWN: usize = 120;

/// Text from a file, fit for one line of a terminal: control characters and line separators are escaped,
/// and a text past [`MAX_SHOWN`] characters is cut.
pub(super) fn printable(text: &str) -> String {
    let mut shown = String::new();
    for (count, character) in text.chars().enumerate() {
        if count == MAX_SHOWN {
            shown.push_str("...");
            break;
        }
        if breaks_line(character) {
            shown.extend(character.escape_default());
        } else {
            shown.push(character);
        }
    }
    shown
}

/// `1 triangle`, `2 triangles`.
pub(super) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stays_on_one_line() {
        assert_eq!(printable("a\nb\u{1b}[31m\u{2028}é"), "a\\nb\\u{1b}[31m\\u{2028}é");
        assert_eq!(printable(&"x".repeat(1000)).len(), MAX_SHOWN + 3);
    }
}
