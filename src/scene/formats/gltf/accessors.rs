//! Accessors: every declared size checked against the bytes that are there, before any is read.

use super::buffers::Buffers;
use super::schema::{Accessor, Document};

/// Bytes of one component by `componentType`, with the names that the specification uses.
const COMPONENTS: [(u64, usize, &str); 6] = [
    (5120, 1, "BYTE"),
    (5121, 1, "UNSIGNED_BYTE"),
    (5122, 2, "SHORT"),
    (5123, 2, "UNSIGNED_SHORT"),
    (5125, 4, "UNSIGNED_INT"),
    (5126, 4, "FLOAT"),
];
const FLOAT: u64 = 5126;

/// The largest `byteStride` that the specification allows.
const MAX_STRIDE: u64 = 252;

/// Elements of an accessor whose bytes are all there.
#[derive(Clone, Copy)]
pub(super) struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    fn element(&self, index: usize) -> &'a [u8] {
        let start = index * self.stride;
        &self.bytes[start..start + self.size]
    }

    /// An element of three floats.
    pub(super) fn vec3(&self, index: usize) -> [f32; 3] {
        let bytes = self.element(index);
        [0, 4, 8].map(|at| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
    }

    /// An element of one unsigned integer of one, two or four bytes.
    pub(super) fn unsigned(&self, index: usize) -> u32 {
        let mut wide = [0; 4];
        wide[..self.size].copy_from_slice(self.element(index));
        u32::from_le_bytes(wide)
    }
}

/// Finds an accessor.
pub(super) fn find(document: &Document, index: u64) -> Result<&Accessor, String> {
    let accessor = usize::try_from(index).ok().and_then(|i| document.accessors.get(i));
    accessor.ok_or_else(|| format!("accessor {index} of {}", document.accessors.len()))
}

/// An accessor of three floats an element.
pub(super) fn vectors<'a>(
    document: &Document,
    buffers: &'a Buffers,
    index: u64,
) -> Result<Elements<'a>, String> {
    let expected = |a: &Accessor| a.component_type == FLOAT && a.shape == "VEC3";
    checked(document, buffers, index, expected, "VEC3 of FLOAT")
}

/// An accessor of one unsigned integer an element.
pub(super) fn scalars<'a>(
    document: &Document,
    buffers: &'a Buffers,
    index: u64,
) -> Result<Elements<'a>, String> {
    let expected = |a: &Accessor| matches!(a.component_type, 5121 | 5123 | 5125) && a.shape == "SCALAR";
    checked(document, buffers, index, expected, "SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT")
}

fn checked<'a>(
    document: &Document,
    buffers: &'a Buffers,
    index: u64,
    is_expected: impl Fn(&Accessor) -> bool,
    expected: &str,
) -> Result<Elements<'a>, String> {
    let accessor = find(document, index)?;
    let at = |why: String| format!("accessor {index}: {why}");
    if accessor.sparse.is_some() {
        return Err(at("sparse accessors are not supported".into()));
    }
    let component = COMPONENTS.iter().find(|(code, ..)| *code == accessor.component_type);
    let (true, Some(&(_, component_size, _))) = (is_expected(accessor), component) else {
        let kind = component.map_or_else(|| accessor.component_type.to_string(), |(.., name)| (*name).into());
        let shape = crate::scene::formats::text::printable(&accessor.shape);
        return Err(at(format!("expected {expected}, found {shape} of {kind}")));
    };
    let Some(view_index) = accessor.buffer_view else {
        return Err(at("expected a bufferView".into()));
    };
    let views = &document.buffer_views;
    let view = usize::try_from(view_index).ok().and_then(|i| views.get(i));
    let view = view.ok_or_else(|| at(format!("bufferView {view_index} of {}", views.len())))?;

    let size = component_size as u64 * if accessor.shape == "VEC3" { 3 } else { 1 };
    let stride = view.byte_stride.unwrap_or(size);
    if stride < size || stride > MAX_STRIDE {
        let why = format!("bufferView {view_index}: byteStride {stride}, expected {size} to {MAX_STRIDE}");
        return Err(at(why));
    }
    // All arithmetic is checked: offsets and counts go up to 2^64.
    let used = match accessor.count {
        0 => Some(0),
        count => (count - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size)),
    };
    let end = used.and_then(|used| used.checked_add(accessor.byte_offset));
    if end.is_none_or(|end| end > view.byte_length) {
        return Err(at(format!(
            "{} elements of {size} bytes, {stride} apart, from byte {} on, exceed the {} bytes of bufferView {view_index}",
            accessor.count, accessor.byte_offset, view.byte_length
        )));
    }
    let buffer = buffers.bytes(view.buffer).map_err(|why| at(format!("bufferView {view_index}: {why}")))?;
    let view_end = view.byte_offset.checked_add(view.byte_length);
    if view_end.is_none_or(|end| end > buffer.len() as u64) {
        return Err(at(format!(
            "bufferView {view_index}: {} bytes from byte {} on exceed the {} of buffer {}",
            view.byte_length,
            view.byte_offset,
            buffer.len(),
            view.buffer
        )));
    }
    // Both ends were just found to lie inside the buffer, which lies in memory: the casts cannot cut.
    let start = (view.byte_offset + accessor.byte_offset) as usize;
    Ok(Elements {
        bytes: &buffer[start..(view.byte_offset + view.byte_length) as usize],
        stride: stride as usize,
        size: size as usize,
        count: accessor.count as usize,
    })
}
