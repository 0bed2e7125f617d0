//! The body of a PLY file, value by value.

use super::header::{Encoding, Scalar};
use crate::error::Place;
use crate::scene::formats::text::printable;

/// A place in the body, from which values are taken one after the other.
///
/// Every error is the part of a message that comes after the place.
pub(super) trait Values: Clone {
    /// To be called before the first value of an element.
    fn begin(&mut self) -> Result<(), String>;

    /// To be called after the last value of an element.
    fn end(&mut self) -> Result<(), String>;

    /// A number of any type, rounded once.
    fn number(&mut self, scalar: Scalar) -> Result<f32, String>;

    /// A whole number.
    fn whole(&mut self, scalar: Scalar) -> Result<i64, String>;

    /// Passes over numbers.
    fn skip(&mut self, scalar: Scalar, count: usize) -> Result<(), String>;

    /// The most numbers that there is still room for, in the element if its end is known.
    fn room_for(&self, item: Scalar) -> usize;

    /// Where the last value was taken, or where the next would have been.
    fn place(&self, element: &str, index: u64) -> Place;

    /// What is left behind the last element, in words.
    fn left_over(&self) -> Option<String>;
}

/// The length of a list, if the body can hold that many.
pub(super) fn length(values: &mut impl Values, length: Scalar, item: Scalar) -> Result<usize, String> {
    let declared = values.whole(length)?;
    let room = values.room_for(item);
    match usize::try_from(declared) {
        Ok(length) if length <= room => Ok(length),
        Ok(_) => Err(format!("a list declares {declared} numbers, and there is room for {room}")),
        Err(_) => Err(format!("expected the length of a list, found {declared}")),
    }
}

/// Text: a line an element.
#[derive(Clone)]
pub(super) struct Text<'a> {
    /// After the current line.
    rest: &'a [u8],
    line_end: u8,
    /// What is left of the current line.
    line: &'a [u8],
    number: usize,
    next_number: usize,
}

impl<'a> Text<'a> {
    /// A body whose first line has this number.
    pub(super) fn new(body: &'a [u8], line_end: u8, number: usize) -> Text<'a> {
        Text { rest: body, line_end, line: b"", number, next_number: number }
    }

    fn word(&mut self) -> Result<&'a [u8], String> {
        let line = self.line.trim_ascii_start();
        let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
        let (word, rest) = line.split_at(end);
        self.line = rest;
        match word {
            [] => Err("expected another number, found the end of the line".into()),
            _ => Ok(word),
        }
    }
}

fn parsed<T: std::str::FromStr>(word: &[u8], what: &str) -> Result<T, String> {
    let number = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
    number.ok_or_else(|| format!("expected {what}, found `{}`", printable(&String::from_utf8_lossy(word))))
}

impl Values for Text<'_> {
    fn begin(&mut self) -> Result<(), String> {
        loop {
            if self.rest.is_empty() {
                return Err("expected another line, found the end of the file".into());
            }
            let end = self.rest.iter().position(|&b| b == self.line_end).unwrap_or(self.rest.len());
            self.line = self.rest[..end].trim_ascii();
            self.rest = self.rest.get(end + 1..).unwrap_or(b"");
            self.number = self.next_number;
            self.next_number += 1;
            if !self.line.is_empty() {
                return Ok(());
            }
        }
    }

    fn end(&mut self) -> Result<(), String> {
        match self.word() {
            Ok(word) => {
                let word = String::from_utf8_lossy(word);
                Err(format!("expected the end of the line, found `{}`", printable(&word)))
            }
            Err(_) => Ok(()),
        }
    }

    fn number(&mut self, _: Scalar) -> Result<f32, String> {
        parsed(self.word()?, "a number")
    }

    fn whole(&mut self, _: Scalar) -> Result<i64, String> {
        parsed(self.word()?, "a whole number")
    }

    fn skip(&mut self, _: Scalar, count: usize) -> Result<(), String> {
        (0..count).try_for_each(|_| self.word().map(|_| ()))
    }

    fn room_for(&self, _: Scalar) -> usize {
        // A digit each and what separates them.
        self.line.len().div_ceil(2)
    }

    fn place(&self, _: &str, _: u64) -> Place {
        Place::Line(self.number)
    }

    fn left_over(&self) -> Option<String> {
        let mut rest = self.clone();
        rest.begin().ok().map(|()| format!("all from line {} on", rest.number))
    }
}

/// Numbers in binary.
#[derive(Clone)]
pub(super) struct Binary<'a> {
    file: &'a [u8],
    position: usize,
    /// Where the last value was taken.
    last: usize,
    encoding: Encoding,
}

