//! Writes the demo scenes of `scenes/`: `cargo run --example generate_scenes`.
//!
//! A test compares the files in the repository with what this writes, byte for byte. To keep that true on
//! every platform, trigonometry is `libm`'s and everything else is plain IEEE arithmetic.

mod scenes;

use std::path::Path;

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for (name, bytes) in scenes::all() {
        let path = folder.join(name);
        std::fs::write(&path, &bytes)?;
        println!("{}: {} bytes", path.display(), bytes.len());
    }
    Ok(())
}
