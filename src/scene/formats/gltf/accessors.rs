//! Accessors: every declared size checked against the bytes that are there, before any is read.

use super::buffers::Buffers;
use super::components::Component;
use super::schema::{Accessor, BufferView, Document};
use super::sparse::Sparse;
use crate::scene::formats::limits::MAX_ZEROS;
use crate::scene::formats::text::printable;
use glam::DVec3;
use std::cell::RefCell;
use std::collections::BTreeSet;

/// The largest `byteStride` that the specification allows.
const MAX_STRIDE: u64 = 252;

/// What an accessor is asked for; see [`Wanted::accepts`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Integers, one an element.
    Indices,
    /// Positions.
    Positions,
    /// Directions of length 1, and how much they change.
    Normals,
    /// How much a morph target moves positions.
    Displacements,
    /// Texture coordinates, and how much they change.
    TextureCoordinates,
    /// Three floats an element.
    Vectors,
    /// Quaternions.
    Rotations,
    /// The same in animations, which may have more types of components.
    Turns,
    /// Seconds.
    Times,
    /// Four indices of joints an element.
    Joints,
    /// Four weights of joints an element.
    Weights,
    /// Matrices of 4 by 4 floats.
    Matrices,
}

impl Wanted {
    /// The accessor's `type`, and how many numbers that is.
    fn shape(self) -> (&'static str, usize) {
        match self {
            Wanted::Indices | Wanted::Times => ("SCALAR", 1),
            Wanted::TextureCoordinates => ("VEC2", 2),
            Wanted::Positions | Wanted::Normals | Wanted::Displacements | Wanted::Vectors => ("VEC3", 3),
            Wanted::Rotations | Wanted::Turns | Wanted::Joints | Wanted::Weights => ("VEC4", 4),
            Wanted::Matrices => ("MAT4", 16),
        }
    }

    /// Whether the specification allows a type of components here, with `KHR_mesh_quantization` or without.
    fn accepts(self, component: Component, normalized: bool, quantized: bool) -> bool {
        use Component::{Byte, Float, Short, UnsignedByte, UnsignedInt, UnsignedShort};
        let signed = matches!(component, Byte | Short);
        let unsigned = matches!(component, UnsignedByte | UnsignedShort);
        match self {
            Wanted::Indices => unsigned || component == UnsignedInt,
            Wanted::Joints => unsigned,
            Wanted::Vectors | Wanted::Matrices | Wanted::Times => component == Float,
            Wanted::Rotations => component == Float || (signed && normalized),
            Wanted::Turns => component == Float || ((signed || unsigned) && normalized),
            Wanted::Weights => component == Float || (unsigned && normalized),
            Wanted::Positions => component == Float || (quantized && (signed || unsigned)),
            Wanted::Displacements => component == Float || (quantized && signed),
            Wanted::Normals => component == Float || (quantized && signed && normalized),
            Wanted::TextureCoordinates => {
                component == Float || (unsigned && normalized) || (quantized && (signed || unsigned))
            }
        }
    }

    /// The components that are accepted, for messages.
    fn components(self, quantized: bool) -> &'static str {
        match self {
            Wanted::Indices => "UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT",
            Wanted::Joints => "UNSIGNED_BYTE or UNSIGNED_SHORT",
            Wanted::Weights => "FLOAT or normalized UNSIGNED_BYTE or UNSIGNED_SHORT",
            Wanted::Turns => "FLOAT or normalized integers of 8 or 16 bits",
            Wanted::Rotations => "FLOAT or normalized BYTE or SHORT",
            Wanted::TextureCoordinates if !quantized => "FLOAT or normalized UNSIGNED_BYTE or UNSIGNED_SHORT",
            Wanted::Positions | Wanted::TextureCoordinates if quantized => {
                "FLOAT or integers of 8 or 16 bits"
            }
            Wanted::Displacements if quantized => "FLOAT, BYTE or SHORT",
            Wanted::Normals if quantized => "FLOAT or normalized BYTE or SHORT",
            _ => "FLOAT",
        }
    }
}

