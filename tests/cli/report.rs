//! `report`: what it takes, and what it refuses in one line. What the page shows is tested in a browser.

use crate::{BLOCKS, Folder, Run, lightbuffer, names, validate};
use std::path::Path;

fn report(folder: &Path, page: &Path) -> Run {
    lightbuffer(["report".as_ref(), folder.as_os_str(), "-o".as_ref(), page.as_os_str()])
}

#[test]
fn one_file_holds_everything_and_depends_on_nothing() {
    let folder = Folder::new();
    validate(BLOCKS, &folder.path("out/a"), &[]).done();
    validate(BLOCKS, &folder.path("out/b/c"), &["--lights", "2"]).done();
    let page = folder.path("page.html");
    let run = report(&folder.path("out"), &page).done();
    assert!(run.stdout.ends_with("of 2 validate.json, 0 bench.json, 0 reproduce.json\n"), "{}", run.stdout);
    assert_eq!(names(&folder.path("")), ["out", "page.html"]);
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.starts_with("<!doctype html>") && html.trim_end().ends_with("</html>"));
    for outside in ["http://", "https://", "src=\"/", "@import", "url("] {
        let found = html.matches(outside).count();
        let namespaces = html.matches("xmlns=\"http://www.w3.org/2000/svg\"").count();
        assert_eq!(found, if outside == "http://" { namespaces } else { 0 }, "{outside}");
    }
    assert!(html.contains("lightbuffer replay scenes/blocks.obj --size 96x54 --lights 2"));
    // The same results are the same page.
    let again = folder.path("again.html");
    report(&folder.path("out"), &again).done();
    assert_eq!(std::fs::read_to_string(&again).unwrap(), html);
}

#[test]
#[cfg(feature = "embree")]
fn hard_cases_have_a_table_and_no_maps() {
    let folder = Folder::new();
    let out = folder.path("out");
    let words = ["validate", "builtin:hard-cases", "-q", "--testers", "light-buffer,embree", "-o"];
    lightbuffer(words.map(AsRef::as_ref).into_iter().chain([out.as_os_str()])).done();
    let page = folder.path("page.html");
    report(&out, &page).done();
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("Hard cases") && html.contains("47 ") && !html.contains("class=\"viewer\""));
}

#[test]
fn what_cannot_be_shown_is_one_line_and_no_page() {
    let folder = Folder::new();
    let page = folder.path("page.html");
    let empty = folder.path("empty");
    std::fs::create_dir(&empty).unwrap();
    assert!(report(&empty, &page).refused().contains("lightbuffer validate SCENE"));
    assert!(report(&folder.path("missing"), &page).refused().contains("cannot read the folder"));
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let json = std::fs::read_to_string(folder.path("out/validate.json")).unwrap();
    for (damaged, words) in [
        (json.replace("\"width\": 96", "\"width\": 97"), "96x54 pixels, but validate.json says 97x54"),
        (json.replace("\"queries\"", "\"questions\""), "missing field `queries`"),
        (json.replace("\"name\": \"key\"", "\"name\": \"moon\""), "there is no channel shadow."),
        (json[..json.len() / 2].to_string(), "validate.json:"),
    ] {
        folder.write("out/validate.json", damaged);
        let line = report(&folder.path("out"), &page).refused();
        assert!(line.contains(words), "{words:?} is not in {line}");
    }
    folder.write("out/validate.json", &json);
    folder.write("out/image.exr", "no image");
    assert!(report(&folder.path("out"), &page).refused().contains("image.exr: "));
    assert!(!page.exists());
    // Without the image there are still tables.
    std::fs::remove_file(folder.path("out/image.exr")).unwrap();
    report(&folder.path("out"), &page).done();
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("The maps are not drawn") && html.contains("light-buffer"));
}

/// What a file says is text on the page, never a part of it.
#[test]
fn names_from_files_are_only_text() {
    let folder = Folder::new();
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let json = std::fs::read_to_string(folder.path("out/validate.json")).unwrap();
    let hostile = "</script><img src=x onerror=alert(1)>";
    folder.write("out/validate.json", json.replace("\"blocks.obj\"", &format!("\"{hostile}\"")));
    let page = folder.path("page.html");
    report(&folder.path("out"), &page).done();
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(!html.contains("<img src=x"), "a name became markup");
    assert!(html.contains("&#60;/script&#62;"));
}

impl Run {
    /// Asserts that it failed, whatever it had said of its progress, and returns the last line.
    fn refused(self) -> String {
        assert_eq!((self.code, self.stdout.as_str()), (2, ""), "{}", self.stderr);
        self.stderr.lines().last().unwrap_or_default().to_string()
    }
}
