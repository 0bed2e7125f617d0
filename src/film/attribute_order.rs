//! The same attributes, always in the same order.
//!
//! The `exr` crate keeps attributes in a hash map with a random seed, so the same image would make
//! different bytes in every run. The header is a sequence of self-contained records (name, type, length,
//! value) that ends with an empty name; sorted, it is as long as before, so no offset in the file moves.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};

/// Magic number and version, before the first attribute.
const PREAMBLE: u64 = 8;

/// Sorts the attributes of a complete one-part OpenEXR file by name.
///
/// # Errors
/// What reading and writing the file gives, or `InvalidData` if its header is none.
pub(super) fn sort_attributes(file: &mut File) -> io::Result<()> {
    file.seek(SeekFrom::Start(PREAMBLE))?;
    let mut records = read_records(&mut BufReader::new(&mut *file))?;
    records.sort();
    file.seek(SeekFrom::Start(PREAMBLE))?;
    file.write_all(&records.concat())
}

/// All attribute records as they stand. They begin with their names and a zero, so that comparing records
/// is comparing names.
fn read_records(reader: &mut impl BufRead) -> io::Result<Vec<Vec<u8>>> {
    let mut records = Vec::new();
    loop {
        let mut record = Vec::new();
        reader.read_until(0, &mut record)?;
        if record == [0] {
            return Ok(records);
        }
        reader.read_until(0, &mut record)?;
        let mut length = [0; 4];
        reader.read_exact(&mut length)?;
        record.extend(length);
        let value = u64::from(u32::from_le_bytes(length));
        if reader.take(value).read_to_end(&mut record)? as u64 != value {
            return Err(io::Error::from(io::ErrorKind::InvalidData));
        }
        records.push(record);
    }
}
