//! The valid files that the fuzzer begins with.

use crate::checks::{self, Desk, Outcome, SEPARATOR, Target};
use crate::{fixtures, gltf_parts, ply_writer, samples};
use image::{DynamicImage, ImageFormat};
use lightbuffer::film::{ImagePlanes, write_exr};
use lightbuffer::scene::{ImageSize, Window};
use serde_json::json;
use std::io::Cursor;
use std::path::Path;

/// A name that tells what the file has, and the file.
type Seed = (&'static str, Vec<u8>);

/// Writes all of them into the corpus.
pub fn write(corpus: &Path) {
    let mut desk = Desk::new();
    for target in Target::ALL {
        let folder = corpus.join(target.name());
        std::fs::create_dir_all(&folder).expect("a folder for the corpus");
        for (name, file) in seeds(target) {
            if let Outcome::Refused(why) = target.check(&file, &mut desk) {
                panic!("the seed `{name}` is not valid: {why}");
            }
            std::fs::write(folder.join(format!("valid-{name}")), file).expect("room for a seed");
        }
    }
}

fn seeds(target: Target) -> Vec<Seed> {
    match target {
        Target::Obj => vec![("everything", joined(&[samples::OBJ.as_bytes(), samples::PAINT.as_bytes()]))],
        Target::Ply => ["ascii", "binary_little_endian", "binary_big_endian"]
            .map(|encoding| (encoding, ply_writer::encoded(samples::PLY, encoding)))
            .to_vec(),
        Target::Nff => vec![("everything", samples::NFF.into())],
        Target::Gltf => gltf(),
        Target::Glb => ["r", "m"]
            .map(|how| (if how == "r" { "as-it-is" } else { "mended" }, [how.as_bytes(), &glb()].concat()))
            .to_vec(),
        Target::Toml => toml(),
        Target::Picture => pictures(),
        Target::ShadowBuffer => {
            let names = ["objects", "distances", "both"];
            let mut all: Vec<Seed> = names.into_iter().zip(checks::shadow_buffer::valid_inputs()).collect();
            for (name, how) in [("checksum-mended", b'c'), ("header-mended", b'h')] {
                let mut file = all[2].1.clone();
                file[0] = how;
                all.push((name, file));
            }
            all
        }
        Target::Exr => exr(),
    }
}

fn joined(files: &[&[u8]]) -> Vec<u8> {
    files.join(SEPARATOR)
}

fn gltf() -> Vec<Seed> {
    let mut beside = fixtures::triangle();
    beside["buffers"][0]["uri"] = json!("part.bin");
    beside["materials"][0]["alphaMode"] = json!("MASK");
    gltf_parts::paint(&mut beside, json!({ "uri": "picture.png" }), [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let picture = gltf_parts::png(2, &[0, 255, 255, 0]);
    let files = joined(&[beside.to_string().as_bytes(), &fixtures::triangle_bytes(), &picture]);
    vec![
        ("nodes-lights-camera", samples::document().to_string().into()),
        ("poses-and-a-mask", samples::posed().to_string().into()),
        ("files-beside-it", files),
    ]
}

fn glb() -> Vec<u8> {
    let mut document = fixtures::triangle();
    document["buffers"] = json!([{ "byteLength": 78 }]);
    fixtures::glb(&document, &fixtures::triangle_bytes())
}

fn toml() -> Vec<Seed> {
    let everything = joined(&[samples::TOML.as_bytes(), samples::OBJ.as_bytes()]);
    let included = "version = 1\nbackground = 0.5\n[[disc]]\ncentre = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1\n\
        [[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n[[ellipsoid]]\ncentre = [0, 3, 0]\nradii = [1, 2, 3]\n\
        [[cylinder]]\nbase = [0, 0, 0]\napex = [0, 2, 0]\nradius = 0.5\n";
    let nested = "version = 1\nname = 'nested'\n[[include]]\npath = 'part.toml'\ncameras = true\n[[include]]\n\
        path = 'part.toml'\ntransform = { rotate = { axis = [1, 1, 0], degrees = 45 } }\n[[mesh]]\nmaterial = 'a'\n\
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\ntexture_coordinates = [[0, 0], [1, 0], [0, 1]]\n\
        [[material]]\nname = 'a'\ntexture = { image = 'picture.png', coordinates = true, wrap_u = 'mirror' }\n";
    let picture = gltf_parts::png(1, &[255]);
    let nested = joined(&[nested.as_bytes(), b"", included.as_bytes(), &picture]);
    vec![("everything", everything), ("curved-surfaces-included", nested)]
}

/// PNG files of every kind of texel.
fn pictures() -> Vec<Seed> {
    let grey = DynamicImage::new_luma8(3, 2);
    let checks = [0, 255].repeat(8);
    let alpha = gltf_parts::png(4, &checks);
    let of = |how: &[u8], picture: &DynamicImage| {
        let mut file = Cursor::new(how.to_vec());
        file.set_position(how.len() as u64);
        picture.write_to(&mut file, ImageFormat::Png).expect("a small picture");
        file.into_inner()
    };
    let deep = image::load_from_memory(&alpha).expect("what we wrote").into_rgba16();
    let both = image::load_from_memory(&alpha).expect("what we wrote").into_luma_alpha8();
    vec![
        ("texture-grey", of(b"t", &grey)),
        ("texture-grey-16", of(b"m", &DynamicImage::from(grey.to_luma16()))),
        ("texture-colours", of(b"m", &DynamicImage::from(grey.to_rgb8()))),
        ("texture-alpha", [b"m".as_slice(), &alpha].concat()),
        ("mask", [b"a".as_slice(), &alpha].concat()),
        ("mask-mended", [b"b".as_slice(), &alpha].concat()),
        ("mask-grey", of(b"b", &DynamicImage::from(both))),
        ("mask-16", of(b"b", &DynamicImage::from(deep))),
        ("mask-jpeg", b"a\xff\xd8\xff\xe0\0\x10JFIF\0\x01".to_vec()),
    ]
}

fn exr() -> Vec<Seed> {
    let desk = Desk::new();
    let picture = |width: u32, height: u32, names: &[&str], window: Option<Window>| {
        let mut image = ImagePlanes::new(ImageSize { width, height });
        window.map_or(Ok(()), |window| image.set_window(window)).expect("rows of a larger image");
        for (number, name) in names.iter().enumerate() {
            let samples = (0..width * height).map(|i| (i / 3) as f32 * 0.5 + number as f32).collect();
            image.add_channel(*name, samples).expect("a new name");
        }
        image.add_attribute("version", "1").expect("a new name");
        let path = desk.path("image.exr");
        write_exr(&path, &image).expect("a small image");
        std::fs::read(path).expect("what was written")
    };
    vec![
        ("one-channel", picture(3, 2, &["Z"], None)),
        (
            "rows",
            picture(3, 2, &["Z"], Some(Window { of: ImageSize { width: 3, height: 20 }, first_row: 5 })),
        ),
        (
            "several-blocks",
            picture(5, 19, &["R", "G", "B", "shadow.key.a_rather_long_name_of_a_tester"], None),
        ),
    ]
}
