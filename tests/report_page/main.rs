//! The page of `lightbuffer report` in a browser: what it shows, what moves, and that it asks for nothing.
//!
//! With `SCREENSHOTS=DIR` the test leaves pictures of the page there, by day, by night, on a phone and on paper.
#![cfg(feature = "embree")]

mod browser;

use browser::Browser;
use lightbuffer::film::{ImagePlanes, read_exr};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Command;

const WIDTH: usize = 96;
const HEIGHT: usize = 54;

/// Runs the program from the root of the repository and returns what it says.
fn lightbuffer(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_lightbuffer"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Results of all commands, small, and the page of them. Embree leaves out a fifth of every segment at both ends, so
/// that there is something wrong.
fn results(folder: &Path) -> PathBuf {
    let path = |name: &str| folder.join(name).display().to_string();
    let out = path("out");
    let size = ["--size", "96x54", "-q"];
    let lights = ["--embree-epsilon", "0.2", "--light", "2,5,3", "--light", "-3,4,1"];
    let blocks = path("out/blocks");
    lightbuffer(&[&["validate", "scenes/blocks.obj", "-o", &blocks], &size[..], &lights].concat());
    let lamps = path("out/lamps");
    lightbuffer(&[&["validate", "scenes/blocks-lights.toml", "-o", &lamps], &size[..]].concat());
    let bench = path("out/bench");
    let few = ["--testers", "light-buffer,shadow-buffer,embree,embree-fast", "--repeats", "2"];
    let resolutions = ["--resolution", "16,64,auto"];
    lightbuffer(&[&["bench", "scenes/blocks.obj", "-o", &bench], &size[..], &few, &resolutions].concat());
    let growth = path("out/growth");
    lightbuffer(
        &[&["bench", "scenes/blocks.obj", "-o", &growth, "--growth", "lights"], &size[..], &few].concat(),
    );
    let paper = path("out/2004");
    let figures =
        ["--figures", "9,17", "--most-objects", "20", "--repetitions", "1", "--size", "48x36", "-q"];
    lightbuffer(&[&["reproduce", "raghuvanshi-dhande", "-o", &paper], &figures[..]].concat());
    let paper = path("out/1986");
    let tables = [
        "--environments",
        "chessboard",
        "--largest-resolution",
        "200",
        "--repetitions",
        "1",
        "--size",
        "64x60",
    ];
    lightbuffer(
        &[&["reproduce", "haines-greenberg", "-o", &paper, "-q", "--truth-samples", "50"], &tables[..]]
            .concat(),
    );
    let page = folder.join("report.html");
    let said = lightbuffer(&["report", &out, "-q", "-o", page.to_str().unwrap()]);
    assert!(said.contains("of 2 validate.json, 2 bench.json, 2 reproduce.json"), "{said}");
    page
}

fn verdicts(image: &ImagePlanes, light: &str) -> Vec<u16> {
    let channel = image.channel(&format!("shadow.{light}.verdict")).unwrap();
    channel.iter().map(|&code| code as u16).collect()
}

/// A selector within the first scene's maps.
fn maps(rest: &str) -> String {
    format!("#scene-1-maps {rest}")
}

/// Asks a pixel as a person without a pointer does.
fn ask_pixel(browser: &mut Browser, x: usize, y: usize) {
    let set = "(selector, value) => { const e = document.querySelector(selector); e.value = value; \
               e.dispatchEvent(new Event('change', { bubbles: true })); }";
    for (axis, value) in [("x", x), ("y", y)] {
        browser.ask(&format!("({set})({}, {value})", json!(maps(&format!(".ask .{axis}")))));
    }
    browser.drawn();
}

/// What is read is a copy of the canvas `c`: reading the page's own would change how the browser keeps it.
const COPY: &str = "const copy = new OffscreenCanvas(c.width, c.height).getContext('2d', { willReadFrequently: true }); \
                    copy.drawImage(c, 0, 0);";

/// The colour in the middle of a pixel of the image, as a map shows it.
fn colour(browser: &mut Browser, panel: &str, x: usize, y: usize) -> Value {
    let canvas = json!(maps(&format!("[data-panel={panel}] canvas")));
    browser.ask(&format!(
        "(() => {{ const c = document.querySelector({canvas}); const s = c.width / {WIDTH}; {COPY} \
         return [...copy.getImageData(({x} + 0.5) * s, ({y} + 0.5) * s, 1, 1).data].slice(0, 3); }})()"
    ))
}

/// A number that changes with what a canvas shows.
fn fingerprint(browser: &mut Browser, panel: &str) -> f64 {
    let canvas = json!(maps(&format!("[data-panel={panel}] canvas")));
    let sum = browser.ask(&format!(
        "(() => {{ const c = document.querySelector({canvas}); {COPY} \
         return copy.getImageData(0, 0, c.width, c.height).data.reduce((s, v) => (s * 31 + v) % 1e9, 7); }})()"
    ));
    sum.as_f64().unwrap()
}

fn show_screen(browser: &mut Browser, name: &str) {
    let Ok(folder) = std::env::var("SCREENSHOTS") else { return };
    let taken = browser.call("Page.captureScreenshot", json!({ "captureBeyondViewport": true }));
    write_base64(&Path::new(&folder).join(format!("{name}.png")), &taken);
}

fn show_paper(browser: &mut Browser) {
    let printed = browser.call("Page.printToPDF", json!({ "printBackground": false }));
    if let Ok(folder) = std::env::var("SCREENSHOTS") {
        write_base64(&Path::new(&folder).join("paper.pdf"), &printed);
    }
}

fn write_base64(path: &Path, answer: &Value) {
    use base64::Engine;
    let bytes = base64::engine::general_purpose::STANDARD.decode(answer["data"].as_str().unwrap()).unwrap();
    std::fs::write(path, bytes).unwrap();
}

/// One test, since a browser takes seconds to start.
#[test]
fn the_page_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let page = results(folder.path());
    let mut browser = Browser::start();
    browser.window(1280, 900, "light", "");
    browser.open(&page);
    assert_eq!(browser.ask("document.querySelectorAll('.viewer.ready').length"), 2);
    read_outs_are_right(&mut browser, folder.path());
    slider_and_maps_move(&mut browser);
    a_single_pixel_is_seen_at_every_zoom(&mut browser, folder.path());
    tables_sort(&mut browser);
    sizes_sort_by_bytes(&mut browser);
    plots_and_words_are_there(&mut browser);
    everything_has_a_name(&mut browser);
    looks(&mut browser);
    assert_eq!(browser.complaints(), Vec::<String>::new());
    assert_eq!(browser.files_asked_for(), 1, "the page asks for other files");
}

