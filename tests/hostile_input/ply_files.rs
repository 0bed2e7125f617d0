//! PLY in text and in binary.

use crate::fixtures::Folder;
use crate::ply_writer::encoded;
use crate::{assert_one_line, refused};
use lightbuffer::scene::formats;

const BINARY: [&str; 2] = ["binary_little_endian", "binary_big_endian"];

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const CORNERS: &str = "0 0 0\n1 0 0\n0 1 0\n";

fn valid() -> String {
    format!("{HEADER}{CORNERS}3 0 1 2\n")
}

/// Asserts that a file is refused with a message that holds the words.
#[track_caller]
fn file_refused(bytes: impl AsRef<[u8]>, words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.ply", bytes), words);
}

/// Asserts that the valid file is refused with one text in place of another.
#[track_caller]
fn spoilt(part: &str, other: &str, words: &[&str]) {
    assert!(valid().contains(part), "{part:?}");
    file_refused(valid().replacen(part, other, 1), words);
}

#[test]
fn files_of_another_kind() {
    for bytes in
        [&b""[..], b"\n", b"PLY\n", b"plywood\n", b"ply", b"\xef\xbb\xbfply\n", b"o ply\n", b"solid\n"]
    {
        file_refused(bytes, &["bad.ply:1: expected a PLY file, which begins with a line `ply`"]);
    }
    file_refused("ply\n", &["bad.ply:2: expected `end_header`, found the end of the file"]);
    file_refused("ply\nend_header\n", &["bad.ply:2: expected a line `format`"]);
}

#[test]
fn headers_that_are_none() {
    spoilt("format ascii 1.0\n", "", &["bad.ply:8: expected a line `format`"]);
    spoilt("format ascii", "format text", &[":2: expected the format ascii", "found `text`"]);
    spoilt("ascii 1.0", "ascii 2.0", &[":2: expected version 1.0, found `2.0`"]);
    spoilt("ascii 1.0", "ascii 1.0\nformat ascii 1.0", &[":3: a second line `format`"]);
    spoilt("element vertex 3", "", &[":4: expected an element before its properties"]);
    spoilt("element vertex 3", "element vertex", &[":3: expected a name and a count"]);
    spoilt("element vertex 3", "element vertex 3 4", &[":3: expected a name and a count"]);
    spoilt("element face", "element vertex", &[":7: a second element `vertex`"]);
    spoilt("property float y", "property float x", &[":5: a second property `x`"]);
    spoilt("property float y", "property real y", &[":5: expected a type such as float", "found `real`"]);
    spoilt("property float y", "property float", &[":5: expected a name"]);
    spoilt("property float y", "property float y z", &[":5: expected a name"]);
    spoilt("list uchar int", "list int", &[":8: expected a type", "found `vertex_indices`"]);
    spoilt(
        "list uchar int",
        "list float int",
        &[":8: expected a whole number as the type of a list's length"],
    );
    spoilt("end_header", "end header", &[":9: expected format, element, property, comment or end_header"]);
    spoilt("end_header", "\u{1b}[31m", &[":9: expected format", "\\u{1b}[31m"]);
}

#[test]
fn headers_that_do_not_end() {
    file_refused(
        format!("ply\n{}", "comment a\n".repeat(200_000)),
        &["`end_header` within the first 1048576 bytes"],
    );
    file_refused(vec![b'p'; 2 << 20], &["bad.ply:1: expected a PLY file"]);
}

#[test]
fn headers_without_what_is_needed() {
    spoilt("element vertex 3", "element corner 3", &[":9: expected an element `vertex`"]);
    spoilt("property float z", "property float w", &[":3: expected a property `z` of its vertices"]);
    spoilt(
        "property float z",
        "property list uchar int z",
        &[":6: expected `z` to be a number, found a list"],
    );
    spoilt(
        "vertex_indices",
        "corners",
        &[":7: expected a list `vertex_indices` or `vertex_index` in each face"],
    );
    let both = "vertex_indices\nproperty list uchar int vertex_index";
    let text = valid().replace("vertex_indices", both).replace("3 0 1 2", "3 0 1 2 3 0 1 2");
    file_refused(text, &[":7: expected a list"]);
    spoilt(
        "list uchar int",
        "list uchar float",
        &[":8: expected `vertex_indices` to be a list of whole numbers"],
    );
    spoilt("list uchar int", "int", &[":8: expected `vertex_indices` to be a list of whole numbers"]);
}

#[test]
fn a_point_cloud() {
    let cloud = "bad.ply: expected faces, found a point cloud of 3 vertices";
    spoilt("element face 1", "element face 0", &[cloud]);
    spoilt("element face 1", "element surface 1", &[cloud]);
    let header = HEADER.split("element face").next().unwrap();
    let splat = format!("{header}property float opacity\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n");
    file_refused(&splat, &[cloud]);
    file_refused(encoded(&splat, BINARY[0]), &[cloud]);
    file_refused("ply\nformat ascii 1.0\nend_header\n", &["a point cloud of 0 vertices"]);
    let flat = valid().replace("3 0 1 2", "2 0 1");
    file_refused(flat, &["expected at least one triangle"]);
}

