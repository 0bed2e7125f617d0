//! Whether the calling thread computes as exact signs need it.

use crate::error::{Error, Result};
use std::hint::black_box;

/// Fails in a thread whose processor takes denormal numbers for zero, as Embree advises its callers to set it.
///
/// Coordinates may be such numbers, so that nothing exact could be said there; and to Rust such a thread is outside of
/// its rules. It is looked at here without touching the control word.
///
/// # Errors
/// [`Error::Usage`].
pub fn expect_denormals() -> Result<()> {
    let read_as_zero = black_box(f32::from_bits(1)) == 0.0;
    let written_as_zero = black_box(f32::MIN_POSITIVE) * black_box(0.5) == 0.0;
    match read_as_zero || written_as_zero {
        false => Ok(()),
        true => Err(Error::Usage(
            "this thread takes denormal numbers for zero (FTZ or DAZ): no exact answer is given there".into(),
        )),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn threads_of_rust_keep_denormals() {
        super::expect_denormals().unwrap();
    }
}