/// Pixels of every verdict, held against the channel of the image; and one wrong pixel against `replay`.
fn read_outs_are_right(browser: &mut Browser, folder: &Path) {
    let image = read_exr(&folder.join("out/blocks/image.exr")).unwrap();
    let document: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("out/blocks/validate.json")).unwrap())
            .unwrap();
    for (number, light) in document["lights"].as_array().unwrap().iter().enumerate() {
        let name = light["name"].as_str().unwrap();
        browser.ask(&format!(
            "(() => {{ const e = document.querySelector({}); e.value = {number}; e.dispatchEvent(new Event('change')); }})()",
            json!(maps(".light"))
        ));
        browser.drawn();
        let codes = verdicts(&image, name);
        let mut seen = std::collections::BTreeSet::new();
        for (at, &code) in codes.iter().enumerate() {
            if !seen.insert(code) {
                continue;
            }
            let (x, y) = (at % WIDTH, at / WIDTH);
            ask_pixel(browser, x, y);
            let said = browser.text(&maps(".finding"));
            let words = match (code % 10, code / 10 % 10, code / 100) {
                (0, ..) => "background",
                (1, ..) => "faces away",
                (2 | 3, 1, _) => "touching, all right",
                (2, ..) => "lit",
                (3, ..) => "occluded",
                (5, _, 1) => "embree wrong: epsilon",
                (5, _, 2) => "embree wrong: input rounding",
                (5, _, 3) => "embree wrong: traversal",
                other => panic!("{other:?} at {x},{y}"),
            };
            assert!(said.contains(&format!("{x},{y} {words}")), "{code} at {x},{y}: {said}");
            let object = image.channel("id.object").unwrap()[at];
            assert_eq!(said.contains("object"), object > 0.0, "{said}");
            assert!(object == 0.0 || said.contains(&format!("object {object}")), "{said}");
        }
        assert!(seen.contains(&105), "{name}: no pixel at which Embree is wrong by its epsilon: {seen:?}");
    }
    // The command that stands there says the same.
    let codes = verdicts(&image, document["lights"][1]["name"].as_str().unwrap());
    let at = codes.iter().position(|&code| code == 105).unwrap();
    ask_pixel(browser, at % WIDTH, at / WIDTH);
    let command = browser.text(&maps(".replay code"));
    assert!(command.starts_with("lightbuffer replay scenes/blocks.obj --size 96x54 "), "{command}");
    let words: Vec<&str> = command.split(' ').skip(1).chain(["--json", "-"]).collect();
    let replayed: Value = serde_json::from_str(&lightbuffer(&words)).unwrap();
    assert_eq!(replayed["pixel"], json!([at % WIDTH, at / WIDTH]));
    assert_eq!(replayed["cause"], "epsilon", "{command}");
    assert_ne!(replayed["testers"]["embree"], replayed["truth"]);
    let answers = browser.text(&maps(".answers"));
    assert!(answers.contains("wrong"), "{answers}");
}