#[test]
fn counts_that_the_file_cannot_hold() {
    let vertices = "element `vertex`: it declares 4000000000 of at least 6 bytes";
    spoilt("element vertex 3", "element vertex 4000000000", &[":3: ", vertices]);
    let text = valid().replace("element face 1", "element face 18446744073709551615");
    file_refused(&text, &[":7: element `face`: it declares 18446744073709551615 of at least 2 bytes"]);
    spoilt("element face 1", "element face 18446744073709551616", &[":7: expected a count"]);
    spoilt("element face 1", "element face -1", &[":7: expected a count, found `-1`"]);
    spoilt("element face 1", "element face 1.5", &[":7: expected a count, found `1.5`"]);
    for count in ["4", "1000", "4294967296", "9223372036854775807", "18446744073709551615"] {
        for encoding in BINARY {
            let file = encoded(&valid(), encoding);
            let at = file.windows(8).position(|bytes| bytes == b"vertex 3").unwrap() + 7;
            let file = [&file[..at], count.as_bytes(), &file[at + 1..]].concat();
            match count {
                // There is room for a fourth vertex, and a byte is left for the length of the face's list.
                "4" => file_refused(file, &["bad.ply: "]),
                _ => file_refused(
                    file,
                    &["bad.ply:3: element `vertex`: it declares ", " of at least 12 bytes"],
                ),
            }
        }
    }
    // A file without a body that declares more than there is memory.
    let small = "ply\nformat binary_little_endian 1.0\nelement a 99999999999\nproperty char b\nend_header\n";
    file_refused(small, &[":3: element `a`: it declares 99999999999 of at least 1 bytes, and 0 are left"]);
}

#[test]
fn more_or_fewer_elements_than_declared() {
    spoilt("element vertex 3", "element vertex 2", &["bad.ply:12: expected the end of the line, found `1`"]);
    spoilt("element vertex 3", "element vertex 4", &["bad.ply:13: expected the end of the line, found `2`"]);
    spoilt(
        "element face 1",
        "element face 2",
        &["bad.ply:13: expected another line, found the end of the file"],
    );
    spoilt("0 1 0\n", "0 1\n", &["bad.ply:12: expected another number, found the end of the line"]);
    spoilt("0 1 0\n", "0 1 0 0\n", &["bad.ply:12: expected the end of the line, found `0`"]);
    spoilt("3 0 1 2", "3 0 1", &["bad.ply:13: a list declares 3 numbers, and there is room for 2"]);
    spoilt("3 0 1 2", "3 0 1  ", &["bad.ply:13: a list declares 3 numbers"]);
    spoilt("3 0 1 2", "3 10 11", &["bad.ply:13: vertex 10 of 3"]);
    spoilt("3 0 1 2", "3 0 1 2 2", &["bad.ply:13: expected the end of the line, found `2`"]);
}

#[test]
fn numbers_that_are_none() {
    spoilt("1 0 0", "1 zero 0", &["bad.ply:11: expected a number, found `zero`"]);
    spoilt("1 0 0", "1 0,5 0", &["bad.ply:11: expected a number, found `0,5`"]);
    spoilt("3 0 1 2", "x 0 1 2", &["bad.ply:13: expected a whole number, found `x`"]);
    spoilt("3 0 1 2", "3 0 1 2.0", &["bad.ply:13: expected a whole number, found `2.0`"]);
    spoilt("3 0 1 2", "3 0 1 \u{7}\u{1b}[0m", &["bad.ply:13: expected a whole number, found `\\u{7}"]);
    let text = valid().replace("3 0 1 2", &format!("3 0 1 {}", "9".repeat(100_000)));
    file_refused(text, &["bad.ply:13: ", "..."]);
    let latin = [valid().replace("3 0 1 2\n", "3 0 1 ").as_bytes(), b"\xe9\n"].concat();
    file_refused(latin, &["bad.ply:13: expected a whole number, found `\u{fffd}`"]);
}

#[test]
fn indices_out_of_range() {
    spoilt("3 0 1 2", "3 0 1 3", &["bad.ply:13: vertex 3 of 3"]);
    spoilt("3 0 1 2", "3 0 1 -1", &["bad.ply:13: vertex -1 of 3"]);
    spoilt("3 0 1 2", "3 0 1 4294967296", &["bad.ply:13: vertex 4294967296 of 3"]);
    spoilt("3 0 1 2", "3 0 1 9223372036854775808", &["bad.ply:13: expected a whole number"]);
    for index in ["3", "-1", "2147483647", "-2147483648"] {
        for encoding in BINARY {
            let file = encoded(&valid().replace("3 0 1 2", &format!("3 0 1 {index}")), encoding);
            let place = format!("bad.ply: face 0, byte {}: vertex {index} of 3", file.len() - 4);
            file_refused(file, &[&place]);
        }
    }
    let unsigned = valid().replace("uchar int", "uint uint").replace("3 0 1 2", "3 0 1 4294967295");
    file_refused(encoded(&unsigned, BINARY[1]), &["face 0, byte ", "vertex 4294967295 of 3"]);
}

