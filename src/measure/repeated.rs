//! Times of something that is done several times.

/// Seconds that the repetitions of one thing took.
#[derive(Debug, Clone, Default)]
pub struct Repeated {
    seconds: Vec<f64>,
}

impl Repeated {
    /// Once a thing has taken so many seconds in all, it is not repeated: its noise is small by then.
    pub const ENOUGH_SECONDS: f64 = 1.0;

    /// Adds a repetition.
    pub fn push(&mut self, seconds: f64) {
        self.seconds.push(seconds);
    }

    /// Whether it is worth doing once more, of at most so many times.
    pub fn is_worth_another(&self, most: u32) -> bool {
        self.seconds.len() < most as usize && self.seconds.iter().sum::<f64>() < Repeated::ENOUGH_SECONDS
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.seconds.len()
    }

    /// The shortest and the longest of the times; 0 if it was never done.
    pub fn spread(&self) -> [f64; 2] {
        let shortest = self.seconds.iter().copied().reduce(f64::min);
        let longest = self.seconds.iter().copied().reduce(f64::max);
        [shortest.unwrap_or(0.0), longest.unwrap_or(0.0)]
    }

    /// The numbers of the things whose medians are the shortest, so many at most, the shortest first.
    pub fn fastest<'a>(things: impl Iterator<Item = (usize, &'a Repeated)>, most: usize) -> Vec<usize> {
        let mut medians: Vec<(usize, f64)> = things.map(|(number, times)| (number, times.median())).collect();
        medians.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        medians.truncate(most);
        medians.into_iter().map(|(number, _)| number).collect()
    }

    /// The middle one of the times, of an even number the mean of the two; 0 if it was never done.
    pub fn median(&self) -> f64 {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.len() {
            0 => 0.0,
            n if n % 2 == 1 => sorted[n / 2],
            n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeated(seconds: &[f64]) -> Repeated {
        Repeated { seconds: seconds.to_vec() }
    }

    #[test]
    fn the_median_is_the_one_in_the_middle() {
        assert_eq!(repeated(&[]).median(), 0.0);
        assert_eq!(repeated(&[3.0, 1.0, 2.0]).median(), 2.0);
        assert_eq!(repeated(&[4.0, 1.0]).median(), 2.5);
        assert_eq!((repeated(&[4.0, 1.0]).spread(), repeated(&[]).spread()), ([1.0, 4.0], [0.0, 0.0]));
    }

    #[test]
    fn what_takes_long_is_done_once() {
        assert!(repeated(&[]).is_worth_another(1));
        assert!(repeated(&[0.1]).is_worth_another(3));
        assert!(!repeated(&[0.1]).is_worth_another(1));
        assert!(!repeated(&[1.5]).is_worth_another(3));
    }
}
