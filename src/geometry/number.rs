//! What a formula needs of the numbers it is computed with.
//!
//! The predicates of curved surfaces are written once and computed with [`Bounded`](super::bounded::Bounded)
//! floats first. Where those leave a sign open they are computed again with exact
//! [`Surd`](super::surd::Surd) numbers.

use super::Sign;

/// A number of a commutative ring whose sign may be known.
pub(crate) trait Number: Clone {
    /// A float, exactly.
    fn exactly(value: f32) -> Self;

    /// The sum.
    fn plus(&self, other: &Self) -> Self;

    /// The difference.
    fn minus(&self, other: &Self) -> Self;

    /// The product.
    fn times(&self, other: &Self) -> Self;

    /// The exact sign, unless rounding leaves it open.
    fn sign(&self) -> Option<Sign>;

    /// Zero minus the number.
    fn negated(&self) -> Self {
        Self::exactly(0.0).minus(self)
    }

    /// The square.
    fn squared(&self) -> Self {
        self.times(self)
    }
}

/// A vector of numbers.
pub(crate) type Vector<N> = [N; 3];

/// A vector of floats, exactly.
pub(crate) fn vector<N: Number>(v: glam::Vec3) -> Vector<N> {
    v.to_array().map(N::exactly)
}

/// a - b.
pub(crate) fn minus<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    std::array::from_fn(|i| a[i].minus(&b[i]))
}

/// The vector times a number.
pub(crate) fn scaled<N: Number>(v: &Vector<N>, by: &N) -> Vector<N> {
    v.each_ref().map(|x| x.times(by))
}

/// The scalar product.
pub(crate) fn dot<N: Number>(a: &Vector<N>, b: &Vector<N>) -> N {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

/// The vector product.
pub(crate) fn cross<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    let minor = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}
