//! The functions that `include/lightbuffer.h` declares, which says what each of them does.
//!
//! The unsafe half: pointers become slices and handles here and nowhere else, with every check that can be made of them,
//! and no panic passes to the caller. What is then done is safe and stands in `asking.rs` and `pool.rs`.
//!
//! What no check can find out is the caller's word, for every function alike. *The caller's word* in the comments below is
//! this: a pointer that is not null points to as many values as its count says, which nobody writes to during the call; an
//! output overlaps nothing else; a handle came from the function that makes such, and has not been freed.

mod asking;
mod pool;
mod refusal;

use crate::error::OneLine;
use crate::float_environment::standard;
use crate::geometry::LightPosition;
use crate::memory::MemoryLimit;
use crate::shadow::{Receivers, Resolution};
use asking::{Answer, Asked, Choice, MeshArrays, Model};
use pool::Pool;
use refusal::Refusal;
use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// `LIGHTBUFFER_OK`.
pub const OK: i32 = 0;
/// `LIGHTBUFFER_ERROR_ARGUMENT`.
pub const ERROR_ARGUMENT: i32 = 1;
/// `LIGHTBUFFER_ERROR_REFUSED`.
pub const ERROR_REFUSED: i32 = 2;
/// `LIGHTBUFFER_ERROR_INTERNAL`.
pub const ERROR_INTERNAL: i32 = 3;
/// `LIGHTBUFFER_LIGHT_POINT`.
pub const LIGHT_POINT: u32 = 0;
/// `LIGHTBUFFER_LIGHT_DIRECTIONAL`.
pub const LIGHT_DIRECTIONAL: u32 = 1;
/// `LIGHTBUFFER_ANYWHERE`.
pub const ANYWHERE: u32 = 0;
/// `LIGHTBUFFER_SURFACES`.
pub const SURFACES: u32 = 1;
/// `LIGHTBUFFER_RESOLUTION_AUTO`.
pub const RESOLUTION_AUTO: u32 = 0;
/// `LIGHTBUFFER_ALL_THREADS`.
pub const ALL_THREADS: u32 = 0;
/// `LIGHTBUFFER_NO_TRIANGLE`.
pub const NO_TRIANGLE: u32 = u32::MAX;
/// `LIGHTBUFFER_LIT`.
pub const LIT: u8 = 0;
/// `LIGHTBUFFER_OCCLUDED`.
pub const OCCLUDED: u8 = 1;
/// `LIGHTBUFFER_FACES_AWAY`.
pub const FACES_AWAY: u8 = 2;
/// `LIGHTBUFFER_NO_SURFACE`.
pub const NO_SURFACE: u8 = 3;

/// The version as C reads it.
const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => panic!("a version holds no zero"),
};

/// `lightbuffer_scene`.
pub struct Scene(Arc<Model>);

/// `lightbuffer_tester`.
pub struct Tester(Asked);

/// `lightbuffer_mesh`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Mesh {
    /// Three floats a vertex.
    pub vertices: *const f32,
    /// A third of the floats.
    pub vertex_count: u64,
    /// Three indices a triangle.
    pub triangles: *const u32,
    /// A third of the indices.
    pub triangle_count: u64,
}

/// `lightbuffer_light`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Light {
    /// [`LIGHT_POINT`] or [`LIGHT_DIRECTIONAL`].
    pub kind: u32,
    /// A point, or a direction towards the light.
    pub vector: [f32; 3],
}

/// `lightbuffer_settings`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// A name of the registry; null is `auto`.
    pub tester: *const c_char,
    /// In bytes; 0 is what the machine has free.
    pub memory_limit: u64,
    /// Cells along a cube face, or [`RESOLUTION_AUTO`].
    pub resolution: u32,
    /// How many, or [`ALL_THREADS`].
    pub threads: u32,
    /// [`ANYWHERE`] or [`SURFACES`].
    pub receivers: u32,
    /// 0.
    pub reserved: u32,
}

