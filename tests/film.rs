//! Images on disk: OpenEXR bit by bit and by OpenEXR's own tool, PNG files as people see them, and what is
//! left when something goes wrong.

use lightbuffer::film::{
    Category, CategoryMap, ImagePlanes, ToneMap, palette, read_exr, write_exr, write_false_colour,
    write_png_rgb,
};
use lightbuffer::scene::{ImageSize, Window};
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

const SIZE: ImageSize = ImageSize { width: 37, height: 41 };

/// Channels as `render` writes them, and one with a name too long for the first versions of the format.
const NAMES: &[&str] = &[
    "R",
    "G",
    "B",
    "A",
    "Z",
    "P.X",
    "P.Y",
    "P.Z",
    "N.X",
    "N.Y",
    "N.Z",
    "albedo.R",
    "albedo.G",
    "albedo.B",
    "shadow.key.light-buffer",
    "shadow.key.difference",
    "shadow.key.verdict",
    "shadow.a_rather_long_light_name_of_a_scene.bounding-volumes",
];

/// Values of every kind, different in every channel; neither the width nor the height is a multiple of a
/// block.
fn picture() -> ImagePlanes {
    let special = [
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
        -f32::NAN,
        f32::from_bits(0x7f80_0001),
        0.0,
        -0.0,
        f32::MIN_POSITIVE,
        f32::from_bits(1),
        f32::MAX,
        f32::MIN,
        -1.0,
        16_777_215.0,
        0.1,
    ];
    let mut image = ImagePlanes::new(SIZE);
    for (channel, name) in NAMES.iter().enumerate() {
        let samples = (0..SIZE.pixels()).map(|pixel| match pixel % 3 {
            0 => special[(pixel / 3 + channel) % special.len()],
            1 => f32::from_bits((pixel * 2_654_435_761 + channel * 40_503) as u32),
            _ => channel as f32,
        });
        image.add_channel(*name, samples.collect()).unwrap();
    }
    image.add_attribute("version", env!("CARGO_PKG_VERSION")).unwrap();
    image.add_attribute("scene-hash", "a".repeat(64)).unwrap();
    image.add_attribute("testers", "light-buffer R=512\nembree robust, größer").unwrap();
    for number in 0..20 {
        image.add_attribute(format!("number-{number}"), number.to_string()).unwrap();
    }
    image
}

static PICTURE_BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    write_exr(&path, &picture()).unwrap();
    fs::read(path).unwrap()
});

fn entries(folder: &Path) -> Vec<PathBuf> {
    folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn every_bit_of_every_channel_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    let image = picture();
    write_exr(&path, &image).unwrap();
    let back = read_exr(&path).unwrap();
    assert_eq!(back.size(), SIZE);
    assert_eq!(back.channels().len(), NAMES.len());
    for plane in image.channels() {
        let bits = |samples: &[f32]| samples.iter().map(|s| s.to_bits()).collect::<Vec<_>>();
        let read = back.channel(&plane.name).unwrap_or_else(|| panic!("{} is missing", plane.name));
        assert!(bits(read) == bits(&plane.samples), "{} differs", plane.name);
    }
    assert_eq!(back.attributes().len(), image.attributes().len());
    for (name, text) in image.attributes() {
        assert_eq!(back.attribute(name), Some(text.as_str()));
    }
}

#[test]
fn one_pixel_is_an_image() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("one.exr");
    let mut image = ImagePlanes::new(ImageSize { width: 1, height: 1 });
    image.add_channel("Z", vec![f32::INFINITY]).unwrap();
    write_exr(&path, &image).unwrap();
    assert_eq!(read_exr(&path).unwrap(), image);
}

#[test]
fn the_same_image_is_the_same_bytes_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    for threads in [1, 2, 5] {
        let path = folder.path().join(format!("{threads}.exr"));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| write_exr(&path, &picture())).unwrap();
        assert!(fs::read(path).unwrap() == *PICTURE_BYTES, "other bytes with {threads} threads");
    }
}

