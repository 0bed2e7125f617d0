//! Values over time, given at a few times and found in between.

use glam::{DQuat, DVec3};

/// What can be between two values.
pub trait Value: Copy + Send + Sync + 'static {
    /// The value a share of the way from one to the other; at 0 it is the first, bit by bit.
    fn between(from: Self, to: Self, share: f64) -> Self;

    /// The cubic with these values and slopes at its two ends, which are 1 apart.
    fn cubic(from: Self, leaving: Self, to: Self, arriving: Self, share: f64) -> Self;

    /// Times a number.
    fn scaled(self, factor: f64) -> Self;

    /// Whether all its numbers are finite.
    fn is_finite(self) -> bool;
}

/// How a value goes from one key to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Way<T> {
    /// It stays until the next.
    Step,
    /// Straight, at one speed.
    Linear,
    /// On a cubic with these slopes a second.
    Cubic {
        /// At the key.
        leaving: T,
        /// At the next one.
        arriving: T,
    },
}

/// A value at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key<T> {
    /// Seconds.
    pub time: f64,
    /// The value.
    pub value: T,
    /// How it goes on from there.
    pub way: Way<T>,
}

/// A value over time. Before its first key it is that of the first, and after the last that of the last.
#[derive(Debug, Clone)]
pub struct Curve<T>(Vec<Key<T>>);

impl<T: Value> Curve<T> {
    /// A curve through keys.
    ///
    /// # Errors
    /// A line if there are none, a number is not finite, or times do not increase.
    pub fn new(keys: Vec<Key<T>>) -> Result<Curve<T>, String> {
        if keys.is_empty() {
            return Err("expected at least one key".into());
        }
        for (number, key) in keys.iter().enumerate() {
            let slopes = match key.way {
                Way::Cubic { leaving, arriving } => leaving.is_finite() && arriving.is_finite(),
                Way::Step | Way::Linear => true,
            };
            if !(key.time.is_finite() && key.value.is_finite() && slopes) {
                return Err(format!("key {number} has a number that is not finite"));
            }
            if number > 0 && key.time <= keys[number - 1].time {
                return Err(format!("times must increase, and that of key {number} does not"));
            }
        }
        Ok(Curve(keys))
    }

    /// The value at a time in seconds.
    pub fn at(&self, time: f64) -> T {
        let keys = &self.0;
        let next = keys.partition_point(|key| key.time <= time);
        let Some(key) = next.checked_sub(1).map(|i| &keys[i]) else { return keys[0].value };
        let Some(after) = keys.get(next).filter(|_| time > key.time) else { return key.value };
        let length = after.time - key.time;
        let share = (time - key.time) / length;
        match key.way {
            Way::Step => key.value,
            Way::Linear => T::between(key.value, after.value, share),
            Way::Cubic { leaving, arriving } => {
                T::cubic(key.value, leaving.scaled(length), after.value, arriving.scaled(length), share)
            }
        }
    }

    /// The times of its first and last key.
    pub fn range(&self) -> (f64, f64) {
        (self.0[0].time, self.0[self.0.len() - 1].time)
    }

    /// Its keys.
    pub fn keys(&self) -> &[Key<T>] {
        &self.0
    }
}

/// Weights of both values and both slopes.
fn hermite(share: f64) -> [f64; 4] {
    let (t, t2, t3) = (share, share * share, share * share * share);
    [2.0 * t3 - 3.0 * t2 + 1.0, t3 - 2.0 * t2 + t, 3.0 * t2 - 2.0 * t3, t3 - t2]
}

impl Value for f64 {
    fn between(from: f64, to: f64, share: f64) -> f64 {
        from + (to - from) * share
    }

    fn cubic(from: f64, leaving: f64, to: f64, arriving: f64, share: f64) -> f64 {
        let [a, b, c, d] = hermite(share);
        a * from + b * leaving + c * to + d * arriving
    }

    fn scaled(self, factor: f64) -> f64 {
        self * factor
    }

    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Value for DVec3 {
    fn between(from: DVec3, to: DVec3, share: f64) -> DVec3 {
        from + (to - from) * share
    }

    fn cubic(from: DVec3, leaving: DVec3, to: DVec3, arriving: DVec3, share: f64) -> DVec3 {
        let [a, b, c, d] = hermite(share);
        a * from + b * leaving + c * to + d * arriving
    }

    fn scaled(self, factor: f64) -> DVec3 {
        self * factor
    }

    fn is_finite(self) -> bool {
        DVec3::is_finite(self)
    }
}

/// Rotations. Between two that are of unit length it goes along the shorter arc; cubics are not of unit length.
impl Value for DQuat {
    fn between(from: DQuat, to: DQuat, share: f64) -> DQuat {
        let cosine = from.dot(to);
        // The same rotation has two quaternions; the nearer one is meant.
        let (to, cosine) = if cosine < 0.0 { (-to, -cosine) } else { (to, cosine) };
        let angle = libm::acos(cosine.min(1.0));
        let sine = libm::sin(angle);
        // Where the arc is that short it is straight.
        if sine < 1e-9 {
            return from + (to - from) * share;
        }
        let (a, b) = (libm::sin((1.0 - share) * angle) / sine, libm::sin(share * angle) / sine);
        from * a + to * b
    }

