//! Which frames: `1-30,40,50-100:2`.

use std::collections::BTreeSet;

/// The most frames of one run.
const MOST_FRAMES: u64 = 100_000;

/// The last frame that there can be.
const LAST_FRAME: u32 = 9_999_999;

/// Numbers of frames, ascending, each once, and at least one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameList(Vec<u32>);

impl FrameList {
    /// The runs and single frames that it is made of, as [`parse`](FrameList::parse) reads them.
    pub fn text(&self) -> String {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        for &frame in &self.0 {
            match runs.last_mut() {
                Some((_, last)) if *last + 1 == frame => *last = frame,
                _ => runs.push((frame, frame)),
            }
        }
        let run = |(first, last)| if first == last { format!("{first}") } else { format!("{first}-{last}") };
        runs.into_iter().map(run).collect::<Vec<_>>().join(",")
    }

    /// The numbers.
    pub fn numbers(&self) -> &[u32] {
        &self.0
    }

    /// Reads single frames, ranges, and ranges with a step, separated by commas.
    ///
    /// # Errors
    /// A line for what is none of these, and for more than [`MOST_FRAMES`].
    pub fn parse(text: &str) -> Result<FrameList, String> {
        let mut frames = BTreeSet::new();
        let mut named = 0;
        for part in text.split(',') {
            let (first, last, step) = range(part.trim())?;
            named += u64::from((last - first) / step) + 1;
            if named > MOST_FRAMES {
                return Err(format!("expected at most {MOST_FRAMES} frames in one run"));
            }
            frames.extend((first..=last).step_by(step as usize));
        }
        Ok(FrameList(frames.into_iter().collect()))
    }
}

fn range(part: &str) -> Result<(u32, u32, u32), String> {
    let malformed =
        || format!("expected frames such as 7, 1-30 or 50-100:2, separated by commas, found `{part}`");
    if part.starts_with('-') {
        return Err(format!("frames count from 0, found `{part}`"));
    }
    let (frames, step) = match part.split_once(':') {
        None => (part, 1),
        Some((_, "0")) => return Err(format!("expected a step of at least 1, found `{part}`")),
        Some((frames, step)) if frames.contains('-') => (frames, number(step).ok_or_else(malformed)?),
        Some(_) => return Err(malformed()),
    };
    let (first, last) = frames.split_once('-').unwrap_or((frames, frames));
    let frame = |text: &str| match number(text) {
        Some(frame) if frame <= LAST_FRAME => Ok(frame),
        Some(_) => Err(format!("expected frames up to {LAST_FRAME}, found `{part}`")),
        None => Err(malformed()),
    };
    match (frame(first)?, frame(last)?) {
        (first, last) if first <= last && step > 0 => Ok((first, last, step)),
        _ => Err(format!("expected the first frame of a range before its last one, found `{part}`")),
    }
}

/// A number of digits alone; what is too large for any frame is the largest.
fn number(text: &str) -> Option<u32> {
    let is_number = !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_digit());
    is_number.then(|| text.parse().unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn frames_ranges_and_steps_ascend_and_come_once() {
        let parse = |text| FrameList::parse(text).unwrap().0;
        assert_eq!(parse("7"), [7]);
        assert_eq!(parse("3-5"), [3, 4, 5]);
        assert_eq!(parse("50-57:3"), [50, 53, 56]);
        assert_eq!(parse("9, 1-3,2-4 ,0"), [0, 1, 2, 3, 4, 9]);
        assert_eq!(parse("1-30,40,50-100:2").len(), 30 + 1 + 26);
        assert_eq!(parse("5-5:100"), [5]);
        assert_eq!(parse("0-9999999:100").len(), 100_000);
    }

    #[test]
    fn what_is_no_list_of_frames_is_refused_in_a_line_before_it_is_expanded() {
        for (text, why) in [
            ("", "such as 7"),
            ("1,,2", "such as 7"),
            ("1-", "such as 7"),
            ("a-b", "such as 7"),
            ("1-2-3", "such as 7"),
            ("+1", "such as 7"),
            ("1.5", "such as 7"),
            ("4:2", "such as 7"),
            ("1-9:", "such as 7"),
            ("1-9:-2", "such as 7"),
            ("-5", "count from 0"),
            ("-5-10", "count from 0"),
            ("1-9:0", "a step of at least 1"),
            ("1-9:00", "before its last"),
            ("9-1", "before its last"),
            ("0-9999999", "at most 100000 frames"),
            ("1-60000,1-60000", "at most 100000 frames"),
            ("10000000", "up to 9999999"),
            ("99999999999999999999", "up to 9999999"),
        ] {
            let error = FrameList::parse(text).unwrap_err();
            assert!(error.contains(why) && error.lines().count() == 1, "{text}: {error}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_a_list_or_a_line(text in "[-0-9,: a]{0,20}") {
            match FrameList::parse(&text) {
                Ok(list) => {
                    prop_assert!(list.0.windows(2).all(|pair| pair[0] < pair[1]) && !list.0.is_empty());
                    prop_assert_eq!(FrameList::parse(&list.text()), Ok(list));
                }
                Err(why) => prop_assert_eq!(why.lines().count(), 1),
            }
        }
    }
}