#[test]
fn exrheader_reads_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    fs::write(&path, &*PICTURE_BYTES).unwrap();
    let output = Command::new("exrheader").arg(&path).output().unwrap_or_else(|error| {
        panic!("cannot run exrheader ({error}): install Debian's package `openexr`, or run `make packages`")
    });
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    for name in NAMES {
        let line = format!("    {name}, 32-bit floating-point, sampling 1 1\n");
        assert!(text.contains(&line), "no `{line}` in\n{text}");
    }
    let version = env!("CARGO_PKG_VERSION");
    let expected = [
        format!("lightbuffer:version (type string): \"{version}\""),
        format!("lightbuffer:scene-hash (type string): \"{}\"", "a".repeat(64)),
        format!("software (type string): \"lightbuffer {version}\""),
        "chromaticities (type chromaticities):".into(),
        "compression (type compression): zip, multi-scanline blocks".into(),
        "dataWindow (type box2i): (0 0) - (36 40)".into(),
        "type (type string): \"scanlineimage\"".into(),
    ];
    for line in expected {
        assert!(text.contains(&line), "no `{line}` in\n{text}");
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_one_line_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "not a folder").unwrap();
    for path in [folder.path().join("missing/picture.exr"), file.join("picture.exr")] {
        let error = write_exr(&path, &picture()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}: cannot write: ", path.display())), "{error}");
        assert!(!error.contains('\n'), "{error}");
        write_png_rgb(&path, ImageSize { width: 1, height: 1 }, &[0; 3]).unwrap_err();
    }
    assert_eq!(entries(folder.path()), [file]);
}

#[test]
fn an_image_that_openexr_cannot_hold_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.exr");
    fs::write(&path, "old").unwrap();
    let error = write_exr(&path, &ImagePlanes::new(SIZE)).unwrap_err().to_string();
    assert!(!error.contains('\n'), "{error}");
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(entries(folder.path()), [path]);
}

/// Reads bytes as an OpenEXR file; an error must be one line that begins with the path.
fn read_bytes(bytes: &[u8]) -> Result<ImagePlanes, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.exr");
    fs::write(&path, bytes).unwrap();
    read_exr(&path).map_err(|error| {
        let line = error.to_string();
        assert!(line.starts_with(path.to_str().unwrap()) && !line.contains(char::is_control), "{line:?}");
        line
    })
}

#[test]
fn a_truncated_file_is_an_error_at_any_length() {
    let bytes = &PICTURE_BYTES;
    let header = (0..2000).step_by(7);
    let pixels = (2000..bytes.len()).step_by(1 + bytes.len() / 97);
    for length in header.chain(pixels).chain([bytes.len() - 1]) {
        assert!(read_bytes(&bytes[..length]).is_err(), "{length} of {} bytes are an image", bytes.len());
    }
}

#[test]
fn other_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().to_path_buf(), folder.path().join("missing"), "/dev/zero".into()] {
        let line = read_exr(&path).unwrap_err().to_string();
        assert!(line.starts_with(path.to_str().unwrap()) && !line.contains('\n'), "{line}");
    }
    read_bytes(b"").unwrap_err();
    read_bytes(b"\x89PNG\r\n\x1a\n").unwrap_err();
}

/// Overwrites the data window's corner (x max, y max) in the header.
fn with_corner(x: i32, y: i32) -> Vec<u8> {
    let mut bytes = PICTURE_BYTES.clone();
    for name in ["dataWindow\0box2i\0", "displayWindow\0box2i\0"] {
        let found = bytes.windows(name.len()).position(|window| window == name.as_bytes()).unwrap();
        let corner = found + name.len() + 4 + 8;
        bytes[corner..corner + 4].copy_from_slice(&x.to_le_bytes());
        bytes[corner + 4..corner + 8].copy_from_slice(&y.to_le_bytes());
    }
    bytes
}

#[test]
fn a_size_that_the_file_cannot_hold_is_refused_before_memory_is_taken() {
    assert!(read_bytes(&with_corner(36, 40)).is_ok());
    let sides = [-1, 0, 1, 35, 37, 1000, 1 << 20, 1 << 24, i32::MAX - 1, i32::MAX, i32::MIN];
    for x in sides {
        for y in sides {
            assert!(read_bytes(&with_corner(x, y)).is_err(), "{x} {y}");
        }
    }
}

/// Overwrites a window in the header: its first and last column and row.
fn with_window(bytes: &mut [u8], name: &str, window: [i32; 4]) {
    let name = format!("{name}\0box2i\0");
    let found = bytes.windows(name.len()).position(|window| window == name.as_bytes()).unwrap();
    let value = window.map(i32::to_le_bytes).concat();
    bytes[found + name.len() + 4..][..16].copy_from_slice(&value);
}