/// The slider changes the shadows and says so; zoom and place are those of all maps; keys and buttons find wrong pixels.
fn slider_and_maps_move(browser: &mut Browser) {
    let slider = maps("input[type=range]");
    browser.ask(&format!("document.querySelector({}).focus()", json!(slider)));
    let set = |browser: &mut Browser, value: u32| {
        browser.ask(&format!(
            "(() => {{ const e = document.querySelector({}); e.value = {value}; e.dispatchEvent(new Event('input')); }})()",
            json!(maps("input[type=range]"))
        ));
        browser.drawn();
        let said = browser.ask(&format!(
            "document.querySelector({}).getAttribute('aria-valuetext')",
            json!(maps("input[type=range]"))
        ));
        (fingerprint(browser, "shadows"), said.as_str().unwrap().to_string())
    };
    let (native, said) = set(browser, 0);
    assert_eq!(said, "light-buffer");
    let (half, said) = set(browser, 50);
    assert_eq!(said, "embree on the left 50 %, light-buffer on the right");
    let (embree, said) = set(browser, 100);
    assert_eq!(said, "embree");
    let (truth, said) = set(browser, 200);
    assert_eq!(said, "the truth");
    assert_eq!(native, truth, "the light buffer is right, so both are one picture");
    assert!(native != embree && embree != half && half != native);
    // By a key, as a person does it.
    set(browser, 100);
    browser.press("ArrowRight");
    assert_eq!(browser.ask(&format!("document.querySelector({}).value", json!(slider))), "101");
    set(browser, 50);

    let before: Vec<f64> =
        ["picture", "difference", "verdict"].map(|panel| fingerprint(browser, panel)).into();
    browser.click(&maps(".zoom-in"));
    let zoomed: Vec<f64> =
        ["picture", "difference", "verdict"].map(|panel| fingerprint(browser, panel)).into();
    assert!(before.iter().zip(&zoomed).all(|(before, after)| before != after), "one map does not follow");
    let unlike = browser.ask(&format!(
        "(() => {{ const [one, other] = ['difference', 'verdict'].map((name) => {{ \
         const c = document.querySelector(`#scene-1-maps [data-panel=${{name}}] canvas`); {COPY} \
         return copy.getImageData(0, 0, c.width, c.height).data; }}); \
         const ground = (d, i) => d[i] === 24 && d[i + 1] === 24 && d[i + 2] === 28; \
         let n = 0; for (let i = 0; i < one.length; i += 4) n += ground(one, i) !== ground(other, i); return n; }})()"
    ));
    assert_eq!(unlike, 0, "the maps do not show one place at one zoom");
    browser.click(&maps(".fit"));
    let fitted: Vec<f64> =
        ["picture", "difference", "verdict"].map(|panel| fingerprint(browser, panel)).into();
    assert_eq!(before, fitted);

    browser.click(&maps(".next"));
    let which = browser.text(&maps(".which"));
    assert!(which.contains(" of "), "{which}");
    browser.ask(&format!("document.querySelector({}).focus()", json!(maps("[data-panel=verdict] canvas"))));
    browser.press("n");
    assert_ne!(browser.text(&maps(".which")), which);
    let finding = browser.text(&maps(".finding"));
    assert!(finding.contains("wrong"), "{finding}");
    let x = |browser: &mut Browser| {
        let x = browser.ask(&format!("document.querySelector({}).value", json!(maps(".ask .x"))));
        x.as_str().unwrap().parse::<u32>().unwrap()
    };
    let before = x(browser);
    browser.press("ArrowLeft");
    assert_eq!(x(browser) + 1, before);

    // A click asks the pixel under it.
    let place = browser.ask(&format!(
        "(() => {{ const e = document.querySelector({}); e.scrollIntoView({{block: 'center', behavior: 'instant'}}); \
         const b = e.getBoundingClientRect(); const s = b.width / {WIDTH}; return [b.x + 10.5 * s, b.y + 40.5 * s]; }})()",
        json!(maps("[data-panel=difference] canvas"))
    ));
    browser.click_at(place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    assert!(browser.text(&maps(".finding")).contains("10,40"), "{}", browser.text(&maps(".finding")));

    // A row of the table of wrong pixels leads to its pixel.
    let row = browser.ask(
        "(() => { const b = document.querySelector('.goto'); return [b.textContent, b.dataset.light]; })()",
    );
    browser.click(".goto");
    browser.wait_for(&format!(
        "document.querySelector({}).textContent.includes({})",
        json!(maps(".finding")),
        json!(format!("{} ", row[0].as_str().unwrap()))
    ));
    assert_eq!(browser.ask(&format!("document.querySelector({}).value", json!(maps(".light")))), row[1]);
}

/// A wrong pixel has its colour on the map, and on the smallest screen there is more of it than a pixel.
fn a_single_pixel_is_seen_at_every_zoom(browser: &mut Browser, folder: &Path) {
    let image = read_exr(&folder.join("out/blocks/image.exr")).unwrap();
    let light = browser.ask(&format!(
        "(() => {{ const e = document.querySelector({}); return e.options[e.selectedIndex].text; }})()",
        json!(maps(".light"))
    ));
    let codes = verdicts(&image, light.as_str().unwrap());
    let at = codes.iter().position(|&code| code == 105).unwrap();
    let sky_blue = json!([86, 180, 233]);
    let (x, y) = (at % WIDTH, at / WIDTH);
    assert_eq!(colour(browser, "verdict", x, y), sky_blue, "at {x},{y}");
    // Fewer CSS pixels than the image has: sampling alone would lose some. One wrong pixel alone, so that no ring of
    // another lies over it, and the one that is asked about elsewhere.
    let alone = "const v = viewers.get('scene-1'); v.kept ??= v.wrong;";
    browser.ask(&format!(
        "(() => {{ {alone} v.wrong = v.kept.filter((mark) => mark.at === {at}); v.pixel = {{ x: 0, y: 0 }}; }})()"
    ));
    for width in [40, 60, 77, 95, 200] {
        browser.ask(&format!("document.querySelector('#scene-1-maps .panels').style.width = '{width}px'"));
        browser.drawn();
        browser.drawn();
        let canvas = json!(maps("[data-panel=verdict] canvas"));
        let blue = browser.ask(&format!(
            "(() => {{ const c = document.querySelector({canvas}); const s = c.width / {WIDTH}; {COPY} \
             const d = copy.getImageData(Math.floor(({x} + 0.5) * s) - 2, Math.floor(({y} + 0.5) * s) - 2, 5, 5).data; \
             let n = 0; for (let i = 0; i < d.length; i += 4) n += d[i] === 86 && d[i + 1] === 180 && d[i + 2] === 233; \
             return n; }})()"
        ));
        assert!(blue.as_u64().unwrap() >= 4, "{blue} pixels of the colour on a map {width} wide");
    }
    browser.ask("(() => { const v = viewers.get('scene-1'); v.wrong = v.kept; })()");
    browser.ask("document.querySelector('#scene-1-maps .panels').style.width = ''");
    browser.drawn();
    assert_eq!((codes.len(), image.size().height as usize), (WIDTH * HEIGHT, HEIGHT));
}

/// A click on a title sorts by numbers, another one the other way round; a key does the same.
fn tables_sort(browser: &mut Browser) {
    let column = "(() => { const t = document.querySelector('#bench-1 table.sortable:has([data-sort])'); \
                  const heads = [...t.tHead.rows[0].cells]; const i = heads.findIndex((h) => h.textContent === 'ns/query'); \
                  return [...t.tBodies[0].rows].map((r) => Number(r.cells[i].dataset.sort)); })()";
    browser.ask(
        "(() => { for (const t of document.querySelectorAll('#bench-1 table.sortable')) { \
         const h = [...t.tHead.rows[0].cells].find((h) => h.textContent === 'ns/query'); \
         if (h) { h.querySelector('button').id = 'sort-here'; t.id = 'sorted'; break; } } })()",
    );
    let column = column.replace("#bench-1 table.sortable:has([data-sort])", "#sorted");
    let numbers = |browser: &mut Browser| -> Vec<f64> {
        browser.ask(&column).as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
    };
    browser.click("#sort-here");
    let rising = numbers(browser);
    assert!(rising.len() > 5 && rising.windows(2).all(|pair| pair[0] <= pair[1]), "{rising:?}");
    assert_eq!(
        browser.ask("document.querySelector('#sort-here').closest('th').getAttribute('aria-sort')"),
        "ascending"
    );
    browser.ask("document.querySelector('#sort-here').focus()");
    browser.press("Enter");
    let falling = numbers(browser);
    assert!(falling.windows(2).all(|pair| pair[0] >= pair[1]), "{falling:?}");
    assert_eq!(
        browser.ask("document.querySelector('#sort-here').closest('th').getAttribute('aria-sort')"),
        "descending"
    );
}

/// By what cells stand for, and not by their words.
fn sizes_sort_by_bytes(browser: &mut Browser) {
    let order = browser.ask(
        "(() => { const t = document.querySelector('#bench-1 table.sortable').cloneNode(true); \
         const sizes = [['10 KiB', 10240], ['9 MiB', 9437184], ['640 B', 640]]; \
         t.tBodies[0].replaceChildren(...sizes.map(([text, sort]) => { const row = document.createElement('tr'); \
         const cell = row.insertCell(); cell.textContent = text; cell.dataset.sort = sort; return row; })); \
         makeSortable(t); t.tHead.rows[0].cells[0].querySelector('button').click(); \
         return [...t.tBodies[0].rows].map((row) => row.textContent); })()",
    );
    assert_eq!(order, json!(["640 B", "10 KiB", "9 MiB"]));
}

fn plots_and_words_are_there(browser: &mut Browser) {
    let texts = |browser: &mut Browser, selector: &str| -> Vec<String> {
        let all = browser.ask(&format!(
            "[...document.querySelectorAll({})].map((e) => e.textContent.trim())",
            json!(selector)
        ));
        all.as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_string()).collect()
    };
    let titles = texts(browser, ".plot figcaption");
    for wanted in [
        "Time against error: blocks.obj",
        "Resolution: blocks.obj",
        "Time against lights",
        "Resolution: Chess",
    ] {
        assert!(titles.iter().any(|title| title.starts_with(wanted)), "{wanted} is not in {titles:?}");
    }
    let drawn = texts(browser, ".plot svg text");
    for wanted in ["Pareto front", "ns a query", "ms a frame", "Memory against R"] {
        assert!(drawn.iter().any(|text| text == wanted), "{wanted} is in no plot");
    }
    // What was not measured is said, and by which command it would be.
    let absent = texts(browser, ".absent").join(" ");
    assert!(absent.contains("Time against triangles is not drawn"), "{absent}");
    // Metrics of the picture stand beside wrong answers.
    let heads = texts(browser, "#scene-1 thead th");
    for wanted in ["MSE", "MRSE", "PSNR dB", "SSIM", "FLIP", "wrong"] {
        assert!(heads.iter().any(|head| head == wanted), "{wanted} is not in {heads:?}");
    }
    let loaded =
        browser.ask("[...document.images].every((image) => image.complete && image.naturalWidth > 0)");
    assert_eq!(loaded, true);
}

