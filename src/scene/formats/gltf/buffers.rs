//! The bytes that buffers and images name: the binary chunk, data URIs, and files in the scene's folder.

use super::schema::Buffer;
use crate::scene::formats::confined::Room;
use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::borrow::Cow;
use std::cell::OnceCell;

/// Exporters leave the padding away or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// All buffers of a document; each is read when it is first needed.
pub(super) struct Buffers<'a> {
    entries: &'a [Buffer],
    binary: Option<&'a [u8]>,
    room: Room,
    read: Vec<OnceCell<Cow<'a, [u8]>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(entries: &'a [Buffer], binary: Option<&'a [u8]>, room: Room) -> Buffers<'a> {
        Buffers { entries, binary, room, read: entries.iter().map(|_| OnceCell::new()).collect() }
    }

    /// The declared bytes of a buffer.
    ///
    /// # Errors
    /// A line if there is no such buffer, it cannot be read, or it holds fewer bytes than it declares.
    pub(super) fn bytes(&self, index: u64) -> Result<&[u8], String> {
        let position = usize::try_from(index).ok().filter(|&i| i < self.entries.len());
        let position = position.ok_or_else(|| format!("buffer {index} of {}", self.entries.len()))?;
        let entry = &self.entries[position];
        let cell = &self.read[position];
        if cell.get().is_none() {
            let bytes = self.read_entry(entry, position).map_err(|why| format!("buffer {index}: {why}"))?;
            // Nobody else can have set it meanwhile.
            _ = cell.set(bytes);
        }
        let bytes = cell.get().map_or(&[][..], |bytes| bytes);
        usize::try_from(entry.byte_length).ok().and_then(|length| bytes.get(..length)).ok_or_else(|| {
            format!("buffer {index}: it declares {} bytes and holds {}", entry.byte_length, bytes.len())
        })
    }

    fn read_entry(&self, entry: &Buffer, position: usize) -> Result<Cow<'a, [u8]>, String> {
        let Some(uri) = &entry.uri else {
            return match self.binary {
                Some(bytes) if position == 0 => Ok(Cow::Borrowed(bytes)),
                _ => Err("it has no URI, and no binary chunk belongs to it".into()),
            };
        };
        self.resource(uri)
    }

    /// What a URI names: the bytes that it holds itself, or a file in the scene's folder.
    ///
    /// # Errors
    /// A line if it is a data URI that is none, or a file that may not or cannot be read.
    pub(super) fn resource(&self, uri: &str) -> Result<Cow<'static, [u8]>, String> {
        if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
            return decode_data_uri(&uri[5..]).map(Cow::Owned);
        }
        self.room.read_uri(uri).map(Cow::Owned).map_err(|denial| denial.message(uri))
    }
}

/// The bytes of what follows `data:`.
fn decode_data_uri(rest: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = rest.split_once(',') else {
        return Err("expected a comma in the data URI".into());
    };
    if !kind.ends_with(";base64") {
        return Err("expected a data URI in base64".into());
    }
    BASE64.decode(data).map_err(|error| format!("the data URI is not base64: {error}"))
}
