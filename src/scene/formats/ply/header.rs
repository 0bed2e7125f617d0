//! The header of a PLY file: what the body holds, and how it is written.

use crate::scene::formats::limits::MAX_PLY_HEADER_BYTES;
use crate::scene::formats::text::printable;
use std::collections::BTreeSet;

/// How the body is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// The type of either spelling.
    fn named(name: &str) -> Result<Scalar, String> {
        Ok(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            other => {
                return Err(format!(
                    "expected a type such as float, uchar or int32, found `{}`",
                    printable(other)
                ));
            }
        })
    }

    /// Bytes of one number in a binary body.
    pub(super) fn bytes(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    pub(super) fn is_whole(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }
}

/// What stands for one property in each element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// One number.
    Number(Scalar),
    /// A whole number, and then as many numbers as it says.
    List { length: Scalar, item: Scalar },
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// The line that declares it.
    pub(super) line: usize,
}

/// A run of elements in the body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// The line that declares it.
    pub(super) line: usize,
}

impl Element {
    /// The fewest bytes that one of them takes in the body.
    fn least_bytes(&self, encoding: Encoding) -> u64 {
        let least = |property: &Property| match (encoding, property.kind) {
            // A digit and what separates it from the next.
            (Encoding::Ascii, _) => 2,
            (_, Kind::Number(scalar)) => scalar.bytes() as u64,
            (_, Kind::List { length, .. }) => length.bytes() as u64,
        };
        self.properties.iter().map(least).sum()
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    /// In the order of the body.
    pub(super) elements: Vec<Element>,
    /// Whether a comment names a texture, as MeshLab writes it.
    pub(super) textured: bool,
    /// What ends a line of text.
    pub(super) line_end: u8,
    /// Where the body begins, in bytes.
    pub(super) body: usize,
    /// The number of the body's first line.
    pub(super) body_line: usize,
}

/// Reads the header, and checks the counts that it declares against the bytes that follow.
///
/// # Errors
/// A line number and what is wrong there.
pub(super) fn parse(file: &[u8]) -> Result<Header, (usize, String)> {
    let head = &file[..file.len().min(MAX_PLY_HEADER_BYTES)];
    // Old Macs end lines by a carriage return alone; then a line feed may be the body's first byte.
    let line_end = if head.starts_with(b"ply\r") && !head.starts_with(b"ply\r\n") { b'\r' } else { b'\n' };
    let mut parser = Parser::default();
    let (mut start, mut number) = (0, 0);
    loop {
        number += 1;
        let Some(length) = head[start..].iter().position(|&b| b == line_end) else {
            let why = match (number, file.len() > head.len()) {
                (1, _) => "expected a PLY file, which begins with a line `ply`".into(),
                (_, true) => format!("expected `end_header` within the first {MAX_PLY_HEADER_BYTES} bytes"),
                (_, false) => "expected `end_header`, found the end of the file".into(),
            };
            return Err((number, why));
        };
        let line = String::from_utf8_lossy(&head[start..start + length]);
        start += length + 1;
        if parser.line(&line, number).map_err(|why| (number, why))? == Progress::Done {
            break;
        }
    }
    let Some(encoding) = parser.encoding else {
        return Err((number, "expected a line `format` before `end_header`".into()));
    };
    let header = Header {
        encoding,
        elements: parser.elements,
        textured: parser.textured,
        line_end,
        body: start,
        body_line: number + 1,
    };
    header.check_counts(file.len() - start)?;
    Ok(header)
}

impl Header {
    /// Whether all elements can be there, before memory is asked for any.
    fn check_counts(&self, body: usize) -> Result<(), (usize, String)> {
        // The last line of a text needs no end.
        let mut left = body as u64 + u64::from(self.encoding == Encoding::Ascii);
        for element in &self.elements {
            let least = element.least_bytes(self.encoding);
            let all = least.checked_mul(element.count).filter(|&all| all <= left);
            left -= all.ok_or_else(|| {
                let Element { name, count, line, .. } = element;
                (
                    *line,
                    format!(
                        "element `{}`: it declares {count} of at least {least} bytes, and {left} are left",
                        printable(name)
                    ),
                )
            })?;
        }
        Ok(())
    }
}

#[derive(Debug, PartialEq, Eq)]
enum Progress {
    Open,
    Done,
}

#[derive(Default)]
struct Parser {
    encoding: Option<Encoding>,
    elements: Vec<Element>,
    textured: bool,
    element_names: BTreeSet<String>,
    /// Of the last element.
    property_names: BTreeSet<String>,
}

impl Parser {
    fn line(&mut self, line: &str, number: usize) -> Result<Progress, String> {
        let mut words = line.split_ascii_whitespace();
        let keyword = words.next().unwrap_or("");
        if number == 1 {
            return match keyword {
                "ply" => Ok(Progress::Open),
                _ => Err("expected a PLY file, which begins with a line `ply`".into()),
            };
        }
        match keyword {
            "comment" => self.textured |= words.next() == Some("TextureFile"),
            "obj_info" | "" => {}
            "format" => self.format(words)?,
            "element" => self.element(words, number)?,
            "property" => self.property(words, number)?,
            "end_header" => return Ok(Progress::Done),
            other => {
                return Err(format!(
                    "expected format, element, property, comment or end_header, found `{}`",
                    printable(other)
                ));
            }
        }
        Ok(Progress::Open)
    }

