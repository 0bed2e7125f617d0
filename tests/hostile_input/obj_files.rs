//! OBJ and MTL.

use crate::fixtures::Folder;
use crate::refused;
use lightbuffer::scene::formats;

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Asserts that a text is refused with a message that holds the words.
#[track_caller]
fn text_refused(text: impl AsRef<[u8]>, words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.obj", text), words);
}

/// The same for one line after three good ones.
#[track_caller]
fn line_refused(line: &str, words: &[&str]) {
    text_refused(format!("{CORNERS}{line}\nf 1 2 3\n"), &[&["bad.obj:4: "], words].concat());
}

#[test]
fn an_empty_file_and_one_without_triangles() {
    text_refused("", &["bad.obj: ", "expected at least one triangle"]);
    text_refused("v 0 0 0\n", &["expected at least one triangle"]);
    text_refused(format!("{CORNERS}v 2 0 0\nf 1 2 4\n"), &["found 1 of zero area"]);
}

#[test]
fn numbers_that_are_none() {
    line_refused("v 0 zero 0", &["expected a number, found `zero`"]);
    line_refused("v 0 0", &["expected 3 coordinates", "found 2 numbers"]);
    line_refused("v 1 2 3 4 5", &["found 5 numbers"]);
    line_refused("v 1 2 3 0", &["weight other than 0"]);
    line_refused("vn 1 x 2", &["found `x`"]);
    line_refused("vn 1 2", &["expected 3 numbers, found 2"]);
}

#[test]
fn corners_that_are_none() {
    line_refused("f", &["at least three corners"]);
    line_refused("f 1 2 x", &["found `x`"]);
    line_refused("f 1/2/3/4 2 3", &["found `1/2/3/4`"]);
    line_refused("f /1 2 3", &["found `/1`"]);
    line_refused("f 1.5 2 3", &["found `1.5`"]);
}

#[test]
fn index_zero() {
    line_refused("f 0 1 2", &["a vertex number from 1", "found 0"]);
    line_refused("f 1/0 2/0 3/0", &["a texture coordinate number from 1"]);
    line_refused("f 1//0 2//0 3//0", &["a normal number from 1"]);
}

#[test]
fn an_index_too_large() {
    line_refused("f 1 2 9", &["vertex 9 of 3"]);
    line_refused("f 1/5 2/5 3/5", &["texture coordinate 5 of 0"]);
    line_refused("f 1//7 2//7 3//7", &["normal 7 of 0"]);
    // The first is reported late, when its object ends, and still by its own line.
    text_refused(format!("{CORNERS}f 1 2 9\nf 1 2 3\n\no next\n"), &["bad.obj:4: vertex 9 of 3"]);
    text_refused(format!("{CORNERS}vn 0 0 1\nf 1//1 2//1 3//2\n"), &["bad.obj:5: normal 2 of 1"]);
}

#[test]
fn an_index_too_negative() {
    line_refused("f -1 -2 -4", &["vertex -4 of 3"]);
    line_refused("f 1/-1 2/-1 3/-1", &["texture coordinate -1 of 0"]);
    line_refused("f 1//-1 2//-1 3//-1", &["normal -1 of 0"]);
    line_refused("f 1//-9223372036854775808 2 3", &["normal -9223372036854775808 of 0"]);
}

#[test]
fn indices_at_and_past_the_ends_of_64_bits() {
    line_refused("f 1 2 9223372036854775807", &["expected at most 4294967295"]);
    line_refused("f 1 2 9223372036854775808", &["found `9223372036854775808`"]);
    line_refused("f 1/9223372036854775807 2 3", &["expected at most"]);
    line_refused("f 1 2 -99999999999999999999", &["found `-99999999999999999999`"]);
}

#[test]
fn a_file_that_breaks_off() {
    text_refused("v 0 0 0\nv 1 0 0\nv 0 1", &["bad.obj:3: ", "found 2 numbers"]);
    text_refused(format!("{CORNERS}f 1 2 3\nf 1 2 -"), &["bad.obj:5: ", "found `-`"]);
}

#[test]
fn text_that_is_not_utf8() {
    text_refused(b"v 0 0 0\no caf\xe9\n", &["bad.obj:2: expected text in UTF-8"]);
    text_refused([0xff, 0xfe, b'v', 0, b' ', 0], &["bad.obj:1: expected text in UTF-8"]);
}

#[test]
fn names_with_control_characters_stay_on_one_line() {
    line_refused("f 1 2 \u{1b}[31mred", &["\\u{1b}[31mred"]);
    text_refused(format!("{CORNERS}f 1 2 {}\n", "9".repeat(100_000)), &["..."]);
}

#[test]
fn a_name_is_missing() {
    line_refused("usemtl", &["a material's name"]);
    text_refused(format!("mtllib\n{CORNERS}f 1 2 3\n"), &["bad.obj: mtllib", "the name is empty"]);
}

#[test]
fn a_polygon_that_would_take_for_ever() {
    let mut text = String::new();
    for i in 0..10_000 {
        text += &format!("v {} {} 0\n", i, i % 2 * 5);
    }
    text += "v 5000 -9 0\nf";
    for i in 1..=10_001 {
        text += &format!(" {i}");
    }
    text_refused(text, &["bad.obj:10002: expected at most 4096 corners"]);
}

#[test]
fn more_objects_than_the_limit() {
    let mut text = CORNERS.to_owned();
    for _ in 0..(1 << 20) + 1 {
        text += "f 1 2 3\ng\n";
    }
    text_refused(text, &["expected at most 1048576 objects"]);
}

#[test]
fn overflowing_numbers_are_dropped_and_never_silent() {
    let folder = Folder::new();
    let text =
        format!("{CORNERS}v 1e400 0 0\nv -1e39 0 0\nv NaN 0 inf\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 2 3 6\n");
    let scene = formats::load(&folder.write("some.obj", text)).unwrap();
    assert_eq!((scene.triangles.len(), scene.dropped.non_finite), (1, 3));
    assert!(scene.warnings.iter().any(|w| w.contains("dropped 3 triangles")));
}

/// Asserts that a library is refused with a message that holds the words.
#[track_caller]
fn library_refused(library: impl AsRef<[u8]>, words: &[&str]) {
    let folder = Folder::new();
    folder.write("bad.mtl", library);
    let scene = folder.write("scene.obj", format!("mtllib bad.mtl\n{CORNERS}f 1 2 3\n"));
    refused(&scene, &[&["bad.mtl:"], words].concat());
}

#[test]
fn libraries_with_bad_lines() {
    library_refused("newmtl a\nKd 1 2\n", &[":2: expected three numbers", "found 2"]);
    library_refused("newmtl a\nKd\n", &[":2: expected three numbers"]);
    library_refused("newmtl a\nKs 1 x 1\n", &[":2: expected a finite number, found `x`"]);
    library_refused("newmtl a\nKd nan 0 0\n", &[":2: expected a finite number"]);
    library_refused("newmtl a\nNs\n", &[":2: expected a finite number after `Ns`"]);
    library_refused("newmtl\n", &[":1: expected a name"]);
    library_refused("newmtl a\nillum many\n", &[":2: expected a model"]);
    library_refused(b"newmtl a\nnewmtl \xff\n", &[":2: expected text in UTF-8"]);
}

#[test]
fn a_library_that_is_too_large() {
    let folder = Folder::new();
    folder.write("bad.mtl", vec![b'#'; (16 << 20) + 1]);
    let scene = folder.write("scene.obj", format!("mtllib bad.mtl\n{CORNERS}f 1 2 3\n"));
    refused(&scene, &["will not read `bad.mtl`", "16777217 bytes"]);
}