/// `lightbuffer_ray`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Not zero.
    pub direction: [f32; 3],
}

thread_local! {
    /// Why the last call of this thread failed.
    static ERROR_TEXT: RefCell<CString> = RefCell::default();
}

/// As the header says.
#[unsafe(no_mangle)]
pub extern "C" fn lightbuffer_version() -> *const c_char {
    VERSION.as_ptr()
}

/// As the header says.
#[unsafe(no_mangle)]
pub extern "C" fn lightbuffer_error_text() -> *const c_char {
    // The text stays where it is until the next call of this thread that returns a code.
    ERROR_TEXT.try_with(|text| text.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_scene_new(
    meshes: *const Mesh,
    mesh_count: u64,
    scene: *mut *mut Scene,
) -> i32 {
    guarded(|| {
        let place = output(scene, 1, "scene")?;
        // SAFETY: the caller's word.
        let meshes = unsafe { input(meshes, mesh_count, "meshes") }?;
        let arrays = |(i, mesh): (usize, &Mesh)| {
            Ok(MeshArrays {
                // SAFETY: the caller's word; three floats lie as an array of three does.
                vertices: unsafe {
                    input(mesh.vertices.cast(), mesh.vertex_count, format_args!("meshes[{i}].vertices"))
                }?,
                // SAFETY: the same of three indices.
                triangles: unsafe {
                    input(mesh.triangles.cast(), mesh.triangle_count, format_args!("meshes[{i}].triangles"))
                }?,
            })
        };
        let meshes = meshes.iter().enumerate().map(arrays).collect::<Result<Vec<_>, Refusal>>()?;
        let made = Box::into_raw(Box::new(Scene(Arc::new(Model::new(&meshes)?))));
        // SAFETY: `output` has looked at the pointer, and it points to a handle by the caller's word.
        unsafe { place.write(made) };
        Ok(())
    })
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_scene_dropped_triangles(scene: *const Scene) -> u64 {
    // SAFETY: the caller's word.
    unsafe { scene.as_ref() }.map_or(0, |scene| scene.0.dropped())
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_scene_free(scene: *mut Scene) {
    // SAFETY: the caller's word.
    unsafe { free(scene) }
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_first_hits(
    scene: *const Scene,
    threads: u32,
    rays: *const Ray,
    count: u64,
    triangles: *mut u32,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller's word.
        let (scene, rays) = unsafe { (handle(scene, "scene")?, input(rays, count, "rays")?) };
        let place = output(triangles, count, "triangles")?;
        let pool = Pool::of(threads)?;
        let found = pool.install(|| scene.0.first_hits(rays))?;
        let found: Vec<u32> = found.into_iter().map(|hit| hit.unwrap_or(NO_TRIANGLE)).collect();
        // SAFETY: `output` has looked at the pointer; one value for each ray, as many as there are by the caller's word.
        unsafe { place.copy_from_nonoverlapping(found.as_ptr(), found.len()) };
        Ok(())
    })
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_tester_new(
    scene: *const Scene,
    light: *const Light,
    settings: *const Settings,
    tester: *mut *mut Tester,
) -> i32 {
    guarded(|| {
        let place = output(tester, 1, "tester")?;
        // SAFETY: the caller's word.
        let (scene, light) = unsafe { (handle(scene, "scene")?, handle(light, "light")?) };
        // SAFETY: the caller's word; here null is allowed.
        let settings = unsafe { input(settings, u64::from(!settings.is_null()), "settings") }?;
        // SAFETY: the caller's word, which holds for the name in the settings.
        let choice = unsafe { choice(settings.first()) }?;
        let made = Asked::new(&scene.0, position(light)?, &choice)?;
        let made = Box::into_raw(Box::new(Tester(made)));
        // SAFETY: `output` has looked at the pointer, and it points to a handle by the caller's word.
        unsafe { place.write(made) };
        Ok(())
    })
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_occluded(
    tester: *const Tester,
    rays: *const Ray,
    triangles: *const u32,
    count: u64,
    answers: *mut u8,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller's word.
        let (tester, rays) = unsafe { (handle(tester, "tester")?, input(rays, count, "rays")?) };
        let triangles = match triangles.is_null() {
            true => None,
            // SAFETY: the caller's word.
            false => Some(unsafe { input(triangles, count, "triangles") }?),
        };
        let place = output(answers, count, "answers")?;
        let found = codes(tester.0.on_rays(rays, triangles)?);
        // SAFETY: `output` has looked at the pointer; one answer for each ray, as many as there are by the caller's word.
        unsafe { place.copy_from_nonoverlapping(found.as_ptr(), found.len()) };
        Ok(())
    })
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_occluded_at(
    tester: *const Tester,
    points: *const f32,
    count: u64,
    answers: *mut u8,
) -> i32 {
    guarded(|| {
        // SAFETY: the caller's word; three floats lie as an array of three does.
        let (tester, points) = unsafe { (handle(tester, "tester")?, input(points.cast(), count, "points")?) };
        let place = output(answers, count, "answers")?;
        let found = codes(tester.0.at_points(points)?);
        // SAFETY: `output` has looked at the pointer; one answer for each point, as many as there are by the caller's word.
        unsafe { place.copy_from_nonoverlapping(found.as_ptr(), found.len()) };
        Ok(())
    })
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_tester_bytes(tester: *const Tester) -> u64 {
    // SAFETY: the caller's word.
    let tester = unsafe { tester.as_ref() };
    catch_unwind(AssertUnwindSafe(|| tester.map_or(0, |tester| tester.0.bytes()))).unwrap_or(0)
}

/// As the header says.
///
/// # Safety
/// The caller's word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightbuffer_tester_free(tester: *mut Tester) {
    // SAFETY: the caller's word.
    unsafe { free(tester) }
}

/// Does what a function is for, in the floating-point environment of Rust's rules, and returns its code.
fn guarded(work: impl FnOnce() -> Result<(), Refusal>) -> i32 {
    // What a panic leaves half done are answers, which are dropped, and values that others find or make anew.
    let (code, text) = match catch_unwind(AssertUnwindSafe(|| standard(work))) {
        Ok(Ok(())) => (OK, String::new()),
        Ok(Err(Refusal::Argument(why))) => (ERROR_ARGUMENT, why),
        Ok(Err(Refusal::Refused(why))) => (ERROR_REFUSED, why),
        Err(panic) => (ERROR_INTERNAL, format!("a mistake in the library: {}", what_panicked(&*panic))),
    };
    // A line that C can read: controls, zero among them, are escaped.
    let text = CString::new(OneLine(text).to_string()).unwrap_or_default();
    // A thread that ends has no text any more, and nobody who would read it.
    let _ = ERROR_TEXT.try_with(|last| *last.borrow_mut() = text);
    code
}

fn what_panicked(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("it gave up")
}

/// What an output points to, if it may be null only where nothing is to be written.
fn output<T>(pointer: *mut T, count: u64, name: &str) -> Result<*mut T, Refusal> {
    match (pointer.is_null(), pointer.is_aligned()) {
        (true, _) if count > 0 => Err(Refusal::Argument(format!("{name} is NULL"))),
        (false, false) => {
            Err(Refusal::Argument(format!("{name} is not aligned to {} bytes", align_of::<T>())))
        }
        // Nothing is written there.
        (true, _) => Ok(std::ptr::NonNull::dangling().as_ptr()),
        (false, true) => Ok(pointer),
    }
}

/// So many values of the caller's.
///
/// # Safety
/// The caller's word.
unsafe fn input<'a, T>(
    pointer: *const T,
    count: u64,
    name: impl std::fmt::Display,
) -> Result<&'a [T], Refusal> {
    let refuse = |why: String| Err(Refusal::Argument(format!("{name} {why}")));
    let most = isize::MAX as usize / size_of::<T>();
    match usize::try_from(count) {
        Ok(0) => Ok(&[]),
        _ if pointer.is_null() => refuse("is NULL".into()),
        _ if !pointer.is_aligned() => refuse(format!("is not aligned to {} bytes", align_of::<T>())),
        Ok(count) if count <= most => {
            // SAFETY: not null, aligned, no larger than anything can be; the rest is the caller's word. Any bits make a T:
            // all are numbers and pointers.
            Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
        }
        _ => refuse(format!("cannot be {count}: no memory holds so many")),
    }
}

/// What a handle, or a pointer to one value, is of.
///
/// # Safety
/// The caller's word.
unsafe fn handle<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Refusal> {
    if pointer.is_null() {
        return Err(Refusal::Argument(format!("{name} is NULL")));
    }
    if !pointer.is_aligned() {
        return Err(Refusal::Argument(format!("{name} is not aligned to {} bytes", align_of::<T>())));
    }
    // SAFETY: not null and aligned; the rest is the caller's word.
    Ok(unsafe { &*pointer })
}

/// Frees what a handle is of.
///
/// # Safety
/// The caller's word, and that nobody uses the handle any more.
unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: it came from `Box::into_raw` and has not been freed, by the caller's word.
        let freed = catch_unwind(AssertUnwindSafe(|| drop(unsafe { Box::from_raw(handle) })));
        // There is nobody to tell.
        let _ = freed.map_err(std::mem::forget);
    }
}

