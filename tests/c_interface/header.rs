//! `include/lightbuffer.h` against the functions, constants and structures of `lightbuffer::c_interface`: a C file that is
//! written from the Rust side alone compiles only if the header says the same.

use crate::{root, scratch};
use lightbuffer::c_interface::*;
use std::collections::BTreeSet;
use std::ffi::c_char;
use std::mem::offset_of;
use std::path::Path;
use std::process::Command;

/// A Rust type as C writes it.
trait InC {
    fn name() -> String;

    fn pointer() -> String {
        format!("{} *", Self::name())
    }
}

macro_rules! in_c {
    ($($rust:ty => $c:literal),* $(,)?) => {
        $(impl InC for $rust {
            fn name() -> String {
                $c.into()
            }
        })*
    };
}

in_c! {
    () => "void",
    u8 => "uint8_t",
    i32 => "int32_t",
    u32 => "uint32_t",
    u64 => "uint64_t",
    f32 => "float",
    c_char => "char",
    Scene => "lightbuffer_scene",
    Tester => "lightbuffer_tester",
    Mesh => "lightbuffer_mesh",
    Light => "lightbuffer_light",
    Settings => "lightbuffer_settings",
    Ray => "lightbuffer_ray",
}

impl<T: InC> InC for *const T {
    fn name() -> String {
        format!("const {}", T::pointer())
    }
}

impl<T: InC> InC for *mut T {
    fn name() -> String {
        T::pointer()
    }
}

impl<T: InC, const N: usize> InC for [T; N] {
    fn name() -> String {
        unreachable!("C has no values of arrays")
    }

    fn pointer() -> String {
        format!("{} (*)[{N}]", T::name())
    }
}

/// A function, as C declares a pointer to it.
trait Signature {
    fn pointer(self, name: &str) -> String;
}

macro_rules! signature {
    ($($argument:ident)*) => {
        impl<R: InC, $($argument: InC),*> Signature for unsafe extern "C" fn($($argument),*) -> R {
            fn pointer(self, name: &str) -> String {
                let arguments: Vec<String> = vec![$($argument::name()),*];
                let arguments = if arguments.is_empty() { "void".into() } else { arguments.join(", ") };
                format!("{} (*{name})({arguments})", R::name())
            }
        }
    };
}

signature! {}
signature! { A }
signature! { A B }
signature! { A B C }
signature! { A B C D }
signature! { A B C D E }

macro_rules! placeholder {
    ($argument:ident) => {
        _
    };
}

/// Every function, with names for its arguments.
macro_rules! functions {
    ($($name:ident($($argument:ident),*);)*) => {
        vec![$((stringify!($name), {
            let function = $name as unsafe extern "C" fn($(placeholder!($argument)),*) -> _;
            Signature::pointer(function, concat!("check_", stringify!($name)))
        })),*]
    };
}

fn functions() -> Vec<(&'static str, String)> {
    functions! {
        lightbuffer_version();
        lightbuffer_error_text();
        lightbuffer_scene_new(meshes, mesh_count, scene);
        lightbuffer_scene_dropped_triangles(scene);
        lightbuffer_scene_free(scene);
        lightbuffer_first_hits(scene, threads, rays, count, triangles);
        lightbuffer_tester_new(scene, light, settings, tester);
        lightbuffer_occluded(tester, rays, triangles, count, answers);
        lightbuffer_occluded_at(tester, points, count, answers);
        lightbuffer_tester_bytes(tester);
        lightbuffer_tester_free(tester);
    }
}

const CONSTANTS: [(&str, i64); 15] = [
    ("OK", OK as i64),
    ("ERROR_ARGUMENT", ERROR_ARGUMENT as i64),
    ("ERROR_REFUSED", ERROR_REFUSED as i64),
    ("ERROR_INTERNAL", ERROR_INTERNAL as i64),
    ("LIGHT_POINT", LIGHT_POINT as i64),
    ("LIGHT_DIRECTIONAL", LIGHT_DIRECTIONAL as i64),
    ("ANYWHERE", ANYWHERE as i64),
    ("SURFACES", SURFACES as i64),
    ("RESOLUTION_AUTO", RESOLUTION_AUTO as i64),
    ("ALL_THREADS", ALL_THREADS as i64),
    ("NO_TRIANGLE", NO_TRIANGLE as i64),
    ("LIT", LIT as i64),
    ("OCCLUDED", OCCLUDED as i64),
    ("FACES_AWAY", FACES_AWAY as i64),
    ("NO_SURFACE", NO_SURFACE as i64),
];

