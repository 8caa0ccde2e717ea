//! A desktop without a monitor, and the program's window on it, as a user has them: keys, clicks, and what is to be seen.

// Tests and examples use different parts of it.
#![allow(dead_code)]

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Longest wait for anything: a machine may be busy, and shaders are compiled first.
const PATIENCE: Duration = Duration::from_secs(120);

/// An X server that draws into a file.
pub struct Desktop {
    server: Child,
    manager: Option<Child>,
    display: String,
    folder: TempDir,
}

impl Desktop {
    /// Starts a server on a free display.
    pub fn start() -> Self {
        Self::of_size([800, 600])
    }

    /// The same with a screen of so many pixels.
    pub fn of_size([width, height]: [u32; 2]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut command = Command::new("Xvfb");
        let screen = format!("{width}x{height}x24");
        command.args(["-noreset", "-displayfd", "1", "-screen", "0", &screen, "-fbdir"]).arg(folder.path());
        let server = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut server = server.unwrap_or_else(|error| panic!("Xvfb: {error}; apt-get install xvfb xdotool"));
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        Self { server, manager: None, display: format!(":{}", number.trim()), folder }
    }

    /// The same with a window manager, which full screens and minimised windows need: one that is at work, since a first
    /// start, which reads all fonts, may take longer than a window does, and one that comes late takes the keys away.
    pub fn managed() -> Self {
        let mut desktop = Self::start();
        let mut command = Command::new("openbox");
        let manager = command.env("DISPLAY", &desktop.display).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        desktop.manager = Some(manager.unwrap_or_else(|error| panic!("openbox: {error}; apt-get install openbox")));
        until("a window manager", || desktop.is_managed().then_some(()));
        desktop
    }

    /// Whether a window manager answers.
    fn is_managed(&self) -> bool {
        let mut command = Command::new("xdotool");
        command.env("DISPLAY", &self.display).arg("get_num_desktops").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    }

    /// What is to be seen at a place of the screen: red, green, blue.
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        self.screen().pixel(x, y)
    }

    /// All that is to be seen.
    pub fn screen(&self) -> Screen {
        Screen(std::fs::read(self.folder.path().join("Xvfb_screen0")).unwrap())
    }

    /// Sends keys, clicks and sizes.
    pub fn xdotool(&self, arguments: &str) -> String {
        let mut command = Command::new("xdotool");
        let output = command.env("DISPLAY", &self.display).args(arguments.split_whitespace()).output();
        let output = output.unwrap_or_else(|error| panic!("xdotool: {error}; apt-get install xdotool"));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Opens the program's window in a folder with arguments, under the validation layer.
    pub fn open(&self, folder: &Path, arguments: &str) -> Program<'_> {
        self.open_with(folder, arguments, |command| {
            command.env("WELKIN_CONFIG", folder.join("config"));
        })
    }

    /// The same with a change of its environment.
    pub fn open_with(&self, folder: &Path, arguments: &str, change: impl FnOnce(&mut Command)) -> Program<'_> {
        let mut command = Command::new(binary());
        command.env("DISPLAY", &self.display).env_remove("WAYLAND_DISPLAY").env("WELKIN_VALIDATION", "1");
        command.env("WELKIN_CACHE", folder.join("cache")).env_remove("WELKIN_CONFIG");
        command.env("WELKIN_LOG", "info").env("NO_COLOR", "1");
        change(&mut command);
        command.current_dir(folder).arg("window").args(arguments.split_whitespace());
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let stdout = Said::listen(process.stdout.take().unwrap());
        let stderr = Said::listen(process.stderr.take().unwrap());
        let mut program = Program { desktop: self, process, stdout, stderr, window: String::new() };
        program.window = until("a window", || {
            assert!(program.process.try_wait().unwrap().is_none(), "it ended: {}", program.stderr.text());
            self.xdotool("search --name ^welkin:").lines().last().map(str::to_owned)
        });
        self.xdotool(&format!("windowfocus {}", program.window));
        program
    }
}

impl Drop for Desktop {
    fn drop(&mut self) {
        for process in self.manager.iter_mut().chain([&mut self.server]) {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

/// A screen in the format of xwd.
pub struct Screen(Vec<u8>);

impl Screen {
    /// Red, green, blue.
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        let Self(bytes) = self;
        // Big-endian numbers, of which these are the header's length, bytes a row, number of colours.
        let number = |index: usize| u32::from_be_bytes(bytes[4 * index..4 * index + 4].try_into().unwrap()) as usize;
        let at = number(0) + 12 * number(19) + y * number(12) + 4 * x;
        [bytes[at + 2], bytes[at + 1], bytes[at]]
    }
}

/// The program: Cargo names it to tests; for an example it lies a folder above.
fn binary() -> PathBuf {
    match option_env!("CARGO_BIN_EXE_welkin") {
        Some(path) => path.into(),
        None => std::env::current_exe().unwrap().parent().unwrap().with_file_name("welkin"),
    }
}

/// Waits for something to be there.
pub fn until<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let started = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(started.elapsed() < PATIENCE, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// What a program has said so far.
#[derive(Clone, Default)]
pub struct Said(Arc<Mutex<String>>);

impl Said {
    fn listen(stream: impl Read + Send + 'static) -> Self {
        let said = Self::default();
        let heard = said.clone();
        std::thread::spawn(move || {
            for line in BufReader::new(stream).lines().map_while(Result::ok) {
                *heard.0.lock().unwrap() += &format!("{line}\n");
            }
        });
        said
    }

    /// All of it.
    pub fn text(&self) -> String {
        self.0.lock().unwrap().clone()
    }
}

/// The program with its window open.
pub struct Program<'a> {
    desktop: &'a Desktop,
    process: Child,
    /// Its standard output and error.
    pub stdout: Said,
    pub stderr: Said,
    window: String,
}

impl Program<'_> {
    /// Presses a key, as in `ctrl+s`.
    pub fn key(&self, key: &str) {
        self.desktop.xdotool(&format!("key {key}"));
    }

    /// Holds a key for some seconds.
    pub fn hold(&self, key: &str, seconds: f64) {
        self.desktop.xdotool(&format!("keydown {key} sleep {seconds} keyup {key}"));
    }

    /// Clicks at a place of the screen.
    pub fn click(&self, x: usize, y: usize) {
        self.desktop.xdotool(&format!("mousemove {x} {y} sleep 0.3 click 1"));
    }

    /// Does something to the window: `windowsize WINDOW 300 200` without its name.
    pub fn window(&self, command: &str, arguments: &str) {
        self.desktop.xdotool(&format!("{command} {} {arguments}", self.window));
    }

    /// The same with several commands, in which `WINDOW` stands for the window.
    pub fn act_on_window(&self, commands: &str) {
        self.desktop.xdotool(&commands.replace("WINDOW", &self.window));
    }

    pub fn title(&self) -> String {
        self.desktop.xdotool(&format!("getwindowname {}", self.window)).trim().to_owned()
    }

    /// Waits until it has said something on standard error after what it had said before.
    pub fn wait_for(&self, words: &str, from: usize) {
        until(words, || self.stderr.text()[from..].contains(words).then_some(()));
    }

    /// Memory that it occupies, KiB.
    pub fn memory_kib(&self) -> u64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.process.id())).unwrap_or_default();
        let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
        line.split_whitespace().nth(1).and_then(|number| number.parse().ok()).unwrap_or(0)
    }

    /// Waits for its end; its exit code.
    pub fn exit_code(mut self) -> i32 {
        until("its end", || self.process.try_wait().unwrap()).code().expect("it ended by itself")
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
