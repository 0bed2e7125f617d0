//! Least squares: the line or parabola nearest to measured points, and how near it is.

/// Highest power of a polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Degree {
    /// c0 + c1 x.
    Linear,
    /// c0 + c1 x + c2 x^2.
    Quadratic,
}

/// A polynomial fitted to points.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Of 1, x and, if it is quadratic, x^2.
    pub coefficients: Vec<f64>,
    /// The share of the variance of the values that it explains, from 0 to 1; 1 if they are all the same.
    pub r_squared: f64,
}

impl Fit {
    /// The polynomial with the least sum of squared differences; `None` of fewer places than it has coefficients.
    pub fn new(points: &[(f64, f64)], degree: Degree) -> Option<Fit> {
        let terms = if degree == Degree::Linear { 2 } else { 3 };
        // In units of the largest place, so that powers are of one size.
        let unit = points.iter().map(|(x, _)| x.abs()).fold(0.0, f64::max);
        let power = |x: f64, k: usize| (x / unit).powi(k as i32);
        let normal_equation = |row: usize| {
            let sum = |value: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>();
            let mut equation: Vec<f64> =
                (0..terms).map(|column| sum(&|&(x, _)| power(x, row + column))).collect();
            equation.push(sum(&|&(x, y)| power(x, row) * y));
            equation
        };
        let mut places: Vec<f64> = points.iter().map(|(x, _)| *x).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        if places.len() < terms {
            return None;
        }
        let scaled = solved((0..terms).map(normal_equation).collect())?;
        let coefficients = (0..terms).map(|k| scaled[k] / unit.powi(k as i32)).collect();
        let mut fit = Fit { coefficients, r_squared: 1.0 };
        let mean = points.iter().map(|(_, y)| y).sum::<f64>() / points.len() as f64;
        let all: f64 = points.iter().map(|(_, y)| (y - mean).powi(2)).sum();
        let rest: f64 = points.iter().map(|&(x, y)| (y - fit.at(x)).powi(2)).sum();
        if all > 0.0 {
            fit.r_squared = (1.0 - rest / all).clamp(0.0, 1.0);
        }
        Some(fit)
    }

    /// Its value at a place.
    pub fn at(&self, x: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
    }

    /// The correlation of its values with those that were measured: the root of [`r_squared`](Fit::r_squared).
    pub fn correlation(&self) -> f64 {
        self.r_squared.sqrt()
    }
}

/// The solution of linear equations, each with its right-hand side at its end, by elimination with pivots.
fn solved(mut equations: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = equations.len();
    for column in 0..n {
        let largest = |&row: &usize| equations[row][column].abs();
        let pivot = (column..n).max_by(|a, b| largest(a).total_cmp(&largest(b)))?;
        equations.swap(column, pivot);
        let pivot = equations[column].clone();
        if pivot[column] == 0.0 {
            return None;
        }
        for (_, equation) in equations.iter_mut().enumerate().filter(|(row, _)| *row != column) {
            let factor = equation[column] / pivot[column];
            for (value, pivot) in equation.iter_mut().zip(&pivot) {
                *value -= factor * pivot;
            }
        }
    }
    Some((0..n).map(|row| equations[row][n] / equations[row][row]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn points_on_a_curve_give_that_curve() {
        let line: Vec<_> = [10.0, 20.0, 500.0, 6000.0].map(|x| (x, 3.0 - 0.25 * x)).to_vec();
        let fit = Fit::new(&line, Degree::Linear).unwrap();
        assert_relative_eq!(fit.coefficients[0], 3.0, epsilon = 1e-9);
        assert_relative_eq!(fit.coefficients[1], -0.25, epsilon = 1e-12);
        assert_relative_eq!(fit.r_squared, 1.0, epsilon = 1e-12);
        let parabola: Vec<_> = (1..=10).map(f64::from).map(|x| (x * 200.0, 0.5 + x * x)).collect();
        let fit = Fit::new(&parabola, Degree::Quadratic).unwrap();
        assert_relative_eq!(fit.at(1300.0), 42.75, epsilon = 1e-9);
        assert_relative_eq!(fit.correlation(), 1.0, epsilon = 1e-12);
        assert!(Fit::new(&parabola, Degree::Linear).unwrap().r_squared < 0.97);
    }

    /// By hand: the means are 2 and 2.5, the slope is 2.5 / 2, and 3.125 of the 3.5 of variance are explained.
    #[test]
    fn what_no_line_explains_is_left_over() {
        let points = [(1.0, 1.0), (2.0, 3.0), (3.0, 3.5)];
        let fit = Fit::new(&points, Degree::Linear).unwrap();
        assert_relative_eq!(fit.coefficients[1], 1.25, epsilon = 1e-12);
        assert_relative_eq!(fit.coefficients[0], 0.0, epsilon = 1e-12);
        assert_relative_eq!(fit.r_squared, 3.125 / 3.5, epsilon = 1e-12);
    }

    #[test]
    fn too_few_places_have_no_curve() {
        assert_eq!(Fit::new(&[], Degree::Linear), None);
        assert_eq!(Fit::new(&[(1.0, 2.0), (1.0, 3.0)], Degree::Linear), None);
        assert_eq!(Fit::new(&[(1.0, 2.0), (2.0, 3.0)], Degree::Quadratic), None);
        assert_eq!(Fit::new(&[(1.0, 4.0), (2.0, 4.0)], Degree::Linear).unwrap().r_squared, 1.0);
    }
}
