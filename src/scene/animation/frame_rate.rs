//! Frames a second, as a fraction: 24, and 24000/1001 where televisions need it.

use std::fmt;

/// Frames a second: a fraction above 0 and at most [`FrameRate::MOST`], in lowest terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameRate {
    numerator: u32,
    denominator: u32,
}

impl Default for FrameRate {
    /// That of film.
    fn default() -> FrameRate {
        FrameRate { numerator: 24, denominator: 1 }
    }
}

impl FrameRate {
    /// The most frames a second.
    pub const MOST: u32 = 1_000_000;

    /// A fraction.
    ///
    /// # Errors
    /// A line if it is 0 or more than [`FrameRate::MOST`], or its terms do not fit into 31 bits, as OpenEXR has them.
    pub fn new(numerator: u32, denominator: u32) -> Result<FrameRate, String> {
        let most = i32::MAX as u32;
        let is_in_range = numerator > 0
            && denominator > 0
            && numerator <= most
            && denominator <= most
            && u64::from(numerator) <= u64::from(FrameRate::MOST) * u64::from(denominator);
        if !is_in_range {
            return Err(format!(
                "expected frames a second above 0 and at most {}, such as 24, 23.976 or 24000/1001",
                FrameRate::MOST
            ));
        }
        let common = greatest_divisor(numerator, denominator);
        Ok(FrameRate { numerator: numerator / common, denominator: denominator / common })
    }

    /// Reads `24`, `23.976` or `24000/1001`.
    ///
    /// # Errors
    /// As [`new`](FrameRate::new), and for what is no number.
    pub fn parse(text: &str) -> Result<FrameRate, String> {
        if let Some((numerator, denominator)) = text.split_once('/') {
            let term = |text: &str| text.trim().parse().unwrap_or(0);
            return FrameRate::new(term(numerator), term(denominator));
        }
        FrameRate::near(text.trim().parse().unwrap_or(f64::NAN))
    }

    /// The fraction that a decimal number stands for: 23.976 and 23.98 are 24000/1001, as 29.97 is 30000/1001, and other
    /// numbers have thousandths.
    ///
    /// # Errors
    /// As [`new`](FrameRate::new).
    pub fn near(rate: f64) -> Result<FrameRate, String> {
        let out_of_range = || FrameRate::new(0, 1);
        if !(rate > 0.0 && rate <= f64::from(FrameRate::MOST)) {
            return out_of_range();
        }
        if rate == rate.round() {
            return FrameRate::new(rate as u32, 1);
        }
        // Rates of television are a thousandth below whole ones, and are written with two or three digits.
        let whole = rate.ceil();
        if (whole * 1000.0 / 1001.0 - rate).abs() < 0.005 && whole <= 1000.0 {
            return FrameRate::new(whole as u32 * 1000, 1001);
        }
        FrameRate::new((rate * 1000.0).round() as u32, 1000)
    }

    /// The seconds at which a frame is: frame 0 is at the beginning, and frames need not be whole.
    pub fn seconds(self, frame: f64) -> f64 {
        frame * f64::from(self.denominator) / f64::from(self.numerator)
    }

    /// The frame that is at so many seconds.
    pub fn frame(self, seconds: f64) -> f64 {
        seconds * f64::from(self.numerator) / f64::from(self.denominator)
    }

    /// Numerator and denominator.
    pub fn fraction(self) -> (u32, u32) {
        (self.numerator, self.denominator)
    }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.denominator {
            1 => write!(f, "{}", self.numerator),
            _ => write!(f, "{}/{}", self.numerator, self.denominator),
        }
    }
}

fn greatest_divisor(mut a: u32, mut b: u32) -> u32 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_fractions_in_lowest_terms() {
        for (text, expected) in [
            ("24", "24"),
            ("25.0", "25"),
            ("23.976", "24000/1001"),
            ("23.98", "24000/1001"),
            ("29.97", "30000/1001"),
            ("59.94", "60000/1001"),
            ("48/2", "24"),
            ("30000/1001", "30000/1001"),
            ("12.5", "25/2"),
        ] {
            assert_eq!(FrameRate::parse(text).unwrap().to_string(), expected, "{text}");
        }
        for bad in ["", "0", "-24", "nan", "inf", "1e7", "24/0", "0/1", "a", "24/x", "4294967296/1", "1e-9"] {
            assert!(FrameRate::parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn frame_0_is_the_beginning_and_frames_are_found_again() {
        let rate = FrameRate::default();
        assert_eq!((rate.seconds(0.0), rate.seconds(12.0), rate.seconds(48.0)), (0.0, 0.5, 2.0));
        let television = FrameRate::new(30000, 1001).unwrap();
        assert!((television.frame(television.seconds(77.0)) - 77.0).abs() < 1e-12);
    }
}
