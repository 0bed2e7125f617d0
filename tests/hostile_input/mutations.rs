//! Valid files with bytes flipped, cut off, doubled or replaced: they load, or they are refused in one line.

use crate::assert_one_line;
use crate::fixtures::{Folder, data_uri, triangle_glb};
use crate::ply_writer::encoded;
use crate::samples::{NFF, OBJ, PAINT, PLY, TOML, document, posed};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lightbuffer::scene::formats;
use proptest::prelude::*;
use serde_json::json;

/// One change of a file; places count in 65536ths of its length.
#[derive(Debug, Clone)]
enum Change {
    Flip { place: u16, mask: u8 },
    Put { place: u16, byte: u8 },
    Cut { place: u16 },
    Double { place: u16, length: u8 },
    Remove { place: u16, length: u8 },
}

fn change() -> impl Strategy<Value = Change> {
    // Bytes that mean something in the formats are put more often.
    let telling = prop::sample::select(b"0123456789-+.eE/\\\"{}[],: \n\tvfnN#\0\x7f\xff".to_vec());
    prop_oneof![
        (any::<u16>(), 1u8..).prop_map(|(place, mask)| Change::Flip { place, mask }),
        (any::<u16>(), telling).prop_map(|(place, byte)| Change::Put { place, byte }),
        any::<u16>().prop_map(|place| Change::Cut { place }),
        (any::<u16>(), any::<u8>()).prop_map(|(place, length)| Change::Double { place, length }),
        (any::<u16>(), any::<u8>()).prop_map(|(place, length)| Change::Remove { place, length }),
    ]
}

impl Change {
    fn apply(&self, file: &mut Vec<u8>) {
        let at = |place: u16| usize::from(place) * file.len() / 65536;
        if file.is_empty() {
            return;
        }
        match *self {
            Change::Flip { place, mask } => {
                let at = at(place);
                file[at] ^= mask;
            }
            Change::Put { place, byte } => {
                let at = at(place);
                file[at] = byte;
            }
            Change::Cut { place } => file.truncate(at(place)),
            Change::Double { place, length } => {
                let start = at(place);
                let end = (start + usize::from(length)).min(file.len());
                let copy = file[start..end].to_vec();
                file.splice(start..start, copy);
            }
            Change::Remove { place, length } => {
                let start = at(place);
                file.drain(start..(start + usize::from(length)).min(file.len()));
            }
        }
    }
}

/// Loads a changed file; the result may be either, but must be clean.
fn check(name: &str, mut file: Vec<u8>, changes: &[Change], mend: impl Fn(&mut Vec<u8>)) {
    changes.iter().for_each(|change| change.apply(&mut file));
    mend(&mut file);
    let folder = Folder::new();
    folder.write("paint.mtl", PAINT);
    folder.write("part.obj", OBJ);
    let path = folder.write(name, &file);
    match formats::load(&path) {
        Ok(scene) => {
            assert!(
                (0..scene.triangles.len() as u32).all(|t| scene.corners(t).iter().all(|p| p.is_finite()))
            );
            for object in &scene.objects {
                let mask = scene.materials[object.material as usize].coverage.mask();
                assert!(mask.is_none_or(|mask| (mask as usize) < scene.alpha_masks.len()));
                assert_eq!(object.texture_coordinates.is_some(), mask.is_some());
            }
            for text in scene.warnings.iter().chain(scene.objects.iter().map(|o| &o.name)) {
                assert!(!text.chars().any(char::is_control), "{text:?}");
            }
        }
        Err(error) => assert_one_line(&path, &error.to_string()),
    }
}