    fn format<'w>(&mut self, mut words: impl Iterator<Item = &'w str>) -> Result<(), String> {
        if self.encoding.is_some() {
            return Err("a second line `format`".into());
        }
        let encoding = match words.next() {
            Some("ascii") => Encoding::Ascii,
            Some("binary_little_endian") => Encoding::LittleEndian,
            Some("binary_big_endian") => Encoding::BigEndian,
            other => {
                return Err(format!(
                    "expected the format ascii, binary_little_endian or binary_big_endian, found `{}`",
                    printable(other.unwrap_or(""))
                ));
            }
        };
        match words.next() {
            Some("1.0") => self.encoding = Some(encoding),
            other => {
                return Err(format!("expected version 1.0, found `{}`", printable(other.unwrap_or(""))));
            }
        }
        Ok(())
    }

    fn element<'w>(&mut self, mut words: impl Iterator<Item = &'w str>, line: usize) -> Result<(), String> {
        let (Some(name), Some(count), None) = (words.next(), words.next(), words.next()) else {
            return Err("expected a name and a count after `element`".into());
        };
        let count = count.parse().map_err(|_| format!("expected a count, found `{}`", printable(count)))?;
        if !self.element_names.insert(name.into()) {
            return Err(format!("a second element `{}`", printable(name)));
        }
        self.property_names.clear();
        self.elements.push(Element { name: name.into(), count, properties: Vec::new(), line });
        Ok(())
    }

    fn property<'w>(&mut self, mut words: impl Iterator<Item = &'w str>, line: usize) -> Result<(), String> {
        let Some(element) = self.elements.last_mut() else {
            return Err("expected an element before its properties".into());
        };
        let kind = match words.next().unwrap_or("") {
            "list" => {
                let length = Scalar::named(words.next().unwrap_or(""))?;
                let item = Scalar::named(words.next().unwrap_or(""))?;
                if !length.is_whole() {
                    return Err("expected a whole number as the type of a list's length".into());
                }
                Kind::List { length, item }
            }
            scalar => Kind::Number(Scalar::named(scalar)?),
        };
        let (Some(name), None) = (words.next(), words.next()) else {
            return Err("expected a name after the type of the property".into());
        };
        // Both could not be told apart, and a reader that took one for the other would read on elsewhere.
        if !self.property_names.insert(name.into()) {
            return Err(format!("a second property `{}`", printable(name)));
        }
        element.properties.push(Property { name: name.into(), kind, line });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_spellings_of_every_type_are_known() {
        for (old, new, bytes) in [
            ("char", "int8", 1),
            ("uchar", "uint8", 1),
            ("short", "int16", 2),
            ("ushort", "uint16", 2),
            ("int", "int32", 4),
            ("uint", "uint32", 4),
            ("float", "float32", 4),
            ("double", "float64", 8),
        ] {
            let scalar = Scalar::named(old).unwrap();
            assert_eq!((Scalar::named(new), scalar.bytes()), (Ok(scalar), bytes));
        }
    }

    #[test]
    fn a_body_begins_after_the_end_of_its_own_line() {
        for (end, line_end) in [("\n", b'\n'), ("\r\n", b'\n'), ("\r", b'\r')] {
            let text = ["ply", "format binary_big_endian 1.0", "comment \u{e9}", "end_header", ""].join(end);
            let file = [text.as_bytes(), b"\nbody"].concat();
            let header = parse(&file).unwrap();
            assert_eq!((header.line_end, header.body_line), (line_end, 5));
            assert_eq!(&file[header.body..], b"\nbody");
        }
    }

    #[test]
    fn counts_are_held_against_the_bytes_left() {
        let file = |count: &str, body: &str| {
            format!(
                "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty list int int y\n\
                 end_header\n{body}"
            )
        };
        assert!(parse(file("2", "1 0\n2 0").as_bytes()).is_ok());
        let (line, why) = parse(file("3", "1 0\n2 0\n").as_bytes()).unwrap_err();
        assert_eq!(line, 3);
        assert_eq!(why, "element `vertex`: it declares 3 of at least 4 bytes, and 9 are left");
        assert!(parse(file(&u64::MAX.to_string(), "1 0\n").as_bytes()).is_err());
    }
}