/// Elements that stand in memory one after the other, at one distance.
#[derive(Clone, Copy)]
pub(super) struct Packed<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Packed<'a> {
    pub(super) fn element(&self, index: usize) -> &'a [u8] {
        let start = index * self.stride;
        &self.bytes[start..start + self.size]
    }
}

/// Elements of an accessor whose bytes are all there.
#[derive(Clone, Copy)]
pub(super) struct Elements<'a> {
    /// `None` where all is zero that is not in `sparse`.
    packed: Option<Packed<'a>>,
    sparse: Option<Sparse<'a>>,
    component: Component,
    normalized: bool,
    count: usize,
}

impl<'a> Elements<'a> {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    fn bytes(&self, index: usize) -> &'a [u8] {
        let replaced = self.sparse.and_then(|sparse| sparse.find(index));
        replaced.or_else(|| self.packed.map(|packed| packed.element(index))).unwrap_or(&[])
    }

    /// The first numbers of an element.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> [f64; N] {
        let bytes = self.bytes(index);
        std::array::from_fn(|lane| {
            let number = self.component.decode(bytes.get(lane * self.component.size()..).unwrap_or(&[]));
            if self.normalized { self.component.normalize(number) } else { number }
        })
    }

    /// An element of three numbers.
    pub(super) fn vec3(&self, index: usize) -> DVec3 {
        DVec3::from_array(self.numbers(index))
    }

    /// The first integers of an element that are not normalised.
    pub(super) fn integers<const N: usize>(&self, index: usize) -> [u32; N] {
        // 32 bits of f64's 53; the components are unsigned.
        self.numbers(index).map(|number| number as u32)
    }
}