/// The type of a field, as a pointer to it in C.
fn field<S, T: InC>(_: fn(&S) -> &T) -> String {
    T::pointer()
}

/// A structure with all of its fields: the pattern compiles only if none is missing.
macro_rules! structures {
    ($($structure:ident { $($field:ident),* })*) => {
        vec![$({
            let _ = |s: $structure| {
                let $structure { $($field: _),* } = s;
            };
            (<$structure as InC>::name(), size_of::<$structure>(), align_of::<$structure>(), vec![
                $((stringify!($field), offset_of!($structure, $field), field(|s: &$structure| &s.$field))),*
            ])
        }),*]
    };
}

/// The C file: everything the Rust side says, held against the header.
fn checks() -> String {
    let mut text = String::from("#include <lightbuffer.h>\n#include <stddef.h>\n");
    for (name, pointer) in functions() {
        text += &format!("extern {pointer};\n{pointer} = {name};\n");
    }
    for (name, value) in CONSTANTS {
        text += &format!("_Static_assert(LIGHTBUFFER_{name} == {value}, \"{name}\");\n");
    }
    let structures = structures! {
        Mesh { vertices, vertex_count, triangles, triangle_count }
        Light { kind, vector }
        Settings { tester, memory_limit, resolution, threads, receivers, reserved }
        Ray { origin, direction }
    };
    for (name, size, alignment, fields) in structures {
        text += &format!("_Static_assert(sizeof({name}) == {size}, \"{name}\");\n");
        text += &format!("_Static_assert(_Alignof({name}) == {alignment}, \"{name}\");\n");
        for (field, offset, pointer) in fields {
            text += &format!("_Static_assert(offsetof({name}, {field}) == {offset}, \"{name}.{field}\");\n");
            text += &format!(
                "_Static_assert(_Generic(&(({name} *)0)->{field}, {pointer}: 1, default: 0), \"{name}.{field}\");\n"
            );
        }
    }
    text
}

/// What the compiler says to the checks with a header; `None` if it has nothing to say.
fn verdict(name: &str, header: &str) -> Option<String> {
    let folder = scratch(&format!("header/{name}"));
    std::fs::write(folder.join("lightbuffer.h"), header).unwrap();
    std::fs::write(folder.join("checks.c"), checks()).unwrap();
    let mut command = Command::new("cc");
    command.args(["-std=c11", "-fsyntax-only", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]);
    let output = command.arg(&folder).arg(folder.join("checks.c")).output();
    let output = output.unwrap_or_else(|e| panic!("cc: {e}; install Debian package gcc: make packages"));
    (!output.status.success()).then(|| String::from_utf8_lossy(&output.stderr).into_owned())
}

fn header() -> String {
    std::fs::read_to_string(root().join("include/lightbuffer.h")).unwrap()
}

#[test]
fn the_header_says_what_the_functions_are() {
    assert_eq!(verdict("as-it-is", &header()), None);
}

/// Each change of one side alone is noticed.
#[test]
fn a_header_that_says_something_else_does_not_pass() {
    let changes = [
        ("const float *points, uint64_t count", "const float *points, uint32_t count"),
        ("const uint32_t *triangles, uint64_t count, uint8_t *answers", "uint64_t count, uint8_t *answers"),
        ("uint32_t threads, const lightbuffer_ray *rays", "int32_t threads, const lightbuffer_ray *rays"),
        ("uint64_t lightbuffer_tester_bytes", "uint32_t lightbuffer_tester_bytes"),
        (
            "const lightbuffer_scene *scene, const lightbuffer_light",
            "lightbuffer_scene *scene, const lightbuffer_light",
        ),
        ("void lightbuffer_scene_free", "int32_t lightbuffer_scene_free"),
        ("#define LIGHTBUFFER_OCCLUDED 1", "#define LIGHTBUFFER_OCCLUDED 2"),
        ("UINT32_C(0xFFFFFFFF)", "UINT32_C(0xFFFFFFFE)"),
        ("    float origin[3];", "    float origin[4];"),
        ("    uint32_t kind;", "    int32_t kind;"),
        ("    uint32_t resolution;", ""),
        ("    const uint32_t *triangles;\n", "    uint32_t *triangles;\n"),
    ];
    let header = header();
    for (i, (old, new)) in changes.into_iter().enumerate() {
        assert!(header.contains(old), "{old}");
        let said = verdict(&format!("changed-{i}"), &header.replacen(old, new, 1));
        assert!(said.is_some(), "nobody notices {old} -> {new}");
    }
}

