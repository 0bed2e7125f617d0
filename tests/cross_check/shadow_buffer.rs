//! The shadow-buffer over the same queries. It is an approximation, so its errors are counted; what it may not
//! depend on is asserted.

use crate::cases;
use crate::runner::{Asked, Setting, ask};
use lightbuffer::scene::Light;
use lightbuffer::shadow::{Basis, Resolution, TesterEntry, find, testers};

const SETTING: Setting = Setting::of(Resolution::Auto);

fn shadow_buffer() -> &'static TesterEntry {
    find("shadow-buffer").expect("a tester of the registry")
}

/// The cases with those of their lights that it serves.
fn cases() -> impl Iterator<Item = cases::Case> {
    cases::all().into_iter().filter_map(|mut case| {
        case.lights.retain(|light: &Light| shadow_buffer().lights.has(light.position()));
        (!case.lights.is_empty()).then_some(case)
    })
}

#[test]
fn no_other_tester_is_measured_and_has_no_cross_check() {
    let measured = testers().filter(|entry| entry.basis == Basis::Measured);
    let others: Vec<_> =
        measured.map(|entry| entry.name).filter(|name| !name.starts_with("embree")).collect();
    assert_eq!(others, ["shadow-buffer"]);
}

/// By identity nothing shadows itself: that is most of what is wrong where an eye and all else is inside one object.
#[test]
fn it_is_mostly_right() {
    let (mut wrong, mut queries) = (0, 0);
    for case in cases() {
        let asked = Asked::of(&case);
        let truth = asked.plain_truth();
        let answers = ask(shadow_buffer(), &asked, SETTING);
        let here = answers.iter().zip(&truth).filter(|(a, t)| a != t).count();
        println!("{}: {here} wrong of {}", case.name, truth.len());
        wrong += here;
        queries += truth.len();
    }
    assert!(queries > 10_000 && wrong > 0 && wrong * 5 < queries, "{wrong} wrong of {queries}");
}

#[test]
fn its_masks_depend_neither_on_threads_nor_on_the_order_of_triangles() {
    for case in cases() {
        let asked = Asked::of(&case);
        let [one, two] = [1, 2].map(|threads| ask(shadow_buffer(), &asked, Setting { threads, ..SETTING }));
        assert_eq!(one, two, "{}", case.name);
        let turned = cases::turned(&case);
        let again = Asked::of(&turned);
        let turned = ask(shadow_buffer(), &again, SETTING);
        assert_eq!(asked.by_pixel(&one), again.by_pixel(&turned), "{}", case.name);
    }
}
