//! NFF.

use crate::fixtures::Folder;
use crate::refused;
use lightbuffer::scene::formats;

const TRIANGLE: &str = "p 3\n0 0 0\n1 0 0\n0 1 0\n";
const VIEW: &str = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 8\n";

/// Asserts that a text is refused with a message that holds the words.
#[track_caller]
fn text_refused(text: impl AsRef<[u8]>, words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.nff", text), words);
}

/// The same for one entity after a good one of four lines.
#[track_caller]
fn entity_refused(entity: &str, words: &[&str]) {
    text_refused(format!("{TRIANGLE}{entity}\n{TRIANGLE}"), words);
}

/// The same for a viewpoint with one text in place of another.
#[track_caller]
fn view_refused(part: &str, other: &str, words: &[&str]) {
    assert!(VIEW.contains(part), "{part:?}");
    text_refused(format!("{}{TRIANGLE}", VIEW.replacen(part, other, 1)), words);
}

#[test]
fn an_empty_file_and_one_without_triangles() {
    text_refused("", &["bad.nff: expected at least one triangle"]);
    text_refused("# nothing\n\n", &["expected at least one triangle"]);
    text_refused(VIEW, &["expected at least one triangle"]);
    text_refused("p 3\n0 0 0\n1 0 0\n2 0 0\n", &["found 1 of zero area"]);
}

#[test]
fn curved_primitives_that_break_off_or_contradict_themselves() {
    entity_refused("s 0 0 0", &["bad.nff:6: expected a number, found `p`"]);
    entity_refused("s 0 0 0 x", &["bad.nff:5: expected a number, found `x`"]);
    entity_refused("s 0 0 0 1 1", &["bad.nff:5: expected the end of the line, found `1`"]);
    entity_refused("c 0 0 0 1 0 0 1", &["bad.nff:6: expected a number, found `p`"]);
    entity_refused("c\n0 0 0 1\n0 0 1 1 1", &["bad.nff:7: expected the end of the line, found `1`"]);
    entity_refused("c\n0 0 0 1\n0 0 1 -1", &["bad.nff:5: expected radii of one sign, found 1 and -1"]);
    entity_refused("c 0 0 0 -inf 0 0 1 inf", &["bad.nff:5: expected radii of one sign, found -inf and inf"]);
    text_refused("s 0 0 0 0\n", &["bad.nff: expected at least one triangle", "found 1 of zero area"]);
    text_refused("s 1 2", &["bad.nff:1: expected a number, found the end of the file"]);
}

#[test]
fn curved_primitives_without_area_are_dropped_and_never_silent() {
    let folder = Folder::new();
    let text = "s 0 0 0 0\ns 0 0 0 nan\ns 0 1e99 0 1\ns 0 0 0 -0\ns 0 0 0 inf\nc 0 0 0 1 0 0 0 1\n\
                c 0 0 0 0 0 0 1 -0\nc 0 0 0 nan 0 0 1 -1\nc 0 0 0 1e-60 0 0 1 0\ns 0 0 0 1e-45\n";
    let scene = formats::load(&folder.write("some.nff", text)).unwrap();
    assert_eq!((scene.curved.len(), scene.dropped.curved), (1, 9));
    assert!(scene.warnings.iter().any(|w| w.contains("dropped 9 curved surfaces")), "{:?}", scene.warnings);
}

#[test]
fn transmittances_and_colours_out_of_range() {
    for (transmittance, shown) in [("2", "2"), ("1.0000001", "1.0000001"), ("-0.5", "-0.5")] {
        let words = format!("bad.nff:5: expected a transmittance from 0 to 1, found {shown}");
        entity_refused(&format!("f 1 1 1 1 0 1 {transmittance} 1.5"), &[&words]);
    }
    entity_refused("f 1 1 1 1 0 1 nan 1.5", &["bad.nff:5: expected a finite number, found NaN"]);
    entity_refused("f 1 1 1 1 0 1\n2\n1.5", &["bad.nff:7: expected a transmittance from 0 to 1"]);
    for index in ["0", "-0", "-1.5", "1e-60"] {
        let words = "bad.nff:5: expected an index of refraction above 0, found ";
        entity_refused(&format!("f 1 1 1 1 0 1 0.5 {index}"), &[words]);
    }
    entity_refused("f 1 1 1 1 0 1 0.5 inf", &["bad.nff:5: expected a finite number, found inf"]);
    for colour in ["-1", "1e31"] {
        entity_refused(&format!("b 0 {colour} 0"), &["bad.nff:5: expected a colour from 0 to 1e30"]);
    }
}

