//! Checksums and lengths put right: a fuzzer that changes a byte would test nothing else otherwise.

/// A GLB file whose header has the file's length.
pub fn glb(file: &[u8]) -> Vec<u8> {
    let mut file = file.to_vec();
    let length = (file.len() as u32).to_le_bytes();
    if let Some(declared) = file.get_mut(8..12) {
        declared.copy_from_slice(&length);
    }
    file
}

/// A PNG file with the signature in front and every chunk's checksum right, as far as its chunks can be followed.
pub fn png(file: &[u8]) -> Vec<u8> {
    const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
    let mut file = file.to_vec();
    if file.len() < SIGNATURE.len() {
        return file;
    }
    file[..SIGNATURE.len()].copy_from_slice(SIGNATURE);
    let mut at = SIGNATURE.len();
    while let Some(length) = file.get(at..at + 4) {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let end = at + 8 + length;
        if file.len() < end + 4 {
            break;
        }
        let checksum = crc32fast::hash(&file[at + 4..end]).to_be_bytes();
        file[end..end + 4].copy_from_slice(&checksum);
        at = end + 4;
    }
    file
}

/// A file whose last four bytes are the little-endian CRC-32 of those before.
pub fn last_checksum(file: &[u8]) -> Vec<u8> {
    let content = &file[..file.len().saturating_sub(4)];
    let mut file = content.to_vec();
    file.extend(crc32fast::hash(content).to_le_bytes());
    file
}
