//! `docs/SCENE-FORMAT.md`: its examples are read, and it names every key.

use crate::fixtures::Folder;
use crate::gltf_parts::png;
use lightbuffer::scene::formats;
use std::path::Path;

/// The tables that may be there any number of times.
const TABLES: [&str; 12] = [
    "include",
    "material",
    "mesh",
    "sphere",
    "ellipsoid",
    "cylinder",
    "cone",
    "disc",
    "plane",
    "quadric",
    "light",
    "camera",
];

fn source(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

fn page() -> String {
    source("docs/SCENE-FORMAT.md")
}

/// The text of each fenced block.
fn examples(page: &str) -> Vec<&str> {
    page.split("```toml\n").skip(1).map(|rest| rest.split_once("```").unwrap().0).collect()
}

#[test]
fn the_whole_file_is_read() {
    let page = page();
    let folder = Folder::new();
    folder
        .write("tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    folder.write("lights.toml", "version = 1\n[[light]]\ntype = 'point'\nposition = [0, 1, 0]\n");
    folder.write("wood.png", png(2, &[255; 4]));
    let whole = examples(&page).last().copied().unwrap();
    let scene = formats::load(&folder.write("whole.toml", whole)).unwrap();
    assert_eq!(scene.name, "everything");
    assert_eq!((scene.triangles.len(), scene.curved.len(), scene.cameras.len()), (8, 8, 2));
    assert_eq!((scene.objects.len(), scene.textures.len(), scene.background), (10, 3, [0.1, 0.2, 0.4]));
    let names: Vec<_> = scene.lights.iter().map(|light| light.name.as_str()).collect();
    assert_eq!(names, ["lamp", "spot", "torch", "sun", "moon", "light-1"]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn the_short_examples_are_read_together() {
    let page = page();
    let folder = Folder::new();
    folder.write("things/vase.glb", crate::fixtures::triangle_glb());
    folder.write("things/wood.png", png(2, &[255; 4]));
    let all = examples(&page);
    // `transform` belongs to a table: here to the mesh that follows it.
    let short: String =
        all[..all.len() - 1].iter().filter(|text| !text.starts_with("transform")).copied().collect();
    let transform = all.iter().find(|text| text.starts_with("transform")).unwrap();
    let text = short.replace("[[mesh]]\n", &format!("[[mesh]]\n{transform}"));
    let scene = formats::load(&folder.write("short.toml", text)).unwrap();
    assert_eq!((scene.triangles.len(), scene.lights.len(), scene.cameras.len()), (3, 1, 1));
    assert_eq!((scene.curved.len(), scene.objects.len(), scene.textures.len()), (5, 6, 2));
}

#[test]
fn every_key_stands_on_the_page_and_in_the_whole_file() {
    let page = page();
    let whole = examples(&page).last().copied().unwrap().to_owned();
    let schema = source("src/scene/formats/toml/schema.rs");
    let mut renamed = None;
    let mut keys = 0;
    for line in schema.lines().map(str::trim) {
        if let Some((_, name)) = line.split_once("rename = \"") {
            renamed = Some(name.split_once('"').unwrap().0.to_owned());
        }
        let Some((field, _)) = line.strip_prefix("pub(super) ").and_then(|rest| rest.split_once(':')) else {
            continue;
        };
        let key = renamed.take().unwrap_or_else(|| field.to_owned());
        let is_table = TABLES.contains(&key.as_str());
        let (on_page, in_file) = match is_table {
            // `material` is a table, and a key of meshes and includes.
            true => (format!("`[[{key}]]`"), format!("[[{key}]]")),
            false => (format!("{key}` |"), format!("{key} =")),
        };
        assert!(page.contains(&on_page), "{key} is not explained");
        assert!(whole.contains(&in_file), "{key} is not in the whole file");
        keys += 1;
    }
    assert!(keys > 90, "{keys}");
}
