//! Names of the files of frames: `shot.####.exr` is `shot.0001.exr`.

use std::path::{Path, PathBuf};

/// Digits where the name does not say how many.
const USUAL_DIGITS: usize = 4;

/// A name with a place for the number of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameNames {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl FrameNames {
    /// The number stands where the file's name has a run of `#`, with zeros before it up to as many digits, and otherwise
    /// with four of them before the extension.
    ///
    /// # Errors
    /// A line if the name has several such runs, so that nobody can say which is meant, or is not in UTF-8.
    pub fn of(path: &Path) -> Result<FrameNames, String> {
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or("expected a file's name in UTF-8 for frames")?;
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        let Some(first) = name.find('#') else {
            let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
            let (before, after) = (format!("{stem}."), format!(".{extension}"));
            return Ok(FrameNames { folder, before, digits: USUAL_DIGITS, after });
        };
        let digits = name[first..].bytes().take_while(|byte| *byte == b'#').count();
        let after = &name[first + digits..];
        if after.contains('#') {
            return Err(format!(
                "expected one run of # for the number of the frame, found several in `{name}`"
            ));
        }
        Ok(FrameNames { folder, before: name[..first].into(), digits, after: after.into() })
    }

    /// The same names with something before the extension.
    pub fn with_suffix(self, suffix: &str) -> FrameNames {
        let (stem, extension) = self.after.rsplit_once('.').unwrap_or((&self.after, ""));
        let after = format!("{stem}{suffix}.{extension}");
        FrameNames { after, ..self }
    }

    /// The name of a frame. Different frames have different names, also where a number has more digits.
    pub fn path(&self, frame: u32) -> PathBuf {
        let FrameNames { folder, before, digits, after } = self;
        folder.join(format!("{before}{frame:0digits$}{after}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_stand_where_the_name_has_a_place_or_before_the_extension() {
        for (pattern, frame, name) in [
            ("shot.####.exr", 1, "shot.0001.exr"),
            ("out/shot_##.exr", 7, "out/shot_07.exr"),
            ("#.exr", 120, "120.exr"),
            ("####.exr", 12345, "12345.exr"),
            ("shot.exr", 1, "shot.0001.exr"),
            ("a.b.EXR", 30, "a.b.0030.EXR"),
            ("take#2/x.exr", 5, "take#2/x.0005.exr"),
        ] {
            assert_eq!(FrameNames::of(Path::new(pattern)).unwrap().path(frame), Path::new(name));
        }
        for (pattern, name) in [("shot.exr", "shot.0007.part.exr"), ("##_x.exr", "07_x.part.exr")] {
            let names = FrameNames::of(Path::new(pattern)).unwrap().with_suffix(".part");
            assert_eq!(names.path(7), Path::new(name));
        }
        let error = FrameNames::of(Path::new("a##_##.exr")).unwrap_err();
        assert!(error.contains("several in `a##_##.exr`"), "{error}");
    }

    proptest! {
        #[test]
        fn no_two_frames_have_one_name(
            stem in "[a-z0-9.]{0,4}#{0,3}[a-z0-9.]{0,4}",
            one in 0u32..9_999_999,
            other in 0u32..9_999_999,
        ) {
            let names = FrameNames::of(Path::new(&format!("{stem}.exr"))).unwrap();
            prop_assert_eq!(names.path(one) == names.path(other), one == other);
        }
    }
}
