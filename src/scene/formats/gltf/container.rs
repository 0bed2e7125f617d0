//! From bytes to the JSON document and the binary chunk.

use super::Container;
use super::schema::Document;
use crate::error::{Error, Place, Result};
use crate::scene::formats::limits::{MAX_JSON_OBJECTS, MAX_JSON_VALUES};
use crate::scene::formats::text::printable;
use std::path::Path;

/// The two parts of a glTF file.
pub(super) struct Parts<'a> {
    pub(super) document: Document,
    /// The binary chunk of a GLB file, if it has one.
    pub(super) binary: Option<&'a [u8]>,
}

/// Splits and parses a file. What the file is decides, not its name: exporters mix up the extensions.
pub(super) fn open<'a>(path: &Path, bytes: &'a [u8], named: Container) -> Result<Parts<'a>> {
    let is_binary = bytes.starts_with(b"glTF");
    if !is_binary && named == Container::Binary {
        let what = "expected a GLB file, which begins with `glTF`";
        return Err(Error::input(path, Place::File, what));
    }
    if !is_binary {
        let document = parse(bytes).map_err(|(line, _, why)| Error::input(path, Place::Line(line), why))?;
        return Ok(Parts { document, binary: None });
    }
    let (json, binary) = split(bytes)
        .map_err(|(place, why)| Error::input(path, Place::Element(format!("GLB {place}")), why))?;
    let document = parse(json).map_err(|(line, column, why)| {
        Error::input(path, Place::Element(format!("JSON chunk, line {line}, column {column}")), why)
    })?;
    Ok(Parts { document, binary })
}

/// The JSON and the binary chunk of a GLB file.
type Chunks<'a> = (&'a [u8], Option<&'a [u8]>);

/// Splits a GLB file; chunks of other types are for extensions and passed over.
fn split(bytes: &[u8]) -> std::result::Result<Chunks<'_>, (&'static str, String)> {
    let number = |at: usize| -> Option<u32> {
        Some(u32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().ok()?))
    };
    let (Some(version), Some(length)) = (number(4), number(8)) else {
        return Err(("header", format!("expected 12 bytes, found {}", bytes.len())));
    };
    if version != 2 {
        return Err(("header", format!("expected version 2, found {version}")));
    }
    if length as usize != bytes.len() {
        return Err(("header", format!("it declares {length} bytes, and the file holds {}", bytes.len())));
    }
    let chunk = |at: usize, name: &'static str| {
        let (Some(length), Some(kind)) = (number(at), bytes.get(at + 4..at + 8)) else {
            return Err((name, "expected 8 bytes of a chunk's header, found the file's end".into()));
        };
        let left = bytes.len() - (at + 8);
        if length as usize > left {
            return Err((name, format!("it declares {length} bytes, and {left} are left")));
        }
        let end = at + 8 + length as usize;
        Ok((kind, &bytes[at + 8..end], end))
    };
    let (kind, json, mut end) = chunk(12, "JSON chunk")?;
    if kind != b"JSON" {
        let found = printable(&String::from_utf8_lossy(kind));
        return Err(("JSON chunk", format!("expected the type `JSON`, found `{found}`")));
    }
    while end < bytes.len() {
        let (kind, content, next) = chunk(end, "binary chunk")?;
        if kind == b"BIN\0" {
            return Ok((json, Some(content)));
        }
        end = next;
    }
    Ok((json, None))
}

/// Parses JSON; an error has line, column and message.
fn parse(json: &[u8]) -> std::result::Result<Document, (usize, usize, String)> {
    check_size(json).map_err(|why| (1, 1, why))?;
    serde_json::from_slice(json).map_err(|error| {
        let (line, column) = (error.line().max(1), error.column());
        let text = error.to_string();
        let tail = format!(" at line {} column {}", error.line(), error.column());
        (line, column, format!("{} (column {column})", printable(text.strip_suffix(&tail).unwrap_or(&text))))
    })
}

/// Bounds what parsing can allocate, by the marks that begin or separate values.
fn check_size(json: &[u8]) -> std::result::Result<(), String> {
    let (mut objects, mut values) = (0, 0);
    let mut in_string = false;
    let mut bytes = json.iter();
    while let Some(byte) = bytes.next() {
        match byte {
            b'"' => in_string = !in_string,
            // What is escaped cannot end the string.
            b'\\' if in_string => _ = bytes.next(),
            b'{' if !in_string => objects += 1,
            b'[' | b',' if !in_string => values += 1,
            _ => {}
        }
    }
    if objects > MAX_JSON_OBJECTS || values > MAX_JSON_VALUES {
        return Err(format!(
            "expected at most {MAX_JSON_OBJECTS} objects and {MAX_JSON_VALUES} values, found {objects} and {values}"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_inside_strings_do_not_count() {
        let object = b"{\"a\\\"{{{\":\"{\\\\\",\"b\":[1,2]},";
        let few = object.repeat(MAX_JSON_OBJECTS);
        assert!(check_size(&few).is_ok());
        assert!(check_size(&object.repeat(MAX_JSON_OBJECTS + 1)).is_err());
    }
}