    fn cubic(from: DQuat, leaving: DQuat, to: DQuat, arriving: DQuat, share: f64) -> DQuat {
        let [a, b, c, d] = hermite(share);
        from * a + leaving * b + to * c + arriving * d
    }

    fn scaled(self, factor: f64) -> DQuat {
        self * factor
    }

    fn is_finite(self) -> bool {
        DQuat::is_finite(self)
    }
}

/// A number that stays, or one that changes.
#[derive(Debug, Clone)]
pub enum Channel<T> {
    /// Always this.
    Still(T),
    /// This at each time.
    Moving(std::sync::Arc<Curve<T>>),
}

impl<T: Value> Channel<T> {
    /// The value at a time in seconds.
    pub fn at(&self, time: f64) -> T {
        match self {
            Channel::Still(value) => *value,
            Channel::Moving(curve) => curve.at(time),
        }
    }

    /// The times of its first and last key, if it has such.
    pub fn range(&self) -> Option<(f64, f64)> {
        match self {
            Channel::Still(_) => None,
            Channel::Moving(curve) => Some(curve.range()),
        }
    }
}

/// The time from the first beginning to the last end of several.
pub fn joined(ranges: impl IntoIterator<Item = Option<(f64, f64)>>) -> Option<(f64, f64)> {
    ranges.into_iter().flatten().reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn keys(ways: [Way<f64>; 3]) -> Curve<f64> {
        let key = |(i, way)| Key { time: [1.0, 2.0, 4.0][i], value: [10.0, 20.0, 0.0][i], way };
        Curve::new(ways.into_iter().enumerate().map(key).collect()).unwrap()
    }

    #[test]
    fn values_lie_between_keys_and_stay_beyond_them() {
        let curve = keys([Way::Linear, Way::Linear, Way::Linear]);
        for (time, value) in
            [(-5.0, 10.0), (1.0, 10.0), (1.25, 12.5), (2.0, 20.0), (3.0, 10.0), (4.0, 0.0), (9.0, 0.0)]
        {
            assert_eq!(curve.at(time), value, "{time}");
        }
        let curve = keys([Way::Step, Way::Linear, Way::Step]);
        for (time, value) in [(1.0, 10.0), (1.999, 10.0), (2.0, 20.0), (3.0, 10.0), (5.0, 0.0)] {
            assert_eq!(curve.at(time), value, "{time}");
        }
        assert_eq!(curve.range(), (1.0, 4.0));
    }

    #[test]
    fn a_cubic_with_the_slopes_of_a_line_is_the_line_and_without_slopes_it_rests_at_keys() {
        let slope = |leaving, arriving| Way::Cubic { leaving, arriving };
        let line = keys([slope(10.0, 10.0), slope(-10.0, -10.0), Way::Linear]);
        for (time, value) in [(1.5, 15.0), (1.75, 17.5), (3.0, 10.0), (3.5, 5.0)] {
            assert!((line.at(time) - value).abs() < 1e-12, "{time}");
        }
        let flat = keys([slope(0.0, 0.0), slope(0.0, 0.0), Way::Linear]);
        assert!((flat.at(1.5) - 15.0).abs() < 1e-12 && flat.at(1.01) - 10.0 < 0.01);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let key = |time, value| Key { time, value, way: Way::Linear };
        assert!(Curve::<f64>::new(Vec::new()).is_err());
        for keys in [
            vec![key(f64::NAN, 0.0)],
            vec![key(0.0, f64::INFINITY)],
            vec![key(0.0, 0.0), key(0.0, 1.0)],
            vec![key(1.0, 0.0), key(0.5, 1.0)],
            vec![Key { way: Way::Cubic { leaving: f64::NAN, arriving: 0.0 }, ..key(0.0, 0.0) }],
        ] {
            assert_eq!(Curve::new(keys).unwrap_err().lines().count(), 1);
        }
    }

    proptest! {
        #[test]
        fn rotations_go_the_shorter_way_at_one_speed(
            axis in prop::array::uniform3(-1.0f64..1.0),
            angle in 0.01f64..3.1,
            share in 0.0f64..1.0,
            turned: bool,
        ) {
            let Some(axis) = DVec3::from(axis).try_normalize() else { return Ok(()) };
            let start = DQuat::from_rotation_x(0.3);
            let end = DQuat::from_axis_angle(axis, angle) * start;
            let found = DQuat::between(start, if turned { -end } else { end }, share);
            let expected = DQuat::from_axis_angle(axis, angle * share) * start;
            prop_assert!((found.length() - 1.0).abs() < 1e-9);
            prop_assert!(found.dot(expected).abs() > 1.0 - 1e-9, "{found} {expected}");
            prop_assert_eq!(DQuat::between(start, end, 0.0), start);
        }
    }
}
