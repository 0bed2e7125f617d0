//! Chromium without a window, spoken to by its DevTools protocol over a socket: a few calls are all that the tests need.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tungstenite::{Message, WebSocket};

/// A loaded machine takes its time.
const PATIENCE: Duration = Duration::from_secs(240);

/// The flags of a browser that talks to nobody but us.
const FLAGS: [&str; 11] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--force-color-profile=srgb",
    "--remote-debugging-port=0",
];

/// A browser with one page; it ends with the test.
pub struct Browser {
    process: Child,
    socket: WebSocket<TcpStream>,
    session: Option<String>,
    calls: u64,
    events: Vec<Value>,
    _profile: tempfile::TempDir,
}

impl Browser {
    pub fn start() -> Browser {
        let profile = tempfile::tempdir().unwrap();
        let mut process = Command::new("chromium")
            .args(FLAGS)
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("chromium of the Debian package chromium: run `make packages`");
        let mut lines = BufReader::new(process.stderr.take().unwrap()).lines();
        let mut said = String::new();
        let address = loop {
            let Some(Ok(line)) = lines.next() else { panic!("chromium does not start: {said}") };
            if let Some(address) = line.strip_prefix("DevTools listening on ") {
                break address.to_string();
            }
            said += &line;
            said.push('\n');
        };
        // What it says later is nobody's business, but must go somewhere.
        std::thread::spawn(move || lines.for_each(drop));
        let host = address.trim_start_matches("ws://").split('/').next().unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(&address, stream).expect("a browser that talks");
        let mut browser =
            Browser { process, socket, session: None, calls: 0, events: Vec::new(), _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attached =
            browser.call("Target.attachToTarget", json!({ "targetId": target["targetId"], "flatten": true }));
        browser.session = Some(attached["sessionId"].as_str().unwrap().into());
        for domain in ["Runtime", "Log", "Network", "Page"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser
    }

    /// Calls a method and waits for its result; events that come before it are kept.
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.calls += 1;
        let mut message = json!({ "id": self.calls, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = session.as_str().into();
        }
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let answer = self.socket.read().expect("an answer in time");
            let Ok(text) = answer.to_text() else { continue };
            let answer: Value = serde_json::from_str(text).unwrap();
            if answer["id"] != self.calls {
                self.events.push(answer);
                continue;
            }
            assert!(answer.get("error").is_none(), "{method}: {}", answer["error"]);
            return answer["result"].clone();
        }
    }

    /// The value of an expression of JavaScript; promises are waited for.
    #[track_caller]
    pub fn ask(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let answer = self.call("Runtime.evaluate", parameters);
        let failed = answer.get("exceptionDetails");
        assert!(failed.is_none(), "{expression}: {failed:?}");
        answer["result"]["value"].clone()
    }

    /// The text of an element.
    #[track_caller]
    pub fn text(&mut self, selector: &str) -> String {
        let found = self.ask(&format!("document.querySelector({}).textContent", json!(selector)));
        found.as_str().unwrap_or_else(|| panic!("no text in {selector}")).to_string()
    }

    /// Opens a page from the disk and waits until its scripts are through.
    pub fn open(&mut self, page: &Path) {
        self.call("Page.navigate", json!({ "url": format!("file://{}", page.display()) }));
        self.wait_for("document.documentElement?.dataset.ready === 'true'");
    }

    /// Waits until an expression is true.
    #[track_caller]
    pub fn wait_for(&mut self, expression: &str) {
        let begin = Instant::now();
        while self.ask(expression) != true {
            assert!(begin.elapsed() < PATIENCE, "{expression} does not become true");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Waits until what was asked for has been drawn.
    pub fn drawn(&mut self) {
        self.ask(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))",
        );
    }

    /// A real click in the middle of an element.
    pub fn click(&mut self, selector: &str) {
        let place = format!(
            "(() => {{ const e = document.querySelector({}); e.scrollIntoView({{block: 'center', behavior: 'instant'}}); \
             const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }})()",
            json!(selector)
        );
        let place = self.ask(&place);
        self.click_at(place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    }

    /// A real click, in CSS pixels of the window.
    pub fn click_at(&mut self, x: f64, y: f64) {
        for kind in ["mouseMoved", "mousePressed", "mouseReleased"] {
            let button = if kind == "mouseMoved" { "none" } else { "left" };
            let count = u32::from(kind != "mouseMoved");
            let event = json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": count });
            self.call("Input.dispatchMouseEvent", event);
        }
        self.drawn();
    }

    /// A real key, by its name.
    pub fn press(&mut self, key: &str) {
        let mut event = json!({ "type": "keyDown", "key": key, "code": key });
        if key.len() == 1 {
            event["text"] = key.into();
        }
        if let Some(number) = [("ArrowLeft", 37), ("ArrowRight", 39), ("Enter", 13)]
            .into_iter()
            .find_map(|(name, number)| (name == key).then_some(number))
        {
            event["windowsVirtualKeyCode"] = number.into();
        }
        if key == "Enter" {
            event["text"] = "\r".into();
        }
        self.call("Input.dispatchKeyEvent", event.clone());
        event["type"] = "keyUp".into();
        self.call("Input.dispatchKeyEvent", event);
        self.drawn();
    }

    /// The window and what it stands for.
    pub fn window(&mut self, width: u32, height: u32, scheme: &str, media: &str) {
        let device =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600 });
        self.call("Emulation.setDeviceMetricsOverride", device);
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "media": media, "features": features }));
        self.drawn();
    }

    /// Errors and warnings of the console, exceptions, and requests for anything but the page and what is in it.
    pub fn complaints(&mut self) -> Vec<String> {
        self.ask("1");
        let said = |event: &Value| {
            let parameters = &event["params"];
            let url = parameters["request"]["url"].as_str().unwrap_or_default();
            let inside = ["file:", "data:", "blob:", "about:"].iter().any(|scheme| url.starts_with(scheme));
            match event["method"].as_str().unwrap_or_default() {
                "Runtime.exceptionThrown" | "Log.entryAdded" => true,
                "Runtime.consoleAPICalled" => parameters["type"] != "log",
                "Network.requestWillBeSent" => !inside,
                "Network.webSocketCreated" => true,
                _ => false,
            }
        };
        self.events.iter().filter(|event| said(event)).map(Value::to_string).collect()
    }

    /// How many requests there were for files.
    pub fn files_asked_for(&self) -> usize {
        let is_file = |event: &&Value| {
            event["method"] == "Network.requestWillBeSent"
                && event["params"]["request"]["url"].as_str().unwrap_or_default().starts_with("file:")
        };
        self.events.iter().filter(is_file).count()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The profile is removed after this, when nobody writes into it any more.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