impl<'a> Binary<'a> {
    /// A file whose body begins at a byte.
    pub(super) fn new(file: &'a [u8], body: usize, encoding: Encoding) -> Binary<'a> {
        Binary { file, position: body, last: body, encoding }
    }

    fn left(&self) -> usize {
        self.file.len() - self.position
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        self.last = self.position;
        let bytes = self.file[self.position..].first_chunk::<N>();
        let mut bytes = *bytes.ok_or_else(|| {
            format!("expected {N} more bytes, found the end of the file after {}", self.left())
        })?;
        self.position += N;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl Values for Binary<'_> {
    fn begin(&mut self) -> Result<(), String> {
        Ok(())
    }

    fn end(&mut self) -> Result<(), String> {
        Ok(())
    }

    fn number(&mut self, scalar: Scalar) -> Result<f32, String> {
        match scalar {
            Scalar::F32 => self.take().map(f32::from_le_bytes),
            Scalar::F64 => self.take().map(|bytes| f64::from_le_bytes(bytes) as f32),
            whole => self.whole(whole).map(|value| value as f32),
        }
    }

    fn whole(&mut self, scalar: Scalar) -> Result<i64, String> {
        match scalar {
            Scalar::I8 => self.take().map(|bytes| i8::from_le_bytes(bytes).into()),
            Scalar::U8 => self.take().map(|bytes| u8::from_le_bytes(bytes).into()),
            Scalar::I16 => self.take().map(|bytes| i16::from_le_bytes(bytes).into()),
            Scalar::U16 => self.take().map(|bytes| u16::from_le_bytes(bytes).into()),
            Scalar::I32 => self.take().map(|bytes| i32::from_le_bytes(bytes).into()),
            Scalar::U32 => self.take().map(|bytes| u32::from_le_bytes(bytes).into()),
            Scalar::F32 | Scalar::F64 => Err("expected a whole number, found a float".into()),
        }
    }

    fn skip(&mut self, scalar: Scalar, count: usize) -> Result<(), String> {
        self.last = self.position;
        let bytes = scalar.bytes().checked_mul(count).filter(|&bytes| bytes <= self.left());
        self.position += bytes.ok_or_else(|| {
            format!("expected {count} more numbers, found the end of the file after {} bytes", self.left())
        })?;
        Ok(())
    }

    fn room_for(&self, item: Scalar) -> usize {
        self.left() / item.bytes()
    }

    fn place(&self, element: &str, index: u64) -> Place {
        Place::Element(format!("{} {index}, byte {}", printable(element), self.last))
    }

    fn left_over(&self) -> Option<String> {
        (self.left() > 0).then(|| format!("{} bytes", self.left()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_text_is_an_element() {
        let mut text = Text::new(b"\n1 -2.5 nan\r\n \r\n3\t4\r\nrest", b'\n', 7);
        text.begin().unwrap();
        assert_eq!(text.place("vertex", 0), Place::Line(8));
        assert_eq!(text.whole(Scalar::I8), Ok(1));
        assert_eq!(text.number(Scalar::F32), Ok(-2.5));
        assert!(text.number(Scalar::F32).unwrap().is_nan());
        assert!(text.number(Scalar::F32).is_err());
        assert_eq!(text.end(), Ok(()));
        text.begin().unwrap();
        assert_eq!(text.room_for(Scalar::F64), 2);
        text.skip(Scalar::U8, 1).unwrap();
        assert_eq!(text.end(), Err("expected the end of the line, found `4`".into()));
        assert_eq!(text.left_over(), Some("all from line 11 on".into()));
    }

    #[test]
    fn numbers_are_read_in_both_orders() {
        let bytes = |encoding: Encoding| {
            let mut all = Vec::new();
            let mut put = |little: &[u8]| {
                let mut bytes = little.to_vec();
                if encoding == Encoding::BigEndian {
                    bytes.reverse();
                }
                all.extend(bytes);
            };
            put(&[0xfe]);
            put(&[0xfe]);
            put(&(-300i16).to_le_bytes());
            put(&65535u16.to_le_bytes());
            put(&(-70_000i32).to_le_bytes());
            put(&u32::MAX.to_le_bytes());
            put(&0.1f32.to_le_bytes());
            put(&0.1f64.to_le_bytes());
            all
        };
        for encoding in [Encoding::LittleEndian, Encoding::BigEndian] {
            let file = bytes(encoding);
            let mut values = Binary::new(&file, 0, encoding);
            let whole = [Scalar::I8, Scalar::U8, Scalar::I16, Scalar::U16, Scalar::I32, Scalar::U32];
            let found: Vec<i64> = whole.iter().map(|&scalar| values.whole(scalar).unwrap()).collect();
            assert_eq!(found, [-2, 254, -300, 65535, -70_000, 4_294_967_295]);
            assert_eq!(values.number(Scalar::F32), Ok(0.1));
            assert_eq!(values.number(Scalar::F64), Ok(0.1));
            assert_eq!(
                (values.left_over(), values.place("face", 3)),
                (None, Place::Element("face 3, byte 18".into()))
            );
            assert!(values.number(Scalar::I8).is_err());
        }
    }
}
