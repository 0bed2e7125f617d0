//! A text file, handed to its parser line by line.

use std::borrow::Cow;
use std::io::{self, BufRead, Read};

/// What becomes of a line.
pub(super) enum Verdict {
    /// The parser reads it.
    Pass,
    /// The parser reads an empty line instead.
    Skip,
    /// The parser reads this instead.
    Replace(String),
    /// Reading ends here with this message.
    Refuse(String),
}

/// Hands out exactly one line a call of `fill_buf`, so that after a failure the count tells the line.
///
/// Each line is shown to `inspect` first, with its number and without its line end. A line that ends in a
/// backslash goes on in the next one.
pub(super) struct Lines<'a, F> {
    rest: &'a [u8],
    inspect: F,
    handed: Cow<'a, [u8]>,
    position: usize,
    number: usize,
    next_number: usize,
    refusal: Option<String>,
}

impl<'a, F: FnMut(&str, usize) -> Verdict> Lines<'a, F> {
    pub(super) fn new(bytes: &'a [u8], inspect: F) -> Lines<'a, F> {
        // A byte order mark would make the first keyword an unknown one.
        let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Lines {
            rest,
            inspect,
            handed: Cow::Borrowed(b""),
            position: 0,
            number: 0,
            next_number: 1,
            refusal: None,
        }
    }

    /// The number of the line handed out last, from 1.
    pub(super) fn number(&self) -> usize {
        self.number.max(1)
    }

    /// The line handed out last.
    pub(super) fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.handed)
    }

    /// Why reading was ended, if it was ended here.
    pub(super) fn refusal(&mut self) -> Option<String> {
        self.refusal.take()
    }

    fn take_line(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|&b| b == b'\n').map_or(self.rest.len(), |newline| newline + 1);
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest;
        self.next_number += 1;
        line
    }

    fn advance(&mut self) -> io::Result<()> {
        if self.rest.is_empty() {
            return Ok(());
        }
        self.number = self.next_number;
        self.position = 0;
        let mut line = Cow::Borrowed(self.take_line());
        while let Some(start) = continued(&line)
            && !self.rest.is_empty()
        {
            let more = self.take_line();
            let joined = line.to_mut();
            joined.truncate(start);
            joined.push(b' ');
            joined.extend_from_slice(more);
        }
        // A last line without its end would make the parser ask for more before it reads this.
        if !line.ends_with(b"\n") {
            line.to_mut().push(b'\n');
        }
        // Comments may be in any encoding.
        let verdict = if line.trim_ascii_start().starts_with(b"#") {
            Verdict::Skip
        } else {
            match std::str::from_utf8(&line) {
                Ok(text) => (self.inspect)(text.trim_end_matches(['\r', '\n']), self.number),
                Err(_) => Verdict::Refuse("expected text in UTF-8".into()),
            }
        };
        self.handed = match verdict {
            Verdict::Pass => line,
            Verdict::Skip => Cow::Borrowed(b"\n"),
            Verdict::Replace(text) => Cow::Owned((text + "\n").into_bytes()),
            Verdict::Refuse(why) => {
                self.refusal = Some(why);
                return Err(io::Error::other("refused"));
            }
        };
        Ok(())
    }
}

/// Where the backslash is that continues a line, if there is one.
fn continued(line: &[u8]) -> Option<usize> {
    let text = line.strip_suffix(b"\n").unwrap_or(line);
    let text = text.strip_suffix(b"\r").unwrap_or(text);
    text.strip_suffix(b"\\").map(<[u8]>::len)
}

impl<F: FnMut(&str, usize) -> Verdict> BufRead for Lines<'_, F> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.position == self.handed.len() {
            self.advance()?;
        }
        Ok(&self.handed[self.position..])
    }

    fn consume(&mut self, amount: usize) {
        self.position += amount;
    }
}

impl<F: FnMut(&str, usize) -> Verdict> Read for Lines<'_, F> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(out)?;
        self.consume(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_numbered_joined_and_filtered() {
        let text = b"\xef\xbb\xbfone\r\n# \xff comment\ntwo \\\n  three\nskip\nlast";
        let mut shown = Vec::new();
        let inspect = |line: &str, number: usize| {
            shown.push((number, line.to_owned()));
            if line == "skip" { Verdict::Skip } else { Verdict::Pass }
        };
        let handed: Vec<_> = Lines::new(text, inspect).lines().map(|l| l.unwrap()).collect();
        assert_eq!(handed, ["one", "", "two    three", "", "last"]);
        let expected = [(1, "one"), (3, "two    three"), (5, "skip"), (6, "last")];
        assert_eq!(shown, expected.map(|(number, line)| (number, line.to_owned())));
    }

    #[test]
    fn a_refused_line_is_the_last() {
        let mut lines = Lines::new(b"a\nb\nc\n", |line: &str, _| match line {
            "b" => Verdict::Refuse("no b".into()),
            _ => Verdict::Pass,
        });
        assert!(lines.by_ref().lines().collect::<io::Result<Vec<_>>>().is_err());
        assert_eq!((lines.number(), lines.refusal()), (2, Some("no b".into())));
    }
}
