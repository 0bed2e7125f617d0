//! Numbers as text that is read back bit by bit.

use glam::Vec3;

/// A number in as few digits as give it back, whether they are rounded to 32 bits at once or by way of 64.
pub(super) fn single(number: f32) -> String {
    let short = format!("{number:?}");
    // Rounded twice, the shortest digits may come out beside the number.
    let twice = short.parse::<f64>().map(|number| number as f32);
    let text = match twice.map(f32::to_bits) == Ok(number.to_bits()) {
        true => short,
        false => format!("{:?}", f64::from(number)),
    };
    whole(text)
}

/// A number of 64 bits.
pub(super) fn double(number: f64) -> String {
    whole(format!("{number:?}"))
}

/// Without a point where none is needed; minus zero needs one.
fn whole(text: String) -> String {
    match text.strip_suffix(".0") {
        Some("-0") | None => text,
        Some(digits) => digits.to_owned(),
    }
}

/// `[1, 2, 3]`
pub(super) fn array(numbers: &[f32]) -> String {
    format!("[{}]", joined(numbers, ", "))
}

/// The same for a vector.
pub(super) fn vector(vector: Vec3) -> String {
    array(&vector.to_array())
}

/// One number if all three are equal.
pub(super) fn colour(channels: [f32; 3]) -> String {
    match channels {
        [r, g, b] if r.to_bits() == g.to_bits() && g.to_bits() == b.to_bits() => single(r),
        _ => array(&channels),
    }
}

/// Numbers with something between them.
pub(super) fn joined(numbers: &[f32], between: &str) -> String {
    numbers.iter().map(|&number| single(number)).collect::<Vec<_>>().join(between)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn digits_are_as_few_as_can_be() {
        for (number, text) in
            [(0.1, "0.1"), (1.0, "1"), (-0.0, "-0.0"), (0.0, "0"), (1e30, "1e30"), (-2.5e-8, "-2.5e-8")]
        {
            assert_eq!(single(number), text);
        }
        assert_eq!(double(0.1), "0.1");
        assert_eq!((colour([0.5; 3]), colour([0.0, -0.0, 0.0])), ("0.5".into(), "[0, -0.0, 0]".into()));
    }

    proptest! {
        #[test]
        fn every_number_is_read_back(bits in any::<u32>()) {
            let number = f32::from_bits(bits);
            prop_assume!(number.is_finite());
            let text = single(number);
            prop_assert_eq!(text.parse::<f32>().unwrap().to_bits(), bits);
            prop_assert_eq!((text.parse::<f64>().unwrap() as f32).to_bits(), bits);
        }
    }
}
