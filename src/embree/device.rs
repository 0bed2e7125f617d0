//! Embree's device: its threads, its version, its errors.

use std::ptr::{self, NonNull};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{call, ffi};
use crate::{Error, Result};

/// Embree, ready to build scenes. Clones are the same device, and every scene keeps its device alive.
#[derive(Debug, Clone)]
pub struct Device {
    handle: Arc<Handle>,
}

#[derive(Debug)]
struct Handle {
    device: NonNull<ffi::LbDevice>,
    info: ffi::LbDeviceInfo,
    /// Held while a scene is built or freed: the device's memory is counted in one sum, and what a scene adds to it
    /// is known only if nothing else changes it meanwhile.
    memory: Mutex<()>,
}

// SAFETY: Embree's devices may be used by several threads at once; what the shim adds to them is atomic.
unsafe impl Send for Handle {}
// SAFETY: as above.
unsafe impl Sync for Handle {}

impl Device {
    /// A device that builds its scenes with `threads` threads; 0 means as many as the machine has.
    ///
    /// Queries always run on the thread that asks. Embree keeps one pool of threads a process: the device with the
    /// most threads decides its size, and one with fewer does not shrink it.
    ///
    /// # Errors
    ///
    /// No processor or memory for it, a library that does not fit the headers it was compiled against, one that culls
    /// back faces or has no triangles, or a number of threads that Embree cannot be told.
    pub fn new(threads: usize) -> Result<Device> {
        let threads = u16::try_from(threads)
            .map_err(|_| Error::Embree(format!("{threads} threads are more than {}", u16::MAX)))?;
        let mut device = ptr::null_mut();
        // SAFETY: both pointers are valid for writes during the call.
        call(|error| unsafe { ffi::lb_device_new(threads.into(), &mut device, error) })?;
        let device = NonNull::new(device).expect("a device that was made is not null");
        let mut info = ffi::LbDeviceInfo::default();
        // SAFETY: the device was just made, and both pointers are valid for writes.
        call(|error| unsafe { ffi::lb_device_info(device.as_ptr(), &mut info, error) })?;
        Ok(Device { handle: Arc::new(Handle { device, info, memory: Mutex::new(()) }) })
    }

    /// Version of the library that is loaded: `3.13.5`.
    pub fn version(&self) -> String {
        let info = &self.handle.info;
        format!("{}.{}.{}", info.version_major, info.version_minor, info.version_patch)
    }

    /// Widest instruction set that Embree's traversal uses here: `AVX-512`, `AVX2`, `AVX`, `SSE4.2`, `SSE2` or `NEON`.
    ///
    /// Embree tells which packets have native code: 16 means AVX-512 and 8 means AVX, both as it was built and as the
    /// processor allows. Between AVX and AVX2, and between the SSEs, it takes the better one that the processor has,
    /// and so does this. Trees are built with AVX2 even where rays use AVX-512.
    pub fn instruction_set(&self) -> String {
        let info = &self.handle.info;
        let native = (info.native_packet_4 != 0, info.native_packet_8 != 0, info.native_packet_16 != 0);
        instruction_set(native).to_owned()
    }

    /// Whether rays may be asked as [`Grouping::Stream`](super::Grouping::Stream). Embree 4 has no streams.
    pub fn has_streams(&self) -> bool {
        self.handle.info.streams != 0
    }

    /// Whether [`Denormals::Flushed`](super::Denormals::Flushed) differs from
    /// [`Denormals::Kept`](super::Denormals::Kept): on x86-64.
    pub fn flushes_denormals(&self) -> bool {
        self.handle.info.flushes_denormals != 0
    }

    pub(super) fn as_ptr(&self) -> *mut ffi::LbDevice {
        self.handle.device.as_ptr()
    }

    /// Keeps other scenes of this device from being built or freed.
    pub(super) fn lock_memory(&self) -> MutexGuard<'_, ()> {
        self.handle.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Bytes that Embree holds for all scenes of this device, buffers of the caller not among them.
    pub(super) fn bytes(&self) -> Result<i64> {
        let mut bytes = 0;
        // SAFETY: the device lives as long as `self`, and both pointers are valid for writes.
        call(|error| unsafe { ffi::lb_device_bytes(self.as_ptr(), &mut bytes, error) })?;
        Ok(bytes)
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: every scene holds a clone of its device, so this is the last use of the pointer.
        let freed = call(|error| unsafe { ffi::lb_device_free(self.device.as_ptr(), error) });
        debug_assert!(freed.is_ok(), "{freed:?}");
    }
}

#[cfg(any(target_arch = "x86_64", target_arch = "x86"))]
fn instruction_set(native: (bool, bool, bool)) -> &'static str {
    match native {
        (_, _, true) => "AVX-512",
        (_, true, _) if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") => "AVX2",
        (_, true, _) => "AVX",
        (true, _, _) if is_x86_feature_detected!("sse4.2") => "SSE4.2",
        _ => "SSE2",
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "x86")))]
fn instruction_set(_native: (bool, bool, bool)) -> &'static str {
    "NEON"
}
