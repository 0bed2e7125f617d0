//! The words of an NFF file, and the lines that they stand in.

use crate::scene::formats::text::printable;

/// A line number and what is wrong there.
pub(super) type Complaint = (usize, String);

/// Takes the words of a text one after the other. `#` and what follows it in a line is no word.
pub(super) struct Words<'a> {
    /// After the current line.
    rest: &'a [u8],
    /// What is left of the current line, without remarks.
    line: &'a [u8],
    number: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a [u8]) -> Words<'a> {
        let rest = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        Words { rest, line: b"", number: 0 }
    }

    /// The number of the line of the last word, from 1.
    pub(super) fn line(&self) -> usize {
        self.number.max(1)
    }

    /// The first word of the next line that has one; `None` at the end of the file.
    ///
    /// # Errors
    /// If words of the current line are left: what begins an entity begins a line.
    pub(super) fn entity(&mut self) -> Result<Option<&'a [u8]>, Complaint> {
        if let Some(word) = self.rest_of_line() {
            return Err((self.line(), format!("expected the end of the line, found `{}`", shown(word))));
        }
        Ok(self.any())
    }

    /// The first word of the next line that has one, without going there.
    pub(super) fn peek_entity(&self) -> Option<&'a [u8]> {
        Words { rest: self.rest, line: b"", number: 0 }.any()
    }

    /// The next word of the current line.
    pub(super) fn rest_of_line(&mut self) -> Option<&'a [u8]> {
        let line = self.line.trim_ascii_start();
        let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        let (word, rest) = line.split_at(end);
        self.line = rest;
        (!word.is_empty()).then_some(word)
    }

    /// The next word of the file, in whatever line.
    fn any(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.rest_of_line() {
                return Some(word);
            }
            if self.rest.is_empty() {
                return None;
            }
            let end = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
            let line = &self.rest[..end];
            self.rest = self.rest.get(end + 1..).unwrap_or(b"");
            self.line = line.split(|&b| b == b'#').next().unwrap_or(b"");
            self.number += 1;
        }
    }

    /// The next word of the file as a number of the entity that is being read.
    pub(super) fn parsed<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, Complaint> {
        let Some(word) = self.any() else {
            return Err((self.line(), format!("expected {what}, found the end of the file")));
        };
        parse(word, what).map_err(|why| (self.line(), why))
    }

    /// Any numbers, NaN and infinite ones among them: primitives that have such corners are dropped later.
    pub(super) fn numbers<const N: usize>(&mut self) -> Result<[f32; N], Complaint> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.parsed("a number")?;
        }
        Ok(numbers)
    }

    /// Numbers of something that cannot be dropped.
    pub(super) fn finite<const N: usize>(&mut self) -> Result<[f32; N], Complaint> {
        let mut numbers = [0.0f32; N];
        for number in &mut numbers {
            *number = self.parsed("a number")?;
            if !number.is_finite() {
                return Err((self.line(), format!("expected a finite number, found {number}")));
            }
        }
        Ok(numbers)
    }

    /// The number of corners of a polygon, if what is left of the file can hold as many.
    pub(super) fn count(&mut self, numbers_each: usize) -> Result<usize, Complaint> {
        let count: u64 = self.parsed("a number of corners")?;
        // A digit each and what separates them.
        let left = self.line.len() + self.rest.len();
        let room = left.div_ceil(2) / numbers_each;
        match usize::try_from(count) {
            Ok(count) if count <= room => Ok(count),
            _ => Err((
                self.line(),
                format!("a polygon of {count} corners, and there is room for {room} in the rest of the file"),
            )),
        }
    }
}

/// A word as something else.
pub(super) fn parse<T: std::str::FromStr>(word: &[u8], what: &str) -> Result<T, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
    parsed.ok_or_else(|| format!("expected {what}, found `{}`", shown(word)))
}

/// A word for a message.
pub(super) fn shown(word: &[u8]) -> String {
    printable(&String::from_utf8_lossy(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_line_and_remarks_are_none() {
        let mut words = Words::new(b"\xef\xbb\xbf\n# all \xff\n p 2#x\r\n1 2\n\n 3 nan\nq r\n");
        assert_eq!(words.entity(), Ok(Some(&b"p"[..])));
        assert_eq!((words.line(), words.count(1)), (3, Ok(2)));
        assert_eq!(words.numbers(), Ok([1.0, 2.0, 3.0]));
        assert_eq!(words.line(), 6);
        assert_eq!(words.finite::<1>(), Err((6, "expected a finite number, found NaN".into())));
        assert_eq!(words.peek_entity(), Some(&b"q"[..]));
        assert_eq!(words.entity(), Ok(Some(&b"q"[..])));
        assert_eq!(words.entity(), Err((7, "expected the end of the line, found `r`".into())));
        assert_eq!(words.entity(), Ok(None));
        assert_eq!(words.numbers::<1>(), Err((7, "expected a number, found the end of the file".into())));
    }

    #[test]
    fn a_count_needs_room_in_the_file() {
        let count = |text: &[u8]| {
            let mut words = Words::new(text);
            words.entity().unwrap();
            words.count(3)
        };
        assert_eq!(count(b"p 1\n1 2 3"), Ok(1));
        let why = "a polygon of 2 corners, and there is room for 1 in the rest of the file";
        assert_eq!(count(b"p 2\n1 2 3"), Err((1, why.into())));
        assert!(count(b"p 18446744073709551615\n").is_err());
        assert!(count(b"p 18446744073709551616\n").is_err());
    }
}
