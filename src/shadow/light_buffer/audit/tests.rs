//! Buffers that are broken by hand are found to be broken, each in its own way.

use super::*;
use crate::scene::{ObjectInput, Scene, SceneBuilder};
use crate::shadow::{BuildInput, Receivers, Resolution, SceneIndex, VolumeThreshold};

/// A triangle across the z axis, `half` wide.
fn across(z: f32, half: f32) -> [Vec3; 3] {
    [(-half, -half), (half, -half), (0.0, half)].map(|(x, y)| Vec3::new(x, y, z))
}

/// An object each.
fn scene(objects: &[&[[Vec3; 3]]]) -> Scene {
    let mut builder = SceneBuilder::new("test");
    for triangles in objects {
        let corners = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let positions = triangles.iter().flatten().copied().collect();
        builder.add_object(ObjectInput::new("o", positions, corners)).unwrap();
    }
    builder.finish()
}

/// What becomes of the audit of a buffer when it has been changed.
fn audit(scene: &Scene, cells: u32, change: impl FnOnce(&mut LightBuffer<'_>)) -> Result<Audit, String> {
    let index = SceneIndex::new(scene);
    let mut buffer = LightBuffer::new(&BuildInput {
        resolution: Resolution::Cells(cells),
        receivers: Receivers::Anywhere,
        bounding_volumes: VolumeThreshold::MoreThan(1),
        ..BuildInput::new(scene, &index, Vec3::ZERO)
    })
    .unwrap();
    change(&mut buffer);
    buffer.validate()
}

/// The only side that there is.
fn lists<'b>(buffer: &'b mut LightBuffer<'_>) -> &'b mut SideLists {
    buffer.sides.iter_mut().flatten().next().expect("a side")
}

/// Three objects of one triangle behind each other, in one cell.
fn three() -> Scene {
    scene(&[&[across(2.0, 0.5)], &[across(3.0, 0.5)], &[across(4.0, 0.5)]])
}

#[test]
fn all_that_is_there_is_looked_at() {
    let found = audit(&three(), 1, |_| {}).unwrap();
    assert_eq!(found, Audit { cells: 1, records: 3, directions: 9 });
    let wide = scene(&[&[across(2.0, 1.5)]]);
    let found = audit(&wide, 2, |_| {}).unwrap();
    assert_eq!(found, Audit { cells: 4, records: 4, directions: 3 });
}

#[test]
fn headers_that_do_not_span_the_records_are_found() {
    let what = |change: fn(&mut SideLists)| audit(&three(), 1, |b| change(lists(b))).unwrap_err();
    assert!(what(|l| l.headers.push(l.headers[1])).contains("span"));
    assert!(what(|l| l.headers.truncate(1)).contains("span"));
    assert!(what(|l| l.headers[1].start = 2).contains("span"));
    assert!(what(|l| l.headers[0].start = 4).contains("ends before it begins"));
}

#[test]
fn records_that_are_unsound_are_found() {
    let what = |change: fn(&mut SideLists)| audit(&three(), 1, |b| change(lists(b))).unwrap_err();
    assert!(what(|l| l.records[2].near = f32::INFINITY).contains("without depth or caster"));
    assert!(what(|l| l.records[2].caster = 3).contains("without depth or caster"));
    assert!(what(|l| l.records.swap(0, 1)).contains("out of order"));
    assert!(what(|l| l.headers[0].full_occlusion = 3.5).contains("behind the full occlusion"));
    // One that begins exactly there is not behind it.
    let at = audit(&three(), 1, |b| lists(b).headers[0].full_occlusion = lists(b).records[2].near);
    assert!(at.is_ok());
}

#[test]
fn triangles_that_are_missing_are_found_unless_they_may_be() {
    let without_last = |full_occlusion: f32| {
        audit(&three(), 1, |b| {
            let lists = lists(b);
            lists.records.pop();
            lists.headers[1].start = 2;
            lists.headers[0].full_occlusion = full_occlusion;
        })
    };
    assert!(without_last(f32::INFINITY).unwrap_err().contains("caster 2: missing"));
    assert!(without_last(3.5).is_ok(), "cut off behind a full occlusion");
    let without_any = audit(&three(), 1, |b| {
        let lists = lists(b);
        lists.records.clear();
        lists.headers[1].start = 0;
    });
    assert!(without_any.is_ok(), "a list that was dropped");
    let without_side = audit(&three(), 1, |b| b.sides.iter_mut().for_each(|side| *side = None));
    assert!(without_side.unwrap_err().contains("caster 0: missing"));
    let behind = audit(&three(), 1, |b| lists(b).records[2].near = 4.5);
    assert!(behind.unwrap_err().contains("behind its own corner"));
}

/// One object with three triangles and another with one between them.
fn grouped() -> Scene {
    scene(&[&[across(2.0, 0.5), across(4.0, 0.5), across(5.0, 0.5)], &[across(3.0, 0.5)]])
}

#[test]
fn groups_that_are_none_are_found() {
    assert!(audit(&grouped(), 1, |_| {}).is_ok());
    let what = |change: fn(&mut Group)| {
        let changed = audit(&grouped(), 1, |b| {
            let lists = lists(b);
            let [mut group] = *lists.groups.of(0) else { panic!("one group") };
            assert_eq!(group, Group { object: 0, first: 0, end: 3 });
            change(&mut group);
            lists.groups = Default::default();
            lists.groups.push_cell([group]);
        });
        changed.unwrap_err()
    };
    assert!(what(|group| group.end = 5).contains("groups out of order"));
    assert!(what(|group| group.end = 0).contains("groups out of order"));
    // The record of another object, as the last and as the only one.
    assert!(what(|group| group.end = 4).contains("records of object 0 are no group"));
    assert!(what(|group| (group.first, group.end) = (3, 4)).contains("records of object 0 are no group"));
    assert!(what(|group| group.object = 1).contains("records of object 1 are no group"));
    let without_volume = audit(&grouped(), 1, |b| b.volumes[0] = None);
    assert!(without_volume.unwrap_err().contains("records of object 0 are no group"));
    let unsorted = audit(&grouped(), 1, |b| lists(b).records.swap(1, 2));
    assert!(unsorted.unwrap_err().contains("records of object 0 are no group"));
    // What stands behind a group is in order with its first record.
    let behind = audit(&grouped(), 1, |b| lists(b).records[3].near = 1.5);
    assert!(behind.unwrap_err().contains("records out of order"));
    let twice = audit(&grouped(), 1, |b| {
        let lists = lists(b);
        let [group] = *lists.groups.of(0) else { panic!("one group") };
        lists.groups = Default::default();
        lists.groups.push_cell([group, group]);
    });
    assert!(twice.unwrap_err().contains("groups out of order"));
}
