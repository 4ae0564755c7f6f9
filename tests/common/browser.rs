//! A browser as a reader has it: headless Chromium through WebDriver, nothing stubbed.
#![allow(dead_code)] // Each test file uses a part of it.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Where this is set to `required`, a missing browser fails the tests instead of skipping them.
const WANTED: &str = "ETALON_BROWSER";
/// How long a page may take before a test gives up.
const PATIENCE: Duration = Duration::from_secs(60);

/// A browser with one window.
pub struct Browser {
    driver: Child,
    agent: ureq::Agent,
    session: String,
}

/// A browser, or a printed notice and `None` where there is none and none is required.
pub fn browser(switches: &[&str]) -> Option<Browser> {
    match Browser::start(switches) {
        Ok(browser) => Some(browser),
        Err(why) if std::env::var(WANTED).is_ok_and(|v| v == "required") => panic!("{WANTED}=required, but {why}"),
        Err(why) => {
            println!("SKIPPED: {why}. Install chromium and chromium-driver.");
            None
        }
    }
}

impl Browser {
    fn start(switches: &[&str]) -> Result<Self, String> {
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|e| format!("chromedriver does not start: {e}"))?;
        let out = BufReader::new(driver.stdout.take().expect("a pipe"));
        let port = out.lines().map_while(Result::ok).find_map(|l| port_of(&l));
        let config = ureq::Agent::config_builder().http_status_as_error(false).timeout_global(Some(2 * PATIENCE));
        let mut browser = Self { driver, agent: config.build().into(), session: String::new() };
        let base = format!("http://127.0.0.1:{}/session", port.ok_or("chromedriver names no port")?);
        let answer = browser.send(&base, Some(&capabilities(switches)))?;
        let id = answer["sessionId"].as_str().ok_or("no session was opened")?;
        browser.session = format!("{base}/{id}");
        Ok(browser)
    }

    /// One request; `None` asks, a body tells.
    fn send(&self, url: &str, body: Option<&Value>) -> Result<Value, String> {
        let answer = match body {
            Some(body) => self.agent.post(url).content_type("application/json").send(body.to_string()),
            None => self.agent.get(url).call(),
        };
        let mut answer = answer.map_err(|e| format!("{url}: {e}"))?;
        let text = answer.body_mut().with_config().limit(100_000_000).read_to_string().map_err(|e| e.to_string())?;
        let mut answer: Value = serde_json::from_str(&text).map_err(|e| format!("{url}: {e}"))?;
        let value = answer["value"].take();
        match value["error"].as_str() {
            Some(error) => Err(format!("{error}: {}", value["message"].as_str().unwrap_or("")).replace('\n', " ")),
            None => Ok(value),
        }
    }

    fn tell(&self, what: &str, body: Value) -> Value {
        self.send(&format!("{}/{what}", self.session), Some(&body)).unwrap_or_else(|e| panic!("{what}: {e}"))
    }

    /// Opens a file; returns when it has loaded.
    pub fn open(&self, page: &Path) {
        let page = page.canonicalize().expect("a page");
        self.tell("url", json!({ "url": format!("file://{}", page.display()) }));
    }

    /// What a function body returns in the page.
    pub fn run(&self, script: &str) -> Value {
        self.tell("execute/sync", json!({ "script": script, "args": [] }))
    }

    /// What an expression is worth in the page.
    pub fn value(&self, expression: &str) -> Value {
        self.run(&format!("return ({expression});"))
    }

    /// Waits until an expression is true.
    pub fn wait(&self, expression: &str) {
        let start = Instant::now();
        while self.value(&format!("!!({expression})")) != true {
            assert!(start.elapsed() < PATIENCE, "{expression} has not become true; {:#?}", self.logs("browser"));
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Two frames later: what a change of the page has drawn is there.
    pub fn settle(&self) {
        let script = "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done(1)));";
        self.tell("execute/async", json!({ "script": script, "args": [] }));
    }

    /// Presses the mouse at a point of the window, moves to another, lets go: a click where both are the same.
    pub fn drag(&self, from: [f64; 2], to: [f64; 2]) {
        let at = |[x, y]: [f64; 2]| json!({ "type": "pointerMove", "duration": 0, "x": x.round() as i64, "y": y.round() as i64 });
        let button = |what: &str| json!({ "type": what, "button": 0 });
        let moves = json!([at(from), button("pointerDown"), at(to), button("pointerUp")]);
        self.tell("actions", json!({ "actions": [{ "type": "pointer", "id": "mouse", "actions": moves }] }));
    }

    /// A click at a point of the window.
    pub fn click(&self, at: [f64; 2]) {
        self.drag(at, at);
    }

    /// Presses keys one after the other; special ones by their WebDriver code points.
    pub fn keys(&self, keys: &str) {
        let stroke = |c: char| {
            let c = c.to_string();
            [json!({ "type": "keyDown", "value": c }), json!({ "type": "keyUp", "value": c })]
        };
        let strokes: Vec<Value> = keys.chars().flat_map(stroke).collect();
        self.tell("actions", json!({ "actions": [{ "type": "key", "id": "keys", "actions": strokes }] }));
    }

    /// The window as PNG.
    pub fn screenshot(&self) -> Vec<u8> {
        let shot = self.send(&format!("{}/screenshot", self.session), None).expect("a screenshot");
        STANDARD.decode(shot.as_str().expect("text")).expect("base64")
    }

    /// The page as PDF.
    pub fn print(&self) -> Vec<u8> {
        STANDARD.decode(self.tell("print", json!({})).as_str().expect("text")).expect("base64")
    }

    /// Size of the window's inside, in CSS pixels.
    pub fn resize(&self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.devtools("Emulation.setDeviceMetricsOverride", size);
    }

    /// What a media query is told: `("prefers-color-scheme", "dark")`.
    pub fn prefer(&self, what: &[(&str, &str)]) {
        let features: Vec<Value> = what.iter().map(|(n, v)| json!({ "name": n, "value": v })).collect();
        self.devtools("Emulation.setEmulatedMedia", json!({ "features": features }));
    }

    fn devtools(&self, command: &str, parameters: Value) -> Value {
        self.tell("goog/cdp/execute", json!({ "cmd": command, "params": parameters }))
    }

    /// True if a dialog is open.
    pub fn asks(&self) -> bool {
        self.send(&format!("{}/alert/text", self.session), None).is_ok()
    }

    /// What was logged since the last time: `browser` (console) or `performance` (network and page events).
    pub fn logs(&self, kind: &str) -> Vec<Value> {
        self.tell("se/log", json!({ "type": kind })).as_array().cloned().unwrap_or_default()
    }

    /// Errors and warnings of the console since the last time.
    pub fn complaints(&self) -> Vec<String> {
        let bad = |l: &&Value| l["level"] == "SEVERE" || l["level"] == "WARNING";
        let text = |l: &Value| l["message"].as_str().unwrap_or("").to_string();
        self.logs("browser").iter().filter(bad).map(text).filter(|t| !is_of_the_driver(t)).collect()
    }

    /// Addresses that were asked for since the last time and lie outside of the page itself.
    pub fn requests(&self) -> Vec<String> {
        let url = |l: &Value| -> Option<String> {
            let event: Value = serde_json::from_str(l["message"].as_str()?).ok()?;
            let message = &event["message"];
            (message["method"] == "Network.requestWillBeSent")
                .then(|| message["params"]["request"]["url"].as_str().map(String::from))?
        };
        let own = |u: &String| ["file:", "data:", "blob:", "about:"].iter().any(|own| u.starts_with(own));
        self.logs("performance").iter().filter_map(url).filter(|u| !own(u)).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() {
            let _ = self.agent.delete(&self.session).call();
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

/// Chromium says this of every page that it draws without a graphics card.
fn is_of_the_driver(message: &str) -> bool {
    message.contains("GPU stall due to ReadPixels") || message.contains("software WebGL")
}

fn port_of(line: &str) -> Option<u16> {
    line.split_once("started successfully on port ")?.1.trim_end_matches('.').parse().ok()
}

/// Without a sandbox, which a container's root cannot have; WebGL in software, so that no graphics card is needed.
fn capabilities(switches: &[&str]) -> Value {
    let mut arguments = vec!["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars"];
    arguments.extend(["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb"]);
    arguments.extend(switches);
    json!({ "capabilities": { "alwaysMatch": {
        "goog:chromeOptions": { "args": arguments },
        "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        "timeouts": { "pageLoad": 40_000, "script": 40_000 },
        "unhandledPromptBehavior": "ignore"
    } } })
}
