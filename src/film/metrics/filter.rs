//! Separable filters over planes.

use rayon::prelude::*;

/// Weights of a filter along an axis; the middle one is that of the sample itself.
#[derive(Debug, Clone)]
pub(super) struct Kernel(Vec<f32>);

impl Kernel {
    /// From a function of the distance in samples, not normalised.
    pub(super) fn of(radius: usize, weight: impl Fn(f64) -> f64) -> Kernel {
        let distance = |i: usize| i as f64 - radius as f64;
        Kernel((0..=2 * radius).map(|i| weight(distance(i)) as f32).collect())
    }

    /// Weights that sum up to 1.
    pub(super) fn normalised(self) -> Kernel {
        let sum: f32 = self.0.iter().sum();
        Kernel(self.0.into_iter().map(|weight| weight / sum).collect())
    }

    /// Positive weights that sum up to 1, and negative ones that do to -1.
    pub(super) fn balanced(self) -> Kernel {
        let sum = |sign: f32| self.0.iter().filter(|&&weight| weight * sign > 0.0).sum::<f32>() * sign;
        let (up, down) = (sum(1.0), sum(-1.0));
        let scaled = |&weight: &f32| if weight > 0.0 { weight / up } else { weight / down };
        Kernel(self.0.iter().map(scaled).collect())
    }

    fn radius(&self) -> usize {
        self.0.len() / 2
    }

    /// Along rows. What lies outside is what is nearest to it.
    pub(super) fn along_rows(&self, plane: &[f32], width: usize) -> Vec<f32> {
        let mut out = vec![0.0; plane.len()];
        let radius = self.radius();
        out.par_chunks_mut(width).zip(plane.par_chunks(width)).for_each_init(
            Vec::new,
            |padded: &mut Vec<f32>, (out, row)| {
                padded.clear();
                padded.extend(std::iter::repeat_n(row[0], radius));
                padded.extend(row);
                padded.extend(std::iter::repeat_n(row[width - 1], radius));
                for (x, out) in out.iter_mut().enumerate() {
                    *out = self.0.iter().zip(&padded[x..]).map(|(weight, sample)| weight * sample).sum();
                }
            },
        );
        out
    }

    /// Along columns, in the same way.
    pub(super) fn along_columns(&self, plane: &[f32], width: usize) -> Vec<f32> {
        let height = plane.len() / width;
        let radius = self.radius();
        let mut out = vec![0.0; plane.len()];
        out.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            for (i, weight) in self.0.iter().enumerate() {
                let row = (y + i).saturating_sub(radius).min(height - 1);
                for (out, sample) in out.iter_mut().zip(&plane[row * width..]) {
                    *out += weight * sample;
                }
            }
        });
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_of_sum_one_leaves_what_is_even_and_spreads_a_point() {
        let kernel = Kernel::of(2, |x| 3.0 - x.abs()).normalised();
        let even = vec![0.5; 12];
        for out in [kernel.along_rows(&even, 4), kernel.along_columns(&even, 4)] {
            assert!(out.iter().all(|v| (v - 0.5).abs() < 1e-6), "{out:?}");
        }
        let mut point = vec![0.0; 49];
        point[24] = 9.0;
        let spread = kernel.along_columns(&kernel.along_rows(&point, 7), 7);
        assert!((spread[24] - 1.0).abs() < 1e-6 && (spread[25] - 2.0 / 3.0).abs() < 1e-6, "{spread:?}");
        assert!((spread.iter().sum::<f32>() - 9.0).abs() < 1e-5);
    }

    #[test]
    fn a_balanced_kernel_sees_nothing_where_all_is_even() {
        let kernel = Kernel::of(3, |x| -x * (-x * x).exp()).balanced();
        assert!(kernel.along_rows(&[0.7; 9], 9).iter().all(|v| v.abs() < 1e-6));
        let positive: f32 = kernel.0.iter().filter(|&&w| w > 0.0).sum();
        assert!((positive - 1.0).abs() < 1e-6);
    }
}
