//! The numbers that accessors are made of.

/// Type of one component by the specification's `componentType`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    Byte,
    UnsignedByte,
    Short,
    UnsignedShort,
    UnsignedInt,
    Float,
}

impl Component {
    pub(super) fn from_code(code: u64) -> Option<Component> {
        Some(match code {
            5120 => Component::Byte,
            5121 => Component::UnsignedByte,
            5122 => Component::Short,
            5123 => Component::UnsignedShort,
            5125 => Component::UnsignedInt,
            5126 => Component::Float,
            _ => return None,
        })
    }

    /// The name that the specification uses.
    pub(super) fn name(self) -> &'static str {
        match self {
            Component::Byte => "BYTE",
            Component::UnsignedByte => "UNSIGNED_BYTE",
            Component::Short => "SHORT",
            Component::UnsignedShort => "UNSIGNED_SHORT",
            Component::UnsignedInt => "UNSIGNED_INT",
            Component::Float => "FLOAT",
        }
    }

    /// Bytes of one.
    pub(super) fn size(self) -> usize {
        match self {
            Component::Byte | Component::UnsignedByte => 1,
            Component::Short | Component::UnsignedShort => 2,
            Component::UnsignedInt | Component::Float => 4,
        }
    }

    /// The number in the first bytes, 0 if there are too few. Exact, as every number here is one of f64.
    pub(super) fn decode(self, bytes: &[u8]) -> f64 {
        match self {
            Component::Byte => f64::from(i8::from_le_bytes(first(bytes))),
            Component::UnsignedByte => f64::from(u8::from_le_bytes(first(bytes))),
            Component::Short => f64::from(i16::from_le_bytes(first(bytes))),
            Component::UnsignedShort => f64::from(u16::from_le_bytes(first(bytes))),
            Component::UnsignedInt => f64::from(u32::from_le_bytes(first(bytes))),
            Component::Float => f64::from(f32::from_le_bytes(first(bytes))),
        }
    }

    /// What a number of a normalised accessor means, by the specification's formulas: `c / 255`,
    /// `max(c / 127, -1)` and so on, with one rounding to f64.
    pub(super) fn normalize(self, number: f64) -> f64 {
        match self {
            Component::Byte => (number / 127.0).max(-1.0),
            Component::UnsignedByte => number / 255.0,
            Component::Short => (number / 32767.0).max(-1.0),
            Component::UnsignedShort => number / 65535.0,
            // These are never normalised.
            Component::UnsignedInt | Component::Float => number,
        }
    }
}

fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.get(..N).and_then(|bytes| bytes.try_into().ok()).unwrap_or([0; N])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_is_decoded_exactly() {
        for (code, bytes, expected, normalized) in [
            (5120, &[0x80][..], -128.0, -1.0),
            (5120, &[0x81], -127.0, -1.0),
            (5120, &[64], 64.0, 64.0 / 127.0),
            (5121, &[255], 255.0, 1.0),
            (5122, &[0, 0x80], -32768.0, -1.0),
            (5122, &[0xff, 0x7f], 32767.0, 1.0),
            (5123, &[0xff, 0xff], 65535.0, 1.0),
            (5123, &[0x34, 0x12], 4660.0, 4660.0 / 65535.0),
            (5125, &[0xff; 4], 4294967295.0, 4294967295.0),
            (5126, &[0, 0, 0xc0, 0xbf], -1.5, -1.5),
        ] {
            let component = Component::from_code(code).unwrap();
            assert_eq!(component.size(), bytes.len());
            let number = component.decode(bytes);
            assert_eq!((number, component.normalize(number)), (expected, normalized), "{component:?}");
        }
        assert_eq!(Component::from_code(5124), None);
    }
}
