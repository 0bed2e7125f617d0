//! Every float filter against rational numbers, on inputs that are made to be hard.
//!
//! Two things are asked of a filter: that what it decides is true, and, where it has a bound, that its value is
//! within that bound of the exact one. The second is much more than the first: where a bound leaves out a term
//! that matters, values are soon beyond it, though it may take a billion inputs until a sign is decided wrongly.
//! That bounds cover the worst case, to which random roundings seldom come near, is what the derivations beside
//! them are for.

mod bounds;
mod cones;
mod footprints;
mod inputs;
mod numbers;
mod rational;
mod rays;
mod shadows;

use proptest::prelude::ProptestConfig;

/// Many cases, since each is cheap and what is looked for is rare.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig { cases: count, max_global_rejects: 1 << 20, ..ProptestConfig::default() }
}
