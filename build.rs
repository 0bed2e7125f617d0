//! Compiles the Embree shim in `ffi/` and generates its bindings, if the feature `embree` is on.
//!
//! Whatever is missing is one line on standard error that says what to install.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "embree")]
    if let Err(message) = embree::build() {
        eprintln!("error: {message}");
        std::process::exit(1);
    }
}

#[cfg(feature = "embree")]
mod embree {
    use std::env;
    use std::panic;
    use std::path::{Path, PathBuf};

    const WITHOUT: &str = "or build without Embree: --no-default-features";

    const SOURCES: [&str; 4] = ["ffi/shim.c", "ffi/queries.c", "ffi/first_hits.c", "ffi/curved.c"];

    /// What `src/embree` needs to be documented where nothing is installed: rustdoc wants types and the names in
    /// constants, and looks into no function.
    const DOCUMENTATION_ONLY: &str = "pub struct LbDevice; pub struct LbScene; pub struct LbDeviceInfo; \
                                      pub struct LbRay; pub struct LbError; pub struct LbCurved; pub const LB_NO_PRIMITIVE: u32 = u32::MAX;";

    /// Headers of one major version of Embree.
    struct Headers {
        major: u32,
        include: PathBuf,
    }

    pub fn build() -> Result<(), String> {
        for file in ["ffi/shim.h", "ffi/internal.h"].into_iter().chain(SOURCES) {
            println!("cargo::rerun-if-changed={file}");
        }
        for variable in ["EMBREE_DIR", "LIBCLANG_PATH", "DOCS_RS"] {
            println!("cargo::rerun-if-env-changed={variable}");
        }
        let bindings = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR")).join("embree.rs");
        if env::var_os("DOCS_RS").is_some() {
            return std::fs::write(&bindings, DOCUMENTATION_ONLY)
                .map_err(|e| format!("{}: {e}", bindings.display()));
        }

        let root = env::var_os("EMBREE_DIR").map(PathBuf::from);
        let headers = find_headers(root.as_deref())?;
        // An Embree that is installed later must be noticed, and so must one that is replaced.
        println!(
            "cargo::rerun-if-changed={}",
            headers.include.join(format!("embree{}", headers.major)).display()
        );
        compile_shim(&headers)?;
        generate_bindings(&bindings)?;
        if let Some(root) = root {
            let folders = ["lib", "lib64", &format!("lib/{}", multiarch())].map(|folder| root.join(folder));
            for folder in folders.iter().filter(|folder| folder.is_dir()) {
                println!("cargo::rustc-link-search=native={}", folder.display());
            }
        }
        println!("cargo::rustc-link-lib=dylib=embree{}", headers.major);
        Ok(())
    }

    /// The newest version in the first folder that has one; with `EMBREE_DIR` there is no other folder.
    fn find_headers(root: Option<&Path>) -> Result<Headers, String> {
        let folders = match root {
            Some(root) => vec![root.join("include")],
            None => vec![
                PathBuf::from("/usr/include"),
                PathBuf::from("/usr/local/include"),
                Path::new("/usr/include").join(multiarch()),
            ],
        };
        for major in [4, 3] {
            for folder in &folders {
                if folder.join(format!("embree{major}/rtcore.h")).is_file() {
                    return Ok(Headers { major, include: folder.clone() });
                }
            }
        }
        Err(match root {
            Some(root) => format!(
                "EMBREE_DIR is {}, but neither include/embree4/rtcore.h nor include/embree3/rtcore.h is in it; \
                 unset it to use the system's Embree (Debian package libembree-dev), {WITHOUT}",
                root.display()
            ),
            None => format!(
                "Embree's headers (embree4/rtcore.h or embree3/rtcore.h) are missing; \
                 install Debian package libembree-dev, set EMBREE_DIR, {WITHOUT}"
            ),
        })
    }

    /// Debian's name of the target, as in `/usr/lib/x86_64-linux-gnu`.
    fn multiarch() -> String {
        let arch = env::var("CARGO_CFG_TARGET_ARCH").expect("cargo sets CARGO_CFG_TARGET_ARCH");
        format!("{arch}-linux-gnu")
    }

    fn compile_shim(headers: &Headers) -> Result<(), String> {
        cc::Build::new()
            .files(SOURCES)
            .define("LB_EMBREE_MAJOR", headers.major.to_string().as_str())
            .flag("-isystem")
            .flag(&headers.include)
            .std("c11")
            .opt_level(2)
            .warnings(true)
            .extra_warnings(true)
            .try_compile("lightbuffer_embree_shim")
            .map_err(|e| {
                format!(
                    "the C files in ffi/ cannot be compiled: {}; install Debian package gcc, {WITHOUT}",
                    one_line(&e.to_string())
                )
            })
    }

    fn generate_bindings(to: &Path) -> Result<(), String> {
        let builder = bindgen::Builder::default()
            .header("ffi/shim.h")
            .allowlist_item("(lb|Lb|LB)_?.*")
            .derive_default(true)
            .rust_target(bindgen::RustTarget::stable(88, 0).map_err(|e| e.to_string())?);
        // bindgen panics if it finds no libclang; its own message is many lines about environment variables.
        panic::set_hook(Box::new(|_| {}));
        let generated = panic::catch_unwind(panic::AssertUnwindSafe(|| builder.generate()));
        drop(panic::take_hook());
        let advice = format!("install Debian package libclang-dev, {WITHOUT}");
        match generated {
            Ok(Ok(bindings)) => bindings.write_to_file(to).map_err(|e| format!("{}: {e}", to.display())),
            Ok(Err(e)) => {
                Err(format!("no bindings from ffi/shim.h ({}); {advice}", one_line(&e.to_string())))
            }
            Err(panic) => {
                let text = panic.downcast_ref::<String>().map_or("bindgen gave up", String::as_str);
                let first = text.lines().next().unwrap_or_default();
                let why = if first.contains("libclang") { "bindgen finds no libclang" } else { first };
                Err(format!("{why}; {advice}"))
            }
        }
    }

    fn one_line(text: &str) -> String {
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}
