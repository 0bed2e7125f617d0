//! What the lines of an OBJ file add up to, checked before the parser sees them.
//!
//! `tobj` takes indices on trust (`1/-9223372036854775808` overflows), reads polylines as faces, gives a
//! corner without a normal that of its predecessor, and passes over what it does not know. Here indices are
//! checked, such lines are kept from it or noted, and sizes are held within limits.

use super::lines::Verdict;
use crate::scene::formats::limits::{MAX_CORNERS, MAX_FACES, MAX_OBJECTS};
use crate::scene::formats::text::printable;

/// A kind of element that corners refer to, in the order of `v/vt/vn`.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Vertex,
    TextureCoordinate,
    Normal,
}

/// The kinds in words.
const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// A reference to an element that had not been defined yet where it was made.
#[derive(Clone, Copy)]
struct Forward {
    index: u64,
    line: usize,
}

/// What the parser does not tell about a face.
#[derive(Clone, Copy)]
pub(super) struct Outline {
    /// Lines past 2^32 do not fit into a scene file.
    pub(super) line: u32,
    /// Whether every corner has a normal.
    pub(super) has_normals: bool,
}

/// Counts and findings of one file.
#[derive(Default)]
pub(super) struct Tally {
    /// Vertices, texture coordinates and normals so far.
    defined: [u64; 3],
    /// For each kind the reference furthest ahead of its definition.
    forward: [Option<Forward>; 3],
    faces: usize,
    corners: usize,
    objects: u64,
    object_is_open: bool,
    /// The faces of three corners or more, in the order of the file.
    pub(super) outlines: Vec<Outline>,
    /// Faces of fewer corners, points and lines.
    pub(super) flat: usize,
    /// Lines of free-form curves and surfaces.
    pub(super) free_form: usize,
    /// Whether vertices have colours.
    pub(super) coloured: bool,
    /// Lines with an unknown keyword: how many, and the first.
    pub(super) unknown: Option<(usize, usize, String)>,
}

impl Tally {
    /// Looks at a line before the parser does.
    pub(super) fn inspect(&mut self, line: &str, number: usize) -> Verdict {
        let mut words = line.split_whitespace();
        let keyword = words.next();
        if let (Some("v" | "vn" | "f"), Some((statement, _remark))) = (keyword, line.split_once('#')) {
            return match self.inspect(statement, number) {
                Verdict::Pass => Verdict::Replace(statement.into()),
                other => other,
            };
        }
        match keyword {
            None => Verdict::Skip,
            Some("v") => {
                self.defined[0] += 1;
                let numbers: Vec<&str> = words.take(7).collect();
                if numbers.len() < 6 {
                    return Verdict::Pass;
                }
                self.coloured = true;
                Verdict::Replace(format!("v {} {} {}", numbers[0], numbers[1], numbers[2]))
            }
            // Textures are not drawn; only how many coordinates there are matters.
            Some("vt") => {
                self.defined[1] += 1;
                Verdict::Skip
            }
            Some("vn") => {
                self.defined[2] += 1;
                Verdict::Pass
            }
            Some("f") => match self.face(words, number) {
                Ok(verdict) => verdict,
                Err(why) => Verdict::Refuse(why),
            },
            Some("l" | "p") => {
                self.flat += 1;
                Verdict::Skip
            }
            Some("o" | "g" | "usemtl") => {
                self.objects += u64::from(std::mem::take(&mut self.object_is_open));
                if self.objects >= MAX_OBJECTS {
                    return Verdict::Refuse(format!("expected at most {MAX_OBJECTS} objects"));
                }
                Verdict::Pass
            }
            Some("mtllib") => Verdict::Pass,
            Some("curv" | "curv2" | "surf") => {
                self.free_form += 1;
                Verdict::Skip
            }
            Some(
                "s" | "mg" | "vp" | "cstype" | "deg" | "bmat" | "step" | "parm" | "trim" | "hole" | "scrv"
                | "sp" | "end" | "con" | "bevel" | "c_interp" | "d_interp" | "lod" | "maplib" | "usemap"
                | "shadow_obj" | "trace_obj" | "ctech" | "stech",
            ) => Verdict::Skip,
            Some(other) => {
                let (count, ..) = self.unknown.get_or_insert_with(|| (0, number, printable(other)));
                *count += 1;
                Verdict::Skip
            }
        }
    }

    fn face<'w>(&mut self, words: impl Iterator<Item = &'w str>, line: usize) -> Result<Verdict, String> {
        let mut corners = 0;
        let mut all_normals = true;
        for word in words {
            all_normals &= self.corner(word, line)?;
            corners += 1;
        }
        if corners == 0 {
            return Err("expected at least three corners after `f`".into());
        }
        self.faces += 1;
        self.corners += corners;
        if self.faces > MAX_FACES || self.corners > MAX_CORNERS {
            return Err(format!("expected at most {MAX_FACES} faces with {MAX_CORNERS} corners together"));
        }
        if corners < 3 {
            self.flat += 1;
            return Ok(Verdict::Skip);
        }
        self.object_is_open = true;
        self.outlines.push(Outline { line: line as u32, has_normals: all_normals });
        Ok(Verdict::Pass)
    }

    /// Checks one `v`, `v/vt`, `v//vn` or `v/vt/vn`; returns whether it has a normal.
    fn corner(&mut self, word: &str, line: usize) -> Result<bool, String> {
        let unreadable =
            || format!("expected vertex numbers such as 3, 3/1, 3//2 or 3/1/2, found `{}`", printable(word));
        let mut has_normal = false;
        for (kind, part) in word.split('/').enumerate() {
            if kind >= KINDS.len() || (kind == 0 && part.is_empty()) {
                return Err(unreadable());
            }
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| unreadable())?;
            let defined = self.defined[kind];
            if index == 0 {
                return Err(format!("expected a {} number from 1 or a negative one, found 0", KINDS[kind]));
            }
            if index < 0 && index.unsigned_abs() > defined {
                return Err(format!("{} {index} of {defined} so far", KINDS[kind]));
            }
            if index > i64::from(u32::MAX) {
                return Err(format!("{} {index}, expected at most {}", KINDS[kind], u32::MAX));
            }
            if index > 0 && index as u64 > defined {
                let furthest = self.forward[kind].get_or_insert(Forward { index: 0, line });
                if index as u64 > furthest.index {
                    *furthest = Forward { index: index as u64, line };
                }
            }
            has_normal |= kind == 2;
        }
        Ok(has_normal)
    }

    /// After a parser's complaint about an element out of range: the corner that reaches furthest.
    pub(super) fn furthest(&self, kind: Kind) -> Option<(usize, String)> {
        let Forward { index, line } = self.forward[kind as usize]?;
        Some((line, format!("{} {index} of {}", KINDS[kind as usize], self.defined[kind as usize])))
    }

    /// The corner that refers furthest past the end of what the whole file defines, if one does.
    pub(super) fn out_of_range(&self) -> Option<(usize, String)> {
        [Kind::Vertex, Kind::TextureCoordinate, Kind::Normal].into_iter().find_map(|kind| {
            self.forward[kind as usize].filter(|forward| forward.index > self.defined[kind as usize])?;
            self.furthest(kind)
        })
    }
}