/// All accessors of a document.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    quantized: bool,
    /// Sparse accessors whose indices are in order.
    looked_at: RefCell<BTreeSet<u64>>,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(document: &'a Document, buffers: &'a Buffers<'a>) -> Accessors<'a> {
        let mut extensions = document.extensions_used.iter().chain(&document.extensions_required);
        let quantized = extensions.any(|name| name == "KHR_mesh_quantization");
        Accessors { document, buffers, quantized, looked_at: RefCell::default() }
    }

    /// Whether this is asked about an accessor for the first time.
    pub(super) fn is_first_look(&self, index: u64) -> bool {
        self.looked_at.borrow_mut().insert(index)
    }

    /// The elements of an accessor.
    ///
    /// # Errors
    /// A line if there is no such accessor, its type is another, or bytes are missing.
    pub(super) fn read(&self, index: u64, wanted: Wanted) -> Result<Elements<'a>, String> {
        let accessor = find(self.document, index)?;
        self.elements(index, accessor, wanted).map_err(|why| format!("accessor {index}: {why}"))
    }

    fn elements(&self, index: u64, accessor: &Accessor, wanted: Wanted) -> Result<Elements<'a>, String> {
        let component = Component::from_code(accessor.component_type);
        let normalized = accessor.normalized;
        let (shape, lanes) = wanted.shape();
        let accepted = |component: &Component| {
            accessor.shape == shape && wanted.accepts(*component, normalized, self.quantized)
        };
        let Some(component) = component.filter(accepted) else {
            let kind = component.map_or_else(|| accessor.component_type.to_string(), |c| c.name().into());
            let normalized = if normalized { "normalized " } else { "" };
            let found = printable(&accessor.shape);
            let expected = wanted.components(self.quantized);
            return Err(format!("expected {shape} of {expected}, found {found} of {normalized}{kind}"));
        };
        let size = component.size() * lanes;
        let packed = match accessor.buffer_view {
            Some(view) => Some(self.strided(view, accessor.byte_offset, accessor.count, size)?),
            // Zeros take no byte of the file, so nothing else bounds them.
            None if accessor.count > MAX_ZEROS => {
                return Err(format!(
                    "{} elements without a bufferView, expected at most {MAX_ZEROS}",
                    accessor.count
                ));
            }
            None => None,
        };
        let sparse = accessor.sparse.as_ref().map(|entry| {
            Sparse::read(self, index, accessor, entry, size).map_err(|why| format!("sparse: {why}"))
        });
        Ok(Elements {
            packed,
            sparse: sparse.transpose()?,
            component,
            normalized: normalized && !matches!(wanted, Wanted::Indices | Wanted::Joints),
            // They are in memory, or at most MAX_ZEROS.
            count: accessor.count as usize,
        })
    }

    /// Elements of a view at the view's own distance.
    fn strided(&self, view: u64, offset: u64, count: u64, size: usize) -> Result<Packed<'a>, String> {
        let stride = self.view(view)?.byte_stride.unwrap_or(size as u64);
        if stride < size as u64 || stride > MAX_STRIDE {
            return Err(format!("bufferView {view}: byteStride {stride}, expected {size} to {MAX_STRIDE}"));
        }
        // At most MAX_STRIDE.
        self.within(view, offset, count, Packed { bytes: &[], stride: stride as usize, size })
    }

    /// Elements of a view one right after the other.
    ///
    /// # Errors
    /// A line if the view or its buffer does not exist, says another distance, or holds fewer bytes.
    pub(super) fn packed(
        &self,
        view: u64,
        offset: u64,
        count: u64,
        size: usize,
    ) -> Result<Packed<'a>, String> {
        match self.view(view)?.byte_stride {
            None => self.within(view, offset, count, Packed { bytes: &[], stride: size, size }),
            Some(stride) => Err(format!("bufferView {view}: expected no byteStride, found {stride}")),
        }
    }

    fn view(&self, index: u64) -> Result<&'a BufferView, String> {
        let views = &self.document.buffer_views;
        let view = usize::try_from(index).ok().and_then(|i| views.get(i));
        view.ok_or_else(|| format!("bufferView {index} of {}", views.len()))
    }

    /// Fills in the bytes. All arithmetic is checked: offsets and counts go up to 2^64.
    fn within(&self, view: u64, offset: u64, count: u64, layout: Packed<'a>) -> Result<Packed<'a>, String> {
        let (stride, size) = (layout.stride as u64, layout.size as u64);
        let length = self.view(view)?.byte_length;
        let used = match count {
            0 => Some(0),
            count => (count - 1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size)),
        };
        let end = used.and_then(|used| used.checked_add(offset));
        if end.is_none_or(|end| end > length) {
            return Err(format!(
                "{count} elements of {size} bytes, {stride} apart, from byte {offset} on, exceed the {length} \
                 bytes of bufferView {view}"
            ));
        }
        // The view's bytes lie in memory, and the offset was just found to lie inside: the cast cannot cut.
        Ok(Packed { bytes: &self.view_bytes(view)?[offset as usize..], ..layout })
    }

    /// All bytes of a view.
    ///
    /// # Errors
    /// A line if the view or its buffer does not exist, or the buffer holds fewer bytes.
    pub(super) fn view_bytes(&self, index: u64) -> Result<&'a [u8], String> {
        let view = self.view(index)?;
        let buffer = self.buffers.bytes(view.buffer).map_err(|why| format!("bufferView {index}: {why}"))?;
        let end = view.byte_offset.checked_add(view.byte_length);
        match end.filter(|&end| end <= buffer.len() as u64) {
            // Both lie inside what is in memory.
            Some(end) => Ok(&buffer[view.byte_offset as usize..end as usize]),
            None => Err(format!(
                "bufferView {index}: {} bytes from byte {} on exceed the {} of buffer {}",
                view.byte_length,
                view.byte_offset,
                buffer.len(),
                view.buffer
            )),
        }
    }
}

/// Finds an accessor.
pub(super) fn find(document: &Document, index: u64) -> Result<&Accessor, String> {
    let accessor = usize::try_from(index).ok().and_then(|i| document.accessors.get(i));
    accessor.ok_or_else(|| format!("accessor {index} of {}", document.accessors.len()))
}