/// Words of a text that begin so.
fn words<'t>(text: &'t str, beginning: &str) -> BTreeSet<&'t str> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    words.filter(|word| word.starts_with(beginning)).collect()
}

/// Nothing in the header is left out of the checks above, and the list of exported symbols is the same.
#[test]
fn every_function_and_constant_of_the_header_is_checked() {
    let header = header();
    let declared: BTreeSet<&str> = header
        .lines()
        .filter_map(|line| {
            line.strip_prefix("LIGHTBUFFER_API ")?.split('(').next()?.split([' ', '*']).next_back()
        })
        .collect();
    let known: BTreeSet<&str> = functions().iter().map(|(name, _)| *name).collect();
    assert_eq!(declared, known);
    let map = std::fs::read_to_string(root().join("scripts/lightbuffer.map")).unwrap();
    assert_eq!(words(&map, "lightbuffer_"), known);

    let defined =
        header.lines().filter_map(|line| line.strip_prefix("#define LIGHTBUFFER_")?.split(' ').next());
    let not_values = ["H", "API"];
    let defined: BTreeSet<&str> =
        defined.filter(|name| !name.starts_with("VERSION") && !not_values.contains(name)).collect();
    assert_eq!(defined, CONSTANTS.iter().map(|(name, _)| *name).collect());
}

#[test]
fn the_version_of_the_header_is_that_of_the_crate() {
    let header = header();
    let version = env!("CARGO_PKG_VERSION");
    assert!(header.contains(&format!("#define LIGHTBUFFER_VERSION \"{version}\"\n")));
    for (part, number) in ["MAJOR", "MINOR", "PATCH"].into_iter().zip(version.split('.')) {
        assert!(header.contains(&format!("#define LIGHTBUFFER_VERSION_{part} {number}\n")), "{part}");
    }
    let (major_minor, _) = version.rsplit_once('.').unwrap();
    let map = std::fs::read_to_string(root().join("scripts/lightbuffer.map")).unwrap();
    assert!(map.contains(&format!("\nLIGHTBUFFER_{major_minor} {{\n")), "{map}");
}

/// The header alone, in every dialect.
#[test]
fn the_header_is_clean_c89_and_c99_and_cpp() {
    let folder = scratch("header/dialects");
    for (language, standard) in [("c", "c89"), ("c", "c99"), ("c", "c17"), ("c++", "c++98"), ("c++", "c++20")]
    {
        let source = folder.join(format!("{standard}.{}", if language == "c" { "c" } else { "cc" }));
        let text = "#include <lightbuffer.h>\nint main(void) { return lightbuffer_version() == 0; }\n";
        std::fs::write(&source, text).unwrap();
        syntax(language, standard, &source);
    }
    syntax("c", "c99", &root().join("examples/c/occlusion.c"));
    syntax("c++", "c++11", &root().join("examples/c/occlusion.c"));
}

#[track_caller]
fn syntax(language: &str, standard: &str, source: &Path) {
    let mut command = Command::new("cc");
    command.args([
        "-x",
        language,
        &format!("-std={standard}"),
        "-fsyntax-only",
        "-Wall",
        "-Wextra",
        "-pedantic",
    ]);
    // Of C++98, which has no `long long`, the header of the system needs it.
    command.args((standard == "c++98").then_some("-Wno-long-long"));
    command.args(["-Werror", "-I"]).arg(root().join("include")).arg(source);
    crate::done(&mut command, "Debian packages gcc and g++");
}
