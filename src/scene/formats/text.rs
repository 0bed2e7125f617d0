//! Text from files on its way to people.

use crate::error::breaks_line;

/// The most characters, once escaped, of a file's own text that a message or a name repeats.
const MAX_SHOWN: usize = 120;

/// What stands for the rest.
const CUT: &str = "...";

/// Text from a file, fit for one line of a terminal: control characters and line separators are escaped,
/// and a text that is longer than [`MAX_SHOWN`] characters and [`CUT`] is cut.
pub(super) fn printable(text: &str) -> String {
    let escape = |character: char| match breaks_line(character) {
        true => character.escape_default().collect(),
        false => String::from(character),
    };
    let (mut shown, mut count, mut end) = (String::new(), 0, 0);
    for escaped in text.chars().map(escape) {
        // Counted as they are shown: a zero byte takes five characters.
        count += escaped.chars().count();
        // What was cut already is left as it is, or a scene that is written and read would change its names.
        if count > MAX_SHOWN + CUT.len() {
            shown.truncate(end);
            shown.push_str(CUT);
            break;
        }
        shown.push_str(&escaped);
        if count <= MAX_SHOWN {
            end = shown.len();
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
        assert_eq!(printable(&"\0".repeat(1000)).len(), MAX_SHOWN + 3);
        for text in ["x".repeat(1000), "\0".repeat(1000), format!("{}\0\0", "é".repeat(118))] {
            let once = printable(&text);
            assert!(once.ends_with(CUT) && printable(&once) == once, "{once}");
        }
    }
}