#[test]
fn what_is_changed_is_valid_before() {
    let folder = Folder::new();
    for (document, triangles) in [(document(), 2), (posed(), 3)] {
        let scene = formats::load(&folder.write("some.gltf", document.to_string())).unwrap();
        assert_eq!(scene.triangles.len(), triangles);
    }
    folder.write("paint.mtl", PAINT);
    folder.write("part.obj", OBJ);
    assert_eq!(formats::load(&folder.write("some.toml", TOML)).unwrap().triangles.len(), 14);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn of_obj(changes in prop::collection::vec(change(), 1..6)) {
        check("some.obj", OBJ.into(), &changes, |_| ());
    }

    #[test]
    fn of_gltf(changes in prop::collection::vec(change(), 1..6)) {
        check("some.gltf", document().to_string().into(), &changes, |_| ());
    }

    #[test]
    fn of_gltf_in_poses(changes in prop::collection::vec(change(), 1..6)) {
        check("some.gltf", posed().to_string().into(), &changes, |_| ());
    }

    /// Changes in the numbers and not in the words around them; the image is the third part of them.
    #[test]
    fn of_what_gltf_buffers_hold(changes in prop::collection::vec(change(), 1..4), buffer in any::<usize>()) {
        let mut document = posed();
        let buffers = document["buffers"].as_array().unwrap().len();
        let place = match buffer % (buffers + buffers / 2) {
            buffer if buffer < buffers => &mut document["buffers"][buffer],
            _ => &mut document["images"][0],
        };
        let uri = place["uri"].as_str().unwrap();
        let mut bytes = STANDARD.decode(uri.split_once(',').unwrap().1).unwrap();
        changes.iter().for_each(|change| change.apply(&mut bytes));
        place["uri"] = json!(data_uri(&bytes));
        check("some.gltf", document.to_string().into(), &[], |_| ());
    }

    #[test]
    fn of_glb(changes in prop::collection::vec(change(), 1..6)) {
        check("some.glb", triangle_glb(), &changes, |_| ());
    }

    /// With the length in the header put right, so that more than the header is read.
    #[test]
    fn of_glb_of_honest_length(changes in prop::collection::vec(change(), 1..6)) {
        check("some.glb", triangle_glb(), &changes, |file| {
            let length = (file.len() as u32).to_le_bytes();
            if let Some(declared) = file.get_mut(8..12) {
                declared.copy_from_slice(&length);
            }
        });
    }

    #[test]
    fn of_ply(changes in prop::collection::vec(change(), 1..6)) {
        check("some.ply", PLY.into(), &changes, |_| ());
    }

    /// With the header as it was, so that more than the header is read.
    #[test]
    fn of_the_body_of_binary_ply(changes in prop::collection::vec(change(), 1..6), big in any::<bool>()) {
        let encoding = if big { "binary_big_endian" } else { "binary_little_endian" };
        let file = encoded(PLY, encoding);
        let body = file.windows(11).position(|bytes| bytes == b"end_header\n").unwrap() + 11;
        let (header, body) = file.split_at(body);
        check("some.ply", body.to_vec(), &changes, |body| {
            body.splice(0..0, header.iter().copied());
        });
        check("some.ply", file.clone(), &changes, |_| ());
    }

    #[test]
    fn of_nff(changes in prop::collection::vec(change(), 1..6)) {
        check("some.nff", NFF.into(), &changes, |_| ());
    }

    #[test]
    fn of_toml(changes in prop::collection::vec(change(), 1..6)) {
        check("some.toml", TOML.into(), &changes, |_| ());
    }

    #[test]
    fn of_material_libraries(changes in prop::collection::vec(change(), 1..6)) {
        let mut library = PAINT.as_bytes().to_vec();
        changes.iter().for_each(|change| change.apply(&mut library));
        let folder = Folder::new();
        folder.write("other.mtl", &library);
        let path = folder.write("some.obj", OBJ.replace("paint", "other"));
        if let Err(error) = formats::load(&path) {
            assert_one_line(&path, &error.to_string());
        }
    }

    #[test]
    fn of_nothing(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for name in ["some.obj", "some.ply", "some.gltf", "some.glb", "some.nff", "some.toml"] {
            check(name, bytes.clone(), &[], |_| ());
        }
    }
}
