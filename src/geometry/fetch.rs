//! Memory that will be asked for soon.

/// Has something fetched into the nearest cache, and does not wait for it.
#[inline(always)]
pub(crate) fn fetch<T>(value: &T) {
    // SAFETY: a hint, which nothing depends on.
    #[cfg(target_arch = "x86_64")]
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}
