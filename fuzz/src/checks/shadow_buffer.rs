//! Saved shadow-buffers, against the one scene, light and size that they may be of.

use super::{Desk, Outcome, mend, refusal, split_first};
use glam::Vec3;
use lightbuffer::geometry::LightPosition;
use lightbuffer::scene::{ObjectInput, Scene, SceneBuilder};
use lightbuffer::shadow::shadow_buffer::{FilterWidth, Lookup, ShadowBuffer, ShadowBufferSettings};
use lightbuffer::shadow::{BuildInput, Receivers, SceneIndex};
use lightbuffer::{ShadowTester, SurfacePoint};
use std::path::Path;
use std::sync::LazyLock;

/// Where the file says what it keeps.
const KEPT_AT: usize = 12;

/// Bytes before the cells.
const HEADER: usize = 44;

/// What a file can keep: by its code, from 1.
const KINDS: [(Lookup, Receivers); 3] = [
    (Lookup::Identity, Receivers::Surfaces),
    (Lookup::Depth, Receivers::Surfaces),
    (Lookup::Identity, Receivers::Anywhere),
];

/// Two triangles, one above the other.
static SCENE: LazyLock<(Scene, SceneIndex)> = LazyLock::new(|| {
    let mut builder = SceneBuilder::new("two triangles");
    for (name, y, size) in [("floor", 0.0, 4.0), ("lid", 1.0, 1.0)] {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, z]| Vec3::new(x * size, y, z * size));
        let object = ObjectInput::new(name, corners.to_vec(), vec![[0, 1, 2]]);
        builder.add_object(object).expect("a valid triangle");
    }
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    (scene, index)
});

/// A valid file of each kind.
static VALID: LazyLock<[Vec<u8>; 3]> = LazyLock::new(|| {
    let desk = Desk::new();
    let path = desk.path("valid");
    [0, 1, 2].map(|kind| {
        let buffer = ShadowBuffer::new(&input(kind, FilterWidth::OFF)).expect("a valid scene");
        buffer.save(&path).expect("a folder");
        std::fs::read(&path).expect("what was saved")
    })
});

fn input(kind: usize, filter: FilterWidth) -> BuildInput<'static> {
    let (lookup, receivers) = KINDS[kind];
    let (scene, index) = &*SCENE;
    let settings = ShadowBufferSettings { rows: 6, columns: 9, lookup, filter, ..Default::default() };
    let light = LightPosition::At(Vec3::new(0.0, 2.0, 0.0));
    BuildInput { shadow_buffer: settings, receivers, ..BuildInput::new(scene, index, light) }
}

/// Files that load, as inputs.
pub fn valid_inputs() -> Vec<Vec<u8>> {
    VALID.iter().map(|file| [b"r", file.as_slice()].concat()).collect()
}

/// The first byte of the input says what is mended: `c` the checksum, `h` the header and the length as well, any
/// other nothing.
pub fn check(desk: &mut Desk, bytes: &[u8]) -> Outcome {
    let (how, file) = split_first(bytes);
    // What it says it keeps is what is asked for, so that every kind is loaded.
    let code = file.get(KEPT_AT).map_or(0, |&code| usize::from(code));
    let kind = if how == b'h' { code % 3 } else { code.clamp(1, 3) - 1 };
    let file = match how {
        b'c' => mend::last_checksum(file),
        b'h' => {
            let valid = &VALID[kind];
            let mut whole = valid[..HEADER].to_vec();
            whole.extend(file.get(HEADER..).unwrap_or_default());
            whole.resize(valid.len(), 0);
            mend::last_checksum(&whole)
        }
        _ => file.to_vec(),
    };
    desk.lay(&[("saved", &file)]);
    let path = desk.path("saved");
    let load = |filter| ShadowBuffer::load(&input(kind, filter), &path);
    let buffer = match load(FilterWidth::OFF) {
        Ok(buffer) => buffer,
        Err(error) => return Outcome::Refused(refusal(&path, &error)),
    };
    assert_holds(&buffer, &file, &desk.path("again"));
    ask(&buffer);
    ask(&load(FilterWidth::new(3).expect("an odd number")).expect("a filter is no part of a file"));
    Outcome::Loaded
}

/// What was loaded is what the file says, to the byte.
fn assert_holds(buffer: &ShadowBuffer, file: &[u8], again: &Path) {
    buffer.save(again).expect("room for a file");
    assert_eq!(std::fs::read(again).expect("what was saved"), file);
}

/// Whatever the cells hold, every point has an answer.
fn ask(buffer: &ShadowBuffer) {
    let (scene, _) = &*SCENE;
    // Inside of either triangle.
    let points: Vec<SurfacePoint> = (0..24)
        .map(|i| {
            let [x, z] = [i % 4, i / 4].map(|step| step as f32 * 0.1);
            SurfacePoint::on_ray(scene, Vec3::new(x - 0.15, 1.5, z - 0.7), Vec3::NEG_Y, i % 2)
        })
        .collect();
    let mut answers = vec![false; points.len()];
    buffer.occluded(&points, &mut answers).expect("points on surfaces");
}
