//! `info`: text for people, JSON for programs.

use crate::{BLOCKS, Folder, json, lightbuffer};

#[test]
fn text_tells_what_a_scene_holds() {
    let run = lightbuffer(["info", "-q", "scenes/courtyard.glb"]).done();
    for line in [
        "220 objects, 112,492 triangles",
        "convex, verified: 88 solids",
        "closed solids: 604; other parts: 0 open, 0 turned, 0 crossing themselves, 0 too large",
        "light key: point at",
        "camera view",
    ] {
        assert!(run.stdout.contains(line), "{line} is not in {}", run.stdout);
    }
    assert_eq!(run.stderr, "");
}

#[test]
fn json_holds_the_same_and_goes_where_it_is_told() {
    let folder = Folder::new();
    let path = folder.path("facts.json");
    let text = lightbuffer(["info", "-q", BLOCKS, "--json", path.to_str().unwrap()]).done().stdout;
    let printed = lightbuffer(["info", "-q", BLOCKS, "--json", "-"]).done().stdout;
    assert_eq!(std::fs::read_to_string(path).unwrap(), printed);
    let facts = json(&printed);
    assert_eq!((&facts["scene"], &facts["primitives"]), (&"blocks.obj".into(), &734.into()));
    assert!(text.contains(&format!("blocks.obj (hash {})", facts["hash"].as_str().unwrap())));
    assert!(text.contains("734 triangles"), "{text}");
}
