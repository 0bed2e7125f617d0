//! What can only be seen from below the safe interface; everything else is tested in `tests/embree.rs`.

use std::ptr;

use super::{call, ffi};
use crate::Error;
use crate::embree::{Device, EmbreeMode, EmbreeScene, SceneOptions, ShadowRay};

const OPTIONS: SceneOptions = EmbreeMode::ORACLE.scene;

/// An error that Embree itself raises must come back in Embree's words, from the call that caused it, and once.
#[test]
fn embrees_own_errors_come_back() {
    let device = Device::new(1).unwrap();
    let vertices = [0.0_f32; 13];
    let triangles = [0_u32, 1, 2];
    let misaligned = vertices.as_ptr().cast::<u8>().wrapping_add(1).cast::<f32>();
    let parts = ffi::LbParts {
        vertices: misaligned,
        vertex_count: 3,
        triangles: triangles.as_ptr(),
        triangle_count: 1,
        ..ffi::LbParts::default()
    };
    let mut scene = ptr::null_mut();
    // SAFETY: Embree refuses an address that is not a multiple of 4 before it reads anything there, and the buffer
    // would be long enough anyway.
    let made = call(|error| unsafe { ffi::lb_scene_new(device.as_ptr(), &parts, 1, 0, &mut scene, error) });
    let Err(Error::Embree(text)) = made else { panic!("{made:?}") };
    assert!(text.starts_with("invalid operation: "), "{text}");
    assert!(text.contains("4 bytes aligned"), "{text}");
    assert!(scene.is_null());

    assert!(EmbreeScene::new(&device, &[[0.0; 3]; 3], &[[0, 1, 2]], OPTIONS).is_ok());
    let ignored = device.bytes().unwrap();
    assert_eq!(ignored, 0, "a scene that failed or was dropped holds memory");
}

/// Rays grouped as the shim has no loop for are refused instead of leaving answers unwritten.
#[test]
fn unknown_groupings_are_refused() {
    let device = Device::new(1).unwrap();
    let scene = EmbreeScene::new(&device, &[[0.0; 3]; 3], &[[0, 1, 2]], OPTIONS).unwrap();
    for grouping in [0, 2, 5, 32, 255, 257, u32::MAX] {
        // SAFETY: no ray is read and no answer is written, since there are none.
        let asked = call(|error| unsafe {
            ffi::lb_scene_occluded(
                scene.as_ptr(),
                ptr::dangling(),
                0,
                grouping,
                0,
                ptr::dangling_mut(),
                error,
            )
        });
        assert!(
            matches!(asked, Err(Error::Embree(text)) if text.contains("1, 4, 8 or 16 rays")),
            "{grouping}"
        );
    }
}

#[cfg(target_arch = "x86_64")]
mod float_control {
    use std::arch::asm;

    use super::*;

    /// All exceptions masked, rounding to nearest, no sticky flag: what a Rust program starts with.
    const DEFAULT: u32 = 0x1F80;
    const FLUSH_TO_ZERO: u32 = 1 << 15;
    const DENORMALS_ARE_ZERO: u32 = 1 << 6;

    fn mxcsr() -> u32 {
        let mut value = 0_u32;
        // SAFETY: stores the register in a variable that is as wide as it.
        unsafe { asm!("stmxcsr [{}]", in(reg) &mut value, options(nostack, preserves_flags)) };
        value
    }

    /// Runs `action` with the control word `value` and returns what it left there.
    fn left_by(value: u32, action: impl FnOnce()) -> u32 {
        let saved = mxcsr();
        // SAFETY: all exceptions stay masked, and the program's own word is back before this returns.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &value, options(nostack, preserves_flags)) };
        action();
        let left = mxcsr();
        // SAFETY: as above.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &saved, options(nostack, preserves_flags)) };
        left
    }

    /// Inexact arithmetic sets a sticky bit of the word, so any query would be seen here if it were not undone.
    #[test]
    fn every_call_leaves_the_control_word() {
        // Unequal coordinates, so that building and querying round.
        let vertices: Vec<[f32; 3]> =
            (0..300).map(|i| [0.1, 0.3, 0.7].map(|k| (i as f32 * k).sin())).collect();
        let triangles: Vec<[u32; 3]> = (0..100).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let rays: Vec<ShadowRay> = (0..37)
            .map(|i| ShadowRay {
                origin: [0.1, 0.2, 3.0],
                t_near: 0.0,
                direction: [0.01 * i as f32, 0.3, -5.0],
                t_far: 1.0,
                excluded: i,
            })
            .collect();
        let words = [
            DEFAULT,
            DEFAULT | FLUSH_TO_ZERO,
            DEFAULT | DENORMALS_ARE_ZERO,
            DEFAULT | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO,
        ];
        for value in words {
            let check = |what: &str, action: &mut dyn FnMut()| {
                assert_eq!(left_by(value, action), value, "{what} with {value:#x}");
            };
            let mut device = None;
            check("a device", &mut || device = Some(Device::new(2).unwrap()));
            let device = device.unwrap();
            for mode in EmbreeMode::all() {
                let mut scene = None;
                check("a scene", &mut || {
                    scene = Some(EmbreeScene::new(&device, &vertices, &triangles, mode.scene).unwrap());
                });
                let scene = scene.unwrap();
                let mut answers = vec![false; rays.len()];
                let mut asked = Ok(());
                check(&mode.to_string(), &mut || {
                    asked = scene.occluded(&rays, mode.query, &mut answers);
                });
                // A mode that is refused leaves the word too.
                assert_eq!(asked.is_ok(), mode.expect_in(&device).is_ok(), "{mode}");
                if asked.is_ok() {
                    assert!(answers.contains(&true) && answers.contains(&false), "{mode}");
                }
                check("the end of a scene", &mut || drop(scene_of(&device)));
            }
            let mut parts = Some((scene_of(&device), device));
            check("the end of everything", &mut || drop(parts.take()));
        }
    }

    fn scene_of(device: &Device) -> EmbreeScene {
        EmbreeScene::new(device, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]], OPTIONS)
            .unwrap()
    }
}
