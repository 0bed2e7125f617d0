//! Counts that can be read.

/// A count in decimal, in groups of three digits with commas.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut out = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped_by_three() {
        let counts = [0, 999, 1000, 12_345_678];
        assert_eq!(counts.map(grouped), ["0", "999", "1,000", "12,345,678"]);
    }
}