#[test]
fn entities_that_are_none() {
    entity_refused("what 1 2", &["bad.nff:5: expected one of v, b, l, f, p, pp, s and c, found `what`"]);
    entity_refused("1 2 3", &["bad.nff:5: expected one of v, b", "found `1`"]);
    entity_refused("from 1 2 3", &["bad.nff:5: expected one of v", "found `from`"]);
    entity_refused("P 3", &["found `P`"]);
    entity_refused("\u{1b}[31m", &["found `\\u{1b}[31m`"]);
    entity_refused(&"x".repeat(100_000), &["..."]);
    text_refused([&b"b 0 0 0\n"[..], b"\xff\xfe\n"].concat(), &["bad.nff:2: ", "\u{fffd}"]);
    text_refused([0xff, 0xfe, b'v', 0, b'\n', 0], &["bad.nff:1: "]);
    text_refused([0; 50], &["bad.nff:1: expected one of", "\\u{0}\\u{0}"]);
}

#[test]
fn entities_begin_a_line() {
    entity_refused("p 3 0 0 0 1 0 0 0 1 0 p 3", &["bad.nff:5: expected the end of the line, found `p`"]);
    entity_refused("b 0 0 0 0", &["bad.nff:5: expected the end of the line, found `0`"]);
    entity_refused("l 0 0 0 1 1 1 1", &["bad.nff:5: expected the end of the line, found `1`"]);
    entity_refused("f 1 1 1 1 0 1 0 0 l", &["bad.nff:5: expected the end of the line, found `l`"]);
    view_refused("v", "v from 1 2 3", &["bad.nff:1: expected the end of the line, found `from`"]);
    view_refused("angle 45", "angle 45 46", &["bad.nff:5: expected the end of the line, found `46`"]);
}

#[test]
fn numbers_that_are_none_or_too_few() {
    entity_refused("p 3\n0 0 0\n1 x 0\n0 1 0", &["bad.nff:7: expected a number, found `x`"]);
    entity_refused("p 3\n0 0 0\n1 0 0", &["bad.nff:8: expected a number, found `p`"]);
    entity_refused("p 2\n0 0 0\n1 0 0\n0 1 0", &["bad.nff:8: expected one of", "found `0`"]);
    entity_refused("f 1 1 1 1 0 1 0", &["bad.nff:6: expected a number, found `p`"]);
    entity_refused("f 1 1 1 1 0 1 0 nan", &["bad.nff:5: expected a finite number, found NaN"]);
    entity_refused("f 1e99 1 1 1 0 1 0 0", &["bad.nff:5: expected a finite number, found inf"]);
    entity_refused("b 0 0 inf", &["bad.nff:5: expected a finite number"]);
    entity_refused("b 0 0", &["bad.nff:6: expected a number, found `p`"]);
    text_refused(
        format!("{TRIANGLE}p 3\n0 0 0\n1 0 0\n0 1 # 0\n\n"),
        &["bad.nff:9: expected a number", "the end of the file"],
    );
    entity_refused(&format!("p 3\n0 0 {}", "9x".repeat(100_000)), &["bad.nff:6: ", "..."]);
}

#[test]
fn counts_that_are_none_or_that_the_file_cannot_hold() {
    for count in ["-3", "3.0", "x", "18446744073709551616", "nan"] {
        entity_refused(
            &format!("p {count}"),
            &[&format!("bad.nff:5: expected a number of corners, found `{count}`")],
        );
    }
    for count in ["20", "2147483648", "4294967296", "9223372036854775807", "18446744073709551615"] {
        for keyword in ["p", "pp"] {
            let words = format!("bad.nff:5: a polygon of {count} corners, and there is room for ");
            entity_refused(&format!("{keyword} {count}\n0 0 0"), &[&words]);
        }
    }
    text_refused("p", &["bad.nff:1: expected a number of corners, found the end of the file"]);
    text_refused("pp 3", &["bad.nff:1: a polygon of 3 corners, and there is room for 0"]);
}

