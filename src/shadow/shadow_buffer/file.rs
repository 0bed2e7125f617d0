//! A filled buffer as a file, for other views of its scene.
//!
//! All numbers are little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `LBSHADOW` |
//! | 4 | version of the format: 1 |
//! | 4 | what is kept: 1 objects, 2 distances, 3 both |
//! | 8 | hash of the scene ([`Scene::hash`](crate::scene::Scene::hash)) |
//! | 12 | position of the light, as f32 |
//! | 8 | rows, columns |
//! | 4 a cell | objects, if kept: row by row, 2^32 - 1 where a ray hits nothing |
//! | 4 a cell | distances as f32, if kept |
//! | 4 | CRC-32 of everything before |
//!
//! A file serves the very buffer that would be filled in its place, or none: another scene, light, size or choice
//! of what is kept is refused as damage is. How cells are looked up is not in it.

use super::sphere::Sphere;
use crate::atomic::write_atomically;
use crate::error::{Error, Place, Result};
use glam::Vec3;
use std::io::{Read, Write};
use std::path::Path;

const MAGIC: &[u8; 8] = b"LBSHADOW";
const VERSION: u32 = 1;
const HEADER_BYTES: u64 = 44;
const CHECKSUM_BYTES: u64 = 4;

/// What is kept of each cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kept {
    Objects,
    Distances,
    Both,
}

impl Kept {
    pub fn has_objects(self) -> bool {
        self != Kept::Distances
    }

    pub fn has_distances(self) -> bool {
        self != Kept::Objects
    }

    /// Bytes of a cell.
    pub fn cell_bytes(self) -> u64 {
        if self == Kept::Both { 8 } else { 4 }
    }

    fn code(self) -> u32 {
        u32::from(self.has_objects()) + 2 * u32::from(self.has_distances())
    }
}

/// What a buffer is of, and what it keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Subject {
    pub scene_hash: u64,
    pub light: Vec3,
    pub sphere: Sphere,
    pub kept: Kept,
}

/// What is kept of all cells, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    /// The object that each ray hits first; empty if not kept.
    pub objects: Vec<u32>,
    /// How far away that is; empty if not kept.
    pub distances: Vec<f32>,
}

impl Subject {
    fn header(&self) -> Vec<u8> {
        let mut header = MAGIC.to_vec();
        header.extend(VERSION.to_le_bytes());
        header.extend(self.kept.code().to_le_bytes());
        header.extend(self.scene_hash.to_le_bytes());
        header.extend(self.light.to_array().iter().flat_map(|x| x.to_bits().to_le_bytes()));
        header.extend([self.sphere.rows(), self.sphere.columns()].iter().flat_map(|n| n.to_le_bytes()));
        header
    }

    /// The length of a file.
    pub fn file_bytes(&self) -> u64 {
        HEADER_BYTES + self.sphere.cells() * self.kept.cell_bytes() + CHECKSUM_BYTES
    }
}

/// Writes a buffer.
pub(super) fn save(path: &Path, subject: &Subject, cells: &Cells) -> Result<()> {
    let mut bytes = subject.header();
    bytes.extend(cells.objects.iter().flat_map(|object| object.to_le_bytes()));
    bytes.extend(cells.distances.iter().flat_map(|distance| distance.to_bits().to_le_bytes()));
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    write_atomically(path, |file| file.write_all(&bytes))
}

/// Reads a buffer that must be of the subject.
pub(super) fn load(path: &Path, subject: &Subject) -> Result<Cells> {
    let unreadable = |source| Error::io(path, "read", source);
    let refused = |why: String| Error::input(path, Place::File, why);
    let mut file = std::fs::File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(refused("not a file that holds a shadow-buffer".into()));
    }
    // Of a file of any size only the header is read before its length is known to be right.
    let mut header = Vec::new();
    (&mut file).take(HEADER_BYTES).read_to_end(&mut header).map_err(unreadable)?;
    expect_subject(&header, subject).map_err(refused)?;
    let (there, needed) = (metadata.len(), subject.file_bytes());
    if there != needed {
        return Err(refused(format!("{there} bytes; a shadow-buffer of this size has {needed}")));
    }
    let mut bytes = header;
    file.take(needed - HEADER_BYTES).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 != needed {
        return Err(refused("the file became shorter while it was read".into()));
    }
    let (content, checksum) = bytes.split_at(bytes.len() - CHECKSUM_BYTES as usize);
    if crc32fast::hash(content).to_le_bytes() != checksum {
        return Err(refused("damaged: the checksum does not fit the content".into()));
    }
    let mut words = content[HEADER_BYTES as usize..].chunks_exact(4).map(|word| word_of(word, 0));
    let count = |is_kept: bool| if is_kept { subject.sphere.cells() as usize } else { 0 };
    let objects = words.by_ref().take(count(subject.kept.has_objects())).collect();
    let distances = words.take(count(subject.kept.has_distances())).map(f32::from_bits).collect();
    Ok(Cells { objects, distances })
}