#[test]
fn strips_with_indices_out_of_range() {
    let strips = valid().replace("element face", "element tristrips").replace("uchar int", "int int");
    for (bad, words) in [("-2", "vertex -2 of 3"), ("3", "vertex 3 of 3")] {
        let text = strips.replace("3 0 1 2", &format!("5 -1 0 1 2 {bad}"));
        file_refused(&text, &[&format!("bad.ply:13: {words}")]);
        file_refused(encoded(&text, BINARY[0]), &["bad.ply: tristrips 0, byte ", words]);
    }
}

#[test]
fn lists_longer_than_the_file() {
    for (scalar, length) in
        [("int", "2147483647"), ("uint", "2147483648"), ("uint", "4294967295"), ("ushort", "65535")]
    {
        let text = valid().replace("uchar int", &format!("{scalar} int"));
        let message = format!("a list declares {length} numbers, and there is room for 3");
        file_refused(text.replace("3 0 1 2", &format!("{length} 0 1 2")), &["bad.ply:13: ", &message]);
        for encoding in BINARY {
            let mut file = encoded(&text, encoding);
            let at = file.len() - 12 - if scalar == "ushort" { 2 } else { 4 };
            let mut bytes = length.parse::<u32>().unwrap().to_le_bytes()[..file.len() - 12 - at].to_vec();
            if encoding == "binary_big_endian" {
                bytes.reverse();
            }
            file[at..at + bytes.len()].copy_from_slice(&bytes);
            file_refused(file, &[&format!("bad.ply: face 0, byte {at}: "), &message]);
        }
    }
    let negative = valid().replace("uchar int", "char int").replace("3 0 1 2", "-3 0 1 2");
    file_refused(&negative, &["bad.ply:13: expected the length of a list, found -3"]);
    let text = valid().replace("uchar int", "char int");
    for encoding in BINARY {
        let mut file = encoded(&text, encoding);
        let at = file.len() - 13;
        file[at] = 0x80;
        file_refused(file, &["face 0, byte ", "expected the length of a list, found -128"]);
    }
}

#[test]
fn lists_that_are_passed_over_are_checked_too() {
    let text = valid().replace("vertex_indices", "vertex_indices\nproperty list uint double more");
    let file = encoded(&text.replace("3 0 1 2", "3 0 1 2 1 0.5"), BINARY[0]);
    let at = file.len() - 12;
    let mut long = file.clone();
    long[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    file_refused(
        long,
        &[&format!("face 0, byte {at}: a list declares 4294967295 numbers, and there is room for 1")],
    );
    file_refused(&file[..file.len() - 1], &["there is room for 0"]);
}

#[test]
fn a_file_cut_anywhere() {
    let folder = Folder::new();
    for encoding in ["ascii", BINARY[0], BINARY[1]] {
        let whole = encoded(&valid(), encoding);
        for length in 0..whole.len() {
            let path = folder.write("bad.ply", &whole[..length]);
            // Without the last line's end, a text is whole.
            match (encoding, length + 1 == whole.len()) {
                ("ascii", true) => assert_eq!(formats::load(&path).unwrap().triangles.len(), 1),
                _ => refused(&path, &["bad.ply:"]),
            }
        }
    }
}

#[test]
fn bytes_of_any_value_in_any_place() {
    let folder = Folder::new();
    for encoding in ["ascii", BINARY[0], BINARY[1]] {
        let whole = encoded(&valid(), encoding);
        for place in 0..whole.len() {
            for byte in [0, b'\n', b' ', b'9', b'-', 0x7f, 0x80, 0xff] {
                let mut file = whole.clone();
                file[place] = byte;
                let path = folder.write("some.ply", file);
                if let Err(error) = formats::load(&path) {
                    assert_one_line(&path, &error.to_string());
                }
            }
        }
    }
}

#[test]
fn a_polygon_that_would_take_for_ever() {
    let mut text = HEADER.replace("vertex 3", "vertex 10001").replace("uchar", "ushort");
    for i in 0..10_000 {
        text += &format!("{i} {} 0\n", i % 2 * 5);
    }
    text += "5000 -9 0\n10001";
    (0..=10_000).for_each(|i| text += &format!(" {i}"));
    file_refused(&text, &["bad.ply:10011: expected at most 4096 corners"]);
    file_refused(encoded(&text, BINARY[0]), &["bad.ply: face 0, byte ", "expected at most 4096 corners"]);
}

#[test]
fn overflowing_numbers_are_dropped_and_never_silent() {
    let folder = Folder::new();
    let text =
        valid().replace("float x", "double x").replace("vertex 3", "vertex 6").replace("face 1", "face 4");
    let text =
        text.replace("3 0 1 2\n", "1e300 0 0\n-1e39 0 0\nnan 0 inf\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 1 2 5\n");
    for encoding in ["ascii", BINARY[0], BINARY[1]] {
        let scene = formats::load(&folder.write("some.ply", encoded(&text, encoding))).unwrap();
        assert_eq!((scene.triangles.len(), scene.dropped.non_finite), (1, 3));
        assert!(scene.warnings.iter().any(|w| w.contains("dropped 3 triangles")));
    }
}