#[test]
fn lights_that_are_none() {
    entity_refused("l 1 2", &["bad.nff:6: expected a number, found `p`"]);
    entity_refused("l 1 2 nan", &["bad.nff:5: expected a finite number"]);
    entity_refused("l 1 2 1e39", &["bad.nff:5: expected a finite number"]);
    entity_refused("l 1 2 3 1", &["bad.nff:5: expected three numbers or none as a light's colour, found 1"]);
    entity_refused("l 1 2 3 1 1", &["found 2"]);
    entity_refused("l 1 2 3 1 x 1", &["bad.nff:5: expected a number, found `x`"]);
    for colour in ["-1", "nan", "inf", "1e31"] {
        entity_refused(&format!("l 1 2 3 1 1 {colour}"), &["bad.nff:5: expected a colour from 0 to 1e30"]);
    }
    text_refused("l 0 0 9\n".repeat(16_385), &["bad.nff:16385: expected at most 16384 lights"]);
}

#[test]
fn viewpoints_that_are_none() {
    for keyword in ["from", "at", "up", "angle", "resolution"] {
        let line = VIEW.lines().find(|line| line.starts_with(keyword)).unwrap();
        view_refused(
            &format!("{line}\n"),
            "",
            &[&format!("bad.nff:1: the viewpoint has no line `{keyword}`")],
        );
        view_refused(line, &format!("{line}\n{line}"), &[&format!("a second `{keyword}` of one viewpoint")]);
    }
    for angle in ["0", "-45", "180", "nan", "inf"] {
        view_refused("45", angle, &["bad.nff:1: angle ", "expected one between 0 and 180"]);
    }
    view_refused("45", "wide", &["bad.nff:5: expected an angle, found `wide`"]);
    view_refused("hither 1", "hither near", &["bad.nff:6: expected a distance, found `near`"]);
    view_refused("0 0 5", "0 0 0", &["bad.nff:1: `from` and `at` leave no direction"]);
    view_refused("0 0 5", "0 0 nan", &["bad.nff:2: expected a finite number"]);
    text_refused(
        format!("{}{TRIANGLE}", VIEW.replace("0 0 5", "0 0 3e38").replace("at 0 0 0", "at 0 0 -3e38")),
        &["leave no direction"],
    );
    view_refused("0 1 0", "0 0 0", &["bad.nff:1: expected `up` to be a direction"]);
    view_refused("0 1 0", "0 0 -7", &["bad.nff:1: `up` is the direction to look in"]);
    view_refused("0 1 0", "1e-7 0 1", &["bad.nff:1: `up` is the direction to look in"]);
    view_refused("8 8", "0 8", &["bad.nff:7: resolution 0 8: both sides must be at least 1"]);
    view_refused("8 8", "8 0", &["resolution 8 0: both sides must be at least 1"]);
    view_refused("8 8", "-8 8", &["bad.nff:7: expected a number of pixels, found `-8`"]);
    view_refused("8 8", "8.5 8", &["bad.nff:7: expected a number of pixels"]);
    view_refused("8 8", "4096 4097", &["bad.nff:7: resolution 4096 4097: more than 16777216 pixels"]);
    view_refused("8 8", "4294967295 4294967295", &["more than 16777216 pixels"]);
}

#[test]
fn a_file_cut_anywhere() {
    let folder = Folder::new();
    let whole = format!("{VIEW}l 1 2 3\nf 1 1 1 1 0 1 0 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1");
    assert_eq!(formats::load(&folder.write("whole.nff", &whole)).unwrap().triangles.len(), 1);
    for length in 0..whole.len() {
        refused(&folder.write("bad.nff", &whole[..length]), &["bad.nff:"]);
    }
}

#[test]
fn a_polygon_that_would_take_for_ever() {
    let mut text = format!("{TRIANGLE}p 10001\n");
    for i in 0..10_000 {
        text += &format!("{i} {} 0\n", i % 2 * 5);
    }
    text += "5000 -9 0\n";
    text_refused(text, &["bad.nff:5: expected at most 4096 corners"]);
}

#[test]
fn more_materials_than_the_limit() {
    text_refused(
        "f 1 1 1 1 0 1 0 0\n".repeat((1 << 20) + 1),
        &["bad.nff:1048577: expected at most 1048576 materials"],
    );
}

#[test]
fn overflowing_numbers_are_dropped_and_never_silent() {
    let folder = Folder::new();
    let text = format!("{TRIANGLE}p 3\n0 0 0\n1e400 0 0\n0 1 0\np 4\n0 0 0\n1 0 0\n1 NaN 0\n0 inf 0\n");
    let scene = formats::load(&folder.write("some.nff", text)).unwrap();
    assert_eq!((scene.triangles.len(), scene.dropped.non_finite), (1, 3));
    assert!(scene.warnings.iter().any(|w| w.contains("dropped 3 triangles")));
}