/// The number at a place; the bytes must be there.
fn word_of(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

/// Says what in a header is not as it must be.
fn expect_subject(header: &[u8], subject: &Subject) -> std::result::Result<(), String> {
    let expected = subject.header();
    if !header.starts_with(MAGIC) {
        return Err("not a shadow-buffer".into());
    }
    if header.len() < expected.len() {
        return Err("cut off within the header of a shadow-buffer".into());
    }
    let version = word_of(header, 8);
    if version != VERSION {
        return Err(format!("a shadow-buffer of version {version}; this program reads version {VERSION}"));
    }
    if header[16..24] != expected[16..24] {
        return Err("a shadow-buffer of another scene, or the scene has changed".into());
    }
    if header[24..36] != expected[24..36] {
        return Err("a shadow-buffer of another light".into());
    }
    if header[36..44] != expected[36..44] {
        let [rows, columns] = [36, 40].map(|at| word_of(header, at));
        return Err(format!(
            "a shadow-buffer of {rows}x{columns} cells where one of {}x{} is wanted",
            subject.sphere.rows(),
            subject.sphere.columns()
        ));
    }
    if header[12..16] != expected[12..16] {
        return Err("a shadow-buffer for another look-up: it keeps something else of its cells".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn subject(kept: Kept) -> Subject {
        Subject {
            scene_hash: 0x0123_4567_89ab_cdef,
            light: Vec3::new(1.0, -0.0, 2.5),
            sphere: Sphere::new(3, 5).unwrap(),
            kept,
        }
    }

    fn cells(kept: Kept) -> Cells {
        let objects = (0..15).map(|i| if i % 4 == 0 { u32::MAX } else { i }).collect();
        let distances = (0..15).map(|i| if i % 4 == 0 { f32::INFINITY } else { i as f32 * 0.1 }).collect();
        Cells {
            objects: if kept.has_objects() { objects } else { Vec::new() },
            distances: if kept.has_distances() { distances } else { Vec::new() },
        }
    }

    fn refusal(path: &Path, subject: &Subject) -> String {
        let line = load(path, subject).expect_err("a refusal").to_string();
        assert!(line.starts_with(&path.display().to_string()) && !line.contains('\n'), "{line}");
        line
    }

    #[test]
    fn what_is_saved_is_loaded() {
        let folder = tempfile::tempdir().unwrap();
        for kept in [Kept::Objects, Kept::Distances, Kept::Both] {
            let path = folder.path().join("buffer");
            save(&path, &subject(kept), &cells(kept)).unwrap();
            assert_eq!(path.metadata().unwrap().len(), subject(kept).file_bytes());
            assert_eq!(load(&path, &subject(kept)).unwrap(), cells(kept));
        }
    }

    #[test]
    fn every_flipped_byte_and_every_other_length_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("buffer");
        let subject = subject(Kept::Both);
        save(&path, &subject, &cells(Kept::Both)).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for at in 0..whole.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut damaged = whole.clone();
                damaged[at] ^= flip;
                std::fs::write(&path, damaged).unwrap();
                refusal(&path, &subject);
            }
        }
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            refusal(&path, &subject);
        }
        std::fs::write(&path, [&whole[..], &[0]].concat()).unwrap();
        assert!(refusal(&path, &subject).contains("bytes; a shadow-buffer of this size has"));
    }

    #[test]
    fn other_scenes_lights_sizes_and_files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("buffer");
        let ours = subject(Kept::Objects);
        save(&path, &ours, &cells(Kept::Objects)).unwrap();
        let other = Subject { scene_hash: 7, ..ours };
        assert!(refusal(&path, &other).contains("the scene has changed"));
        // Zeros of both signs are the same place and not the same bits.
        let other = Subject { light: Vec3::new(1.0, 0.0, 2.5), ..ours };
        assert!(refusal(&path, &other).contains("another light"));
        let other = Subject { sphere: Sphere::new(65536, 65536).unwrap(), ..ours };
        assert!(refusal(&path, &other).contains("of 3x5 cells where one of 65536x65536 is wanted"));
        assert!(refusal(&path, &Subject { kept: Kept::Both, ..ours }).contains("another look-up"));
        assert!(refusal(folder.path(), &ours).contains("not a file"));
        assert!(refusal(&folder.path().join("none"), &ours).contains("cannot read"));
        std::fs::write(&path, b"P6 some picture").unwrap();
        assert!(refusal(&path, &ours).ends_with("not a shadow-buffer"));
        let mut newer = ours.header();
        newer[8] = 2;
        std::fs::write(&path, newer).unwrap();
        assert!(refusal(&path, &ours).contains("version 2; this program reads version 1"));
    }

    #[test]
    fn a_size_that_no_file_has_asks_for_no_memory() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("buffer");
        let huge = Subject { sphere: Sphere::new(65536, 65536).unwrap(), ..subject(Kept::Both) };
        let mut bytes = huge.header();
        bytes.extend([0; 100]);
        std::fs::write(&path, bytes).unwrap();
        assert!(refusal(&path, &huge).contains("144 bytes; a shadow-buffer of this size has 34359738416"));
    }
}
