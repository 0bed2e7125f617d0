//! The C interface as C sees it: the header against the functions, both libraries, the example, misuse, and a million
//! queries. Each C program is compiled here, as somebody who has installed the library would.

mod answers;
mod header;
mod installed;
mod programs;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// What `make c-library` makes, of the crate in the profile of these tests: the archive is there already or is made of what is.
fn library() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = scratch("c");
        // Beside this test: DIR/release/deps/c_interface-...
        let test = std::env::current_exe().unwrap();
        let target = test.ancestors().nth(3).expect("a folder of cargo's");
        let mut options = vec!["--target-dir", target.to_str().unwrap()];
        options.extend((!cfg!(debug_assertions)).then_some("--release"));
        options.extend((!cfg!(feature = "embree")).then_some("--no-default-features"));
        options.extend(cfg!(feature = "test-scenes").then_some("--features=test-scenes"));
        let script = root().join("scripts/c_library.sh");
        let mut command = Command::new("bash");
        command.arg(script).arg(&folder).args(options).env("CARGO", env!("CARGO"));
        done(&mut command, "Debian packages bash and gcc");
        folder
    })
}

/// The root of the repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder of these tests, apart for debug and release.
fn scratch(name: &str) -> PathBuf {
    let profile = if cfg!(debug_assertions) { "debug" } else { "release" };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c-interface").join(profile).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a command that must be there and end well.
#[track_caller]
fn done(command: &mut Command, package: &str) -> Output {
    let output = command.output().unwrap_or_else(|e| {
        panic!("{}: {e}; install {package}: make packages", command.get_program().display())
    });
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let said = format!("{}{}", text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{said}", output.status);
    output
}

/// How a program is linked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Linking {
    Static,
    Shared,
}

/// What pkg-config says, asked of the library that was made here and of no other.
fn pkg_config(arguments: &[&str]) -> Vec<String> {
    let mut command = Command::new("pkg-config");
    command.args(arguments).arg("lightbuffer").env("PKG_CONFIG_PATH", library().join("lib/pkgconfig"));
    let output = done(&mut command, "Debian package pkg-config");
    String::from_utf8(output.stdout).unwrap().split_whitespace().map(String::from).collect()
}

/// Compiles a C program and links it.
#[track_caller]
fn compiled(source: &Path, linking: Linking, options: &[&str]) -> PathBuf {
    let name = format!("{}-{linking:?}", source.file_stem().unwrap().display());
    let program = scratch("programs").join(name);
    let lib = library().join("lib");
    let mut command = Command::new("cc");
    command.args(["-O1", "-g", "-Wall", "-Wextra", "-pedantic", "-Werror"]).args(options);
    command.args(pkg_config(&["--cflags"])).arg(source).arg("-o").arg(&program);
    match linking {
        // The archive by its path: with -l the linker would take the shared library beside it.
        Linking::Static => {
            let private = pkg_config(&["--libs", "--static"]);
            command.arg(lib.join("liblightbuffer.a"));
            command.args(private.iter().filter(|option| *option != "-llightbuffer"));
        }
        Linking::Shared => {
            command.args(pkg_config(&["--libs"])).arg(format!("-Wl,-rpath,{}", lib.display()));
        }
    }
    command.arg("-lpthread");
    done(&mut command, "Debian package gcc");
    program
}

/// A program under valgrind: no error, and nothing lost but what `valgrind.supp` explains.
fn under_valgrind(program: &Path) -> Command {
    let mut command = Command::new("valgrind");
    let options = [
        "--quiet",
        "--error-exitcode=99",
        "--leak-check=full",
        "--errors-for-leak-kinds=definite,indirect,possible",
    ];
    let known = root().join("tests/c_interface/valgrind.supp");
    command.args(options).arg(format!("--suppressions={}", known.display())).arg(program);
    command
}
