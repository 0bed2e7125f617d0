//! Which transparent surfaces light passes through on its way, and what is left of it.

use crate::scene::{PrimitiveIndex, Scene};

/// For each of a list of points the transparent primitives that its segment crosses, in ascending order; one
/// that it crosses twice is there twice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Crossings {
    /// Where the primitives of each point begin, and after the last one where they end.
    starts: Vec<usize>,
    primitives: Vec<PrimitiveIndex>,
}

impl Default for Crossings {
    fn default() -> Crossings {
        Crossings { starts: vec![0], primitives: Vec::new() }
    }
}

impl Crossings {
    /// Adds what the next point's segment crosses, in any order.
    pub fn push(&mut self, crossed: impl IntoIterator<Item = PrimitiveIndex>) {
        let first = self.primitives.len();
        self.primitives.extend(crossed);
        self.primitives[first..].sort_unstable();
        self.starts.push(self.primitives.len());
    }

    /// Adds another list of points behind this one.
    pub fn append(&mut self, other: &Crossings) {
        let first = self.primitives.len();
        self.starts.extend(other.starts[1..].iter().map(|start| first + start));
        self.primitives.extend_from_slice(&other.primitives);
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What the segment of a point crosses.
    pub fn of(&self, point: usize) -> &[PrimitiveIndex] {
        &self.primitives[self.starts[point]..self.starts[point + 1]]
    }

    /// The share of light that reaches a point, each channel in [0, 1].
    ///
    /// Factors are multiplied in the order of their size, so that it depends on the surfaces alone and not on
    /// their numbers.
    pub fn transmittance(&self, scene: &Scene, point: usize) -> [f32; 3] {
        product(self.of(point).iter().filter_map(|&p| Some(scene.material(p).transmission?.transmittance)))
    }
}

/// The product of factors, channel by channel, in ascending order.
pub(crate) fn product(factors: impl Iterator<Item = [f32; 3]>) -> [f32; 3] {
    let factors: Vec<[f32; 3]> = factors.collect();
    std::array::from_fn(|channel| {
        let mut factors: Vec<f32> = factors.iter().map(|factor| factor[channel]).collect();
        factors.sort_unstable_by(f32::total_cmp);
        factors.iter().fold(1.0, |product, &factor| product * f64::from(factor)) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_keep_what_they_cross_in_order() {
        let mut crossings = Crossings::default();
        crossings.push([7, 3, 7]);
        crossings.push([]);
        let mut more = Crossings::default();
        more.push([1]);
        crossings.append(&more);
        assert_eq!((crossings.len(), crossings.of(0), crossings.of(1)), (3, &[3, 7, 7][..], &[][..]));
        assert_eq!(crossings.of(2), [1]);
    }

    #[test]
    fn the_order_of_factors_does_not_show() {
        let factors = [[0.9, 0.1, 1.0], [0.3, 0.7, 0.2], [0.33, 0.5, 0.6]];
        let backwards = factors.iter().rev().copied();
        assert_eq!(product(factors.into_iter()), product(backwards));
        assert_eq!(product(std::iter::empty()), [1.0; 3]);
    }
}