/// Every control has a name that is read out, and ids are there once.
fn everything_has_a_name(browser: &mut Browser) {
    let nameless = browser.ask(
        "[...document.querySelectorAll('button, select, input, canvas, img, table')].filter((e) => { \
         const labels = e.labels && [...e.labels].map((l) => l.textContent).join(''); \
         const caption = e.caption && e.caption.textContent; \
         const text = e.matches('button') ? e.textContent : ''; \
         return !(e.getAttribute('aria-label') || labels || caption || text || e.alt || '').trim(); }).map((e) => e.outerHTML)",
    );
    assert_eq!(nameless, json!([]));
    let twice = browser.ask(
        "(() => { const ids = [...document.querySelectorAll('[id]')].map((e) => e.id); \
         return ids.filter((id, i) => ids.indexOf(id) !== i); })()",
    );
    assert_eq!(twice, json!([]));
    assert_eq!(browser.ask("document.documentElement.lang"), "en");
}

/// By day and by night, on a phone, where nothing is wider than the screen, and on paper.
fn looks(browser: &mut Browser) {
    let ground = "getComputedStyle(document.documentElement).backgroundColor";
    show_screen(browser, "light");
    browser.window(1280, 900, "dark", "");
    assert_eq!(browser.ask(ground), "rgb(20, 22, 26)");
    show_screen(browser, "dark");
    browser.window(390, 844, "light", "");
    assert_eq!(browser.ask(ground), "rgb(252, 252, 251)");
    let wide = browser.ask("document.documentElement.scrollWidth");
    assert!(wide.as_u64().unwrap() <= 390, "{wide} pixels wide on a screen of 390");
    show_screen(browser, "phone");
    browser.window(1280, 900, "dark", "print");
    assert_eq!(browser.ask(ground), "rgb(252, 252, 251)", "paper is white");
    show_paper(browser);
    browser.window(1280, 900, "light", "");
}