/// What the settings say, or what is usual.
///
/// # Safety
/// The caller's word: the name of the tester ends with a zero.
unsafe fn choice(settings: Option<&Settings>) -> Result<Choice, Refusal> {
    let Some(given) = settings else { return Ok(Choice::default()) };
    let wrong = |what: &str, value: u32, expected: &str| {
        Err(Refusal::Argument(format!("settings.{what} is {value}; expected {expected}")))
    };
    if given.reserved != 0 {
        return wrong("reserved", given.reserved, "0");
    }
    let usual = Choice::default();
    Ok(Choice {
        tester: match given.tester.is_null() {
            true => usual.tester,
            // SAFETY: not null; the rest is the caller's word.
            false => unsafe { CStr::from_ptr(given.tester) }.to_string_lossy().into_owned(),
        },
        memory: match given.memory_limit {
            0 => usual.memory,
            bytes => MemoryLimit::bytes(bytes),
        },
        resolution: match given.resolution {
            RESOLUTION_AUTO => Resolution::Auto,
            cells @ 1..=4096 => Resolution::Cells(cells),
            other => return wrong("resolution", other, "1 to 4096, or LIGHTBUFFER_RESOLUTION_AUTO"),
        },
        threads: given.threads,
        receivers: match given.receivers {
            ANYWHERE => Receivers::Anywhere,
            SURFACES => Receivers::Surfaces,
            other => return wrong("receivers", other, "LIGHTBUFFER_ANYWHERE or LIGHTBUFFER_SURFACES"),
        },
    })
}

fn position(light: &Light) -> Result<LightPosition, Refusal> {
    let vector = light.vector.into();
    match light.kind {
        LIGHT_POINT => Ok(LightPosition::At(vector)),
        LIGHT_DIRECTIONAL => Ok(LightPosition::Towards(vector)),
        other => Err(Refusal::Argument(format!(
            "light.kind is {other}; expected LIGHTBUFFER_LIGHT_POINT or LIGHTBUFFER_LIGHT_DIRECTIONAL"
        ))),
    }
}

fn codes(answers: Vec<Answer>) -> Vec<u8> {
    let code = |answer| match answer {
        Answer::Lit => LIT,
        Answer::Occluded => OCCLUDED,
        Answer::FacesAway => FACES_AWAY,
        Answer::NoSurface => NO_SURFACE,
    };
    answers.into_iter().map(code).collect()
}
