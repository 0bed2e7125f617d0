//! What is done with one input of the fuzzer, and what must then be so: the one place for the targets and for the
//! test that replays the corpus.
//!
//! Whatever is not so is a panic.

mod desk;
mod exr;
pub mod mend;
mod round_trip;
mod scene;
pub mod shadow_buffer;

pub use desk::Desk;
pub use scene::assert_whole;

use std::path::Path;

/// A kind of file, with all that reads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    Obj,
    Ply,
    Nff,
    Gltf,
    Glb,
    Toml,
    Picture,
    ShadowBuffer,
    Exr,
}

/// What became of an input; either is fine.
#[derive(Debug)]
pub enum Outcome {
    Loaded,
    /// With the line that says why.
    Refused(String),
}

/// What stands between the files of an input that is several.
pub const SEPARATOR: &[u8] = b"\n=====\n";

impl Target {
    pub const ALL: [Target; 9] = [
        Target::Obj,
        Target::Ply,
        Target::Nff,
        Target::Gltf,
        Target::Glb,
        Target::Toml,
        Target::Picture,
        Target::ShadowBuffer,
        Target::Exr,
    ];

    /// The name of its folder in the corpus, of its dictionary and of its program.
    pub fn name(self) -> &'static str {
        match self {
            Target::Obj => "obj",
            Target::Ply => "ply",
            Target::Nff => "nff",
            Target::Gltf => "gltf",
            Target::Glb => "glb",
            Target::Toml => "toml",
            Target::Picture => "picture",
            Target::ShadowBuffer => "shadow-buffer",
            Target::Exr => "exr",
        }
    }

    /// Loads an input and asserts all that must hold. The desk is there for the files.
    ///
    /// # Panics
    /// If anything does not hold, or the code that is tested panics.
    pub fn check(self, input: &[u8], desk: &mut Desk) -> Outcome {
        match self {
            Target::Obj => scene::check(desk, &parts(input, &["scene.obj", "paint.mtl", "other.mtl"])),
            Target::Ply => scene::check(desk, &[("scene.ply", input)]),
            Target::Nff => scene::check(desk, &[("scene.nff", input)]),
            Target::Gltf => scene::check(desk, &parts(input, &["scene.gltf", "part.bin", "picture.png"])),
            Target::Toml => {
                scene::check(desk, &parts(input, &["scene.toml", "part.obj", "part.toml", "picture.png"]))
            }
            Target::Glb => {
                let (how, file) = split_first(input);
                let file = if how == b'm' { mend::glb(file) } else { file.to_vec() };
                scene::check(desk, &[("scene.glb", &file)])
            }
            Target::Picture => picture(desk, input),
            Target::ShadowBuffer => shadow_buffer::check(desk, input),
            Target::Exr => exr::check(desk, input),
        }
    }
}

/// The files of an input, as far as it has them.
fn parts<'a>(input: &'a [u8], names: &[&'static str]) -> Vec<(&'static str, &'a [u8])> {
    let mut rest = Some(input);
    let mut next = || {
        let whole = rest?;
        let at = whole.windows(SEPARATOR.len()).position(|bytes| bytes == SEPARATOR);
        rest = at.map(|at| &whole[at + SEPARATOR.len()..]);
        Some(&whole[..at.unwrap_or(whole.len())])
    };
    names.iter().map_while(|&name| Some((name, next()?))).collect()
}

/// The first byte of an input, which says what is done with the rest.
fn split_first(input: &[u8]) -> (u8, &[u8]) {
    input.split_first().map_or((0, &[]), |(&first, rest)| (first, rest))
}

/// A picture as a texture or, after the letter `a` or `b`, as an alpha mask; the letters `b` and `m` mend its
/// checksums.
fn picture(desk: &mut Desk, input: &[u8]) -> Outcome {
    const TEXTURED: &[u8] =
        b"version = 1\n[[material]]\nname = 'a'\ntexture = { image = 'picture.png', origin = [0, 0, 0], \
        u = [1, 0, 0], v = [0, 1, 0] }\n[[sphere]]\nmaterial = 'a'\ncentre = [0, 1, 0]\nradius = 2\n";
    const MASKED: &[u8] = include_bytes!("masked.gltf");
    let (how, picture) = split_first(input);
    let picture = if matches!(how, b'b' | b'm') { mend::png(picture) } else { picture.to_vec() };
    let scene = if matches!(how, b'a' | b'b') { ("scene.gltf", MASKED) } else { ("scene.toml", TEXTURED) };
    scene::check(desk, &[scene, ("picture.png", &picture)])
}

/// Asserts the form of an error about a file of the desk, and returns it.
fn refusal(path: &Path, error: &lightbuffer::Error) -> String {
    let line = error.to_string();
    // A file beside the one that was loaded may be the one to blame.
    let folder = path.parent().expect("files lie in a folder").display().to_string();
    assert!(line.starts_with(&folder), "{line:?} does not name the file");
    assert_printable(&line);
    assert!(line.len() < folder.len() + 600, "{} bytes are too long for a line: {line:?}", line.len());
    line
}

/// Asserts that a text is one line without surprises for a terminal.
fn assert_printable(text: &str) {
    let breaks = |c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}');
    assert!(!text.chars().any(breaks), "{text:?} is more than a line");
}