#[test]
fn rows_of_a_larger_image_come_back_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.exr");
    let mut image = ImagePlanes::new(ImageSize { width: 3, height: 20 });
    image.add_channel("Z", (0..60).map(|i| i as f32).collect()).unwrap();
    let window = Window { of: ImageSize { width: 3, height: 100 }, first_row: 48 };
    image.set_window(window).unwrap();
    write_exr(&path, &image).unwrap();
    assert_eq!(read_exr(&path).unwrap(), image);
    let output =
        Command::new("exrheader").arg(&path).output().expect("exrheader, of Debian's package openexr");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("dataWindow (type box2i): (0 48) - (2 67)"), "{text}");
    assert!(text.contains("displayWindow (type box2i): (0 0) - (2 99)"), "{text}");
}

#[test]
fn hostile_windows_are_refused_in_a_line_before_memory_is_taken() {
    let (width, height) = (SIZE.width as i32, SIZE.height as i32);
    let read = |data: [i32; 4], display: [i32; 4]| {
        let mut bytes = PICTURE_BYTES.clone();
        with_window(&mut bytes, "dataWindow", data);
        with_window(&mut bytes, "displayWindow", display);
        read_bytes(&bytes)
    };
    let own = [0, 0, width - 1, height - 1];
    assert!(read(own, own).unwrap().window().is_none());
    // An image of its own, anywhere.
    let elsewhere = [-7, -9, width - 8, height - 10];
    let is_own = |result: Result<ImagePlanes, String>| match result {
        Ok(image) => image.window().is_none(),
        // Its blocks say where they are too, and that is not there.
        Err(line) => !line.is_empty(),
    };
    assert!(is_own(read(elsewhere, elsewhere)));
    // Display windows around it, up to the largest there are.
    // The largest that there are; beyond, the format itself says no.
    let far = i32::MAX / 2 - 2;
    let of = |display| read(own, display).unwrap().window().unwrap();
    let rows = of([0, -1000, width - 1, 1_000_000_000]);
    assert_eq!((rows.first_row, rows.of.height, rows.of.width), (1000, 1_000_001_001, SIZE.width));
    assert_eq!(of([0, 0, width - 1, far]).of.height, far as u32 + 1);
    for display in [
        [0, 0, width, height - 1],
        [1, 0, width - 1, height - 1],
        [-1, 0, width - 1, height - 1],
        [0, 1, width - 1, height],
        [0, 0, width - 1, height - 2],
        [0, 0, far, far],
        [i32::MIN, i32::MIN, i32::MAX, i32::MAX],
        [0, i32::MIN, width - 1, -1],
        [0, i32::MAX, width - 1, i32::MAX],
        // Corners the other way round are those of the same rectangle.
        [width, height - 1, 0, 0],
        [0, 0, i32::MIN, i32::MIN],
    ] {
        assert!(read(own, display).is_err(), "{display:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any answer will do, as long as it is one.
    #[test]
    fn flipped_bytes_never_panic(
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..6),
    ) {
        let mut bytes = PICTURE_BYTES.clone();
        for (place, value, in_header) in flips {
            let length = if in_header { bytes.len().min(2500) } else { bytes.len() };
            bytes[place.index(length)] = value;
        }
        let _ = read_bytes(&bytes);
    }

    #[test]
    fn cut_and_spliced_bytes_never_panic(
        (from, to) in (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        inserted in prop::collection::vec(any::<u8>(), 0..12),
    ) {
        let length = PICTURE_BYTES.len().min(3000);
        let (from, to) = (from.index(length), to.index(length));
        let bytes = [&PICTURE_BYTES[..from], inserted.as_slice(), &PICTURE_BYTES[to..]].concat();
        let _ = read_bytes(&bytes);
    }
}

#[test]
fn a_png_comes_back_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let size = ImageSize { width: 64, height: 3 };
    let ramp: Vec<f32> = (0..size.pixels()).map(|i| i as f32 / 100.0).collect();
    let rgb = ToneMap::new(0.5).apply_planes(&ramp, &ramp, &vec![0.0; size.pixels()]);
    write_png_rgb(&path, size, &rgb).unwrap();
    let back = image::open(&path).unwrap().into_rgb8();
    assert_eq!(back.dimensions(), (64, 3));
    assert_eq!(back.into_raw(), rgb);
    assert!(write_png_rgb(&path, size, &rgb[1..]).is_err());
}

const WRONG: usize = 5;

/// A map in which a single pixel, at (x, y), is wrong.
fn map_with_one_wrong_pixel(size: ImageSize, x: u32, y: u32) -> CategoryMap {
    let lit_until = size.height * 2 / 3;
    let mut classes: Vec<u8> = (0..size.height)
        .flat_map(|row| {
            (0..size.width).map(move |column| match (row, column) {
                (row, _) if row < size.height / 6 => 0,
                (row, _) if row > lit_until => 2,
                (_, column) if column % 80 < 30 => 2,
                (_, column) if column % 80 < 40 => 3,
                _ => 1,
            })
        })
        .collect();
    classes[(y * size.width + x) as usize] = WRONG as u8;
    let legend = vec![
        Category::plain("background", palette::BACKGROUND),
        Category::plain("lit, all agree", palette::LIT),
        Category::plain("shadowed, all agree", palette::SHADOWED),
        Category::plain("faces away", palette::FACING_AWAY),
        Category::marked_when_rare("Embree wrong", palette::SKY_BLUE),
        Category::marked_when_rare("light buffer wrong", palette::VERMILLION),
    ];
    CategoryMap::new("blocks.obj, light key: light-buffer and Embree against truth", size, classes, legend)
        .unwrap()
}

#[test]
fn a_single_wrong_pixel_is_seen_and_its_neighbours_stay() {
    let folder = tempfile::tempdir().unwrap();
    for (width, height) in [(1280, 720), (320, 180)] {
        let size = ImageSize { width, height };
        for (x, y) in [(width / 2 + 3, height / 2), (0, 0), (width - 1, height - 1)] {
            let path = folder.path().join(format!("map-{width}-{x}.png"));
            let map = map_with_one_wrong_pixel(size, x, y);
            assert_eq!(map.counts()[WRONG], 1);
            write_false_colour(&path, &map).unwrap();
            let png = image::open(&path).unwrap().into_rgb8();
            assert_eq!(png.width(), width);
            assert!(png.height() > height + 20, "no legend in {} rows", png.height());

            let is_wrong_colour = |x, y| png.get_pixel(x, y).0 == palette::VERMILLION;
            assert!(is_wrong_colour(x, y));
            let around = |reach: u32| {
                let columns = x.saturating_sub(reach)..=(x + reach).min(width - 1);
                let rows = y.saturating_sub(reach)..=(y + reach).min(height - 1);
                rows.flat_map(move |row| columns.clone().map(move |column| (column, row)))
            };
            let coloured = around(14).filter(|&(x, y)| is_wrong_colour(x, y)).count();
            assert!(coloured > 12, "a ring of {coloured} pixels");
            // The eight neighbours and some more are what they would be without the ring.
            let plain = CategoryMap::render(&map_with_one_wrong_pixel(size, width / 4, height / 4)).1;
            for (column, row) in around(3).filter(|&pixel| pixel != (x, y)) {
                let at = ((row * width + column) * 3) as usize;
                assert_eq!(png.get_pixel(column, row).0, plain[at..at + 3]);
            }
        }
    }
}

#[test]
fn the_legend_shows_every_colour_and_stays_inside_the_picture() {
    for (width, height) in [(1280, 720), (320, 180), (64, 64)] {
        let size = ImageSize { width, height };
        let (picture, rgb) = map_with_one_wrong_pixel(size, 5, 5).render();
        let strip = &rgb[(height * picture.width * 3) as usize..];
        let pixels: Vec<[u8; 3]> = strip.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        for colour in [palette::BACKGROUND, palette::LIT, palette::SKY_BLUE, palette::VERMILLION] {
            assert!(pixels.contains(&colour), "{colour:?} at {width}");
        }
        // Text cut off at the right would leave ink in the last columns.
        let rows = pixels.chunks_exact(picture.width as usize);
        assert!(rows.clone().all(|row| row[row.len() - 4..] == [row[0]; 4]), "ink at the edge at {width}");
        let last = rows.last().unwrap();
        assert!(last.iter().all(|pixel| *pixel == last[0]), "ink in the last row at {width}");
    }
}
