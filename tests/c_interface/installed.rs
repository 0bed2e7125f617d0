//! The libraries as they are installed: names, versions, and nothing exported but what the header declares.

use crate::{done, library, root, scratch};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

fn said(program: &str, options: &[&str], path: &Path) -> String {
    let output = done(Command::new(program).args(options).arg(path), "Debian package binutils");
    String::from_utf8(output.stdout).unwrap()
}

fn exported_by_the_map() -> BTreeSet<String> {
    let map = std::fs::read_to_string(root().join("scripts/lightbuffer.map")).unwrap();
    let names = map.lines().filter_map(|line| line.trim().strip_suffix(';'));
    names.filter(|name| name.starts_with("lightbuffer_")).map(String::from).collect()
}

#[test]
fn the_shared_library_exports_versioned_functions_and_nothing_else() {
    let version = env!("CARGO_PKG_VERSION");
    let path = library().join(format!("lib/liblightbuffer.so.{version}"));
    let symbols = said("nm", &["-D", "--defined-only", "--with-symbol-versions"], &path);
    let node = "@@LIGHTBUFFER_0.1";
    let mut functions = BTreeSet::new();
    for line in symbols.lines() {
        let [_, kind, name] = line.split_whitespace().collect::<Vec<_>>()[..] else { panic!("{line}") };
        match kind {
            "T" => assert!(functions.insert(name.strip_suffix(node).expect(line).to_string())),
            // The node itself.
            _ => assert_eq!((kind, name), ("A", "LIGHTBUFFER_0.1"), "{line}"),
        }
    }
    assert_eq!(functions, exported_by_the_map());
}

#[test]
fn the_shared_library_has_its_soname_and_links_and_needs_what_the_program_does() {
    let lib = library().join("lib");
    let version = env!("CARGO_PKG_VERSION");
    let dynamic = said("readelf", &["-d", "-W"], &lib.join("liblightbuffer.so"));
    assert!(dynamic.contains("soname: [liblightbuffer.so.0]"), "{dynamic}");
    assert!(dynamic.contains("NODELETE"), "{dynamic}");
    assert_eq!(dynamic.contains("libembree"), cfg!(feature = "embree"), "{dynamic}");
    let link = |name: &str| lib.join(name).read_link().unwrap();
    assert_eq!(link("liblightbuffer.so"), Path::new("liblightbuffer.so.0"));
    assert_eq!(link("liblightbuffer.so.0"), Path::new(&format!("liblightbuffer.so.{version}")));
}

#[test]
fn the_archive_defines_every_function() {
    let symbols = said("nm", &["--defined-only"], &library().join("lib/liblightbuffer.a"));
    let defined: BTreeSet<&str> = symbols.lines().filter_map(|line| line.split(" T ").nth(1)).collect();
    for name in exported_by_the_map() {
        assert!(defined.contains(name.as_str()), "{name}");
    }
}

/// `make install-c` puts the same files below DESTDIR, and lightbuffer.pc says where they will be.
#[test]
fn it_is_installed_below_a_prefix() {
    let staging = scratch("staging");
    let script = root().join("scripts/install_c.sh");
    let mut install = Command::new("bash");
    install
        .arg(script)
        .arg(library())
        .env("PREFIX", "/opt/light")
        .env("LIBDIR", "lib/some-linux")
        .env("DESTDIR", &staging);
    done(&mut install, "Debian package bash");
    let version = env!("CARGO_PKG_VERSION");
    let lib = staging.join("opt/light/lib/some-linux");
    for file in
        ["liblightbuffer.a".into(), format!("liblightbuffer.so.{version}"), "pkgconfig/lightbuffer.pc".into()]
    {
        assert!(lib.join(&file).is_file(), "{file}");
    }
    assert!(staging.join("opt/light/include/lightbuffer.h").is_file());
    assert_eq!(
        lib.join("liblightbuffer.so.0").read_link().unwrap(),
        Path::new(&format!("liblightbuffer.so.{version}"))
    );
    let ask = |what: &str| {
        let mut command = Command::new("pkg-config");
        command.arg(what).arg("lightbuffer").env("PKG_CONFIG_PATH", lib.join("pkgconfig"));
        String::from_utf8(done(&mut command, "Debian package pkg-config").stdout).unwrap()
    };
    assert_eq!(ask("--cflags").trim(), "-I/opt/light/include");
    assert_eq!(ask("--libs").trim(), "-L/opt/light/lib/some-linux -llightbuffer");
    assert_eq!(ask("--modversion").trim(), version);
}
