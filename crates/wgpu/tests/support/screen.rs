//! A virtual X server, and what a viewer shows there: included by path, by the tests of both runtimes.
#![allow(dead_code, reason = "each test program uses what it needs")]

use std::error::Error;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use x11rb::CURRENT_TIME;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ConfigureWindowAux, ConnectionExt, ImageFormat, InputFocus, KEY_PRESS_EVENT,
    KEY_RELEASE_EVENT, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Longer than anything takes, even where shaders are compiled by a busy processor.
pub(crate) const PATIENCE: Duration = Duration::from_secs(120);

/// A process that ends with the test.
pub(crate) struct Running(pub(crate) Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual X server, and the number of its display.
pub(crate) fn start_server() -> (Running, String) {
    let server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1300x820x24", "-nolisten", "tcp"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let mut server = server.unwrap_or_else(|error| {
        panic!(
            "Xvfb: {error}; install it (Debian: xvfb libxkbcommon-x11-0 libxcursor1 libxi6), or set \
             DRYPOINT_NO_GPU=1 to pass over the GPU tests"
        )
    });
    let mut number = String::new();
    let mut output = server.stdout.take().expect("it is piped");
    let mut byte = [0];
    while output.read_exact(&mut byte).is_ok() && byte != [b'\n'] {
        number.push(char::from(byte[0]));
    }
    assert!(!number.is_empty(), "Xvfb found no free display");
    (Running(server), format!(":{number}"))
}

/// Starts a viewer on that display.
pub(crate) fn start(
    viewer: &Path,
    arguments: &[&str],
    display: &str,
) -> Result<Running, Box<dyn Error>> {
    let mut viewer = Command::new(viewer);
    viewer.args(arguments).env("DISPLAY", display);
    viewer.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    Ok(Running(viewer.spawn()?))
}

pub(crate) struct Session {
    connection: RustConnection,
    root: Window,
}

/// What the screen shows: red, green and blue, row by row.
#[derive(PartialEq, Eq)]
pub(crate) struct Picture {
    pixels: Vec<[u8; 3]>,
}

/// How pixels are, in shares of all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    pub(crate) dark: f64,
    pub(crate) white: f64,
    pub(crate) colorful: f64,
}

/// Of the windows that viewers open.
pub(crate) const SIZE: [u16; 2] = [1280, 800];

impl Session {
    pub(crate) fn new(display: &str) -> Result<Self, Box<dyn Error>> {
        let (connection, screen) = x11rb::connect(Some(display))?;
        let root = connection.setup().roots[screen].root;
        Ok(Self { connection, root })
    }

    /// The viewer's window and its title, once it has one.
    fn window(&self) -> Result<Option<(Window, String)>, Box<dyn Error>> {
        let name = self.connection.intern_atom(false, b"_NET_WM_NAME")?.reply()?.atom;
        for window in self.connection.query_tree(self.root)?.reply()?.children {
            let property =
                self.connection.get_property(false, window, name, AtomEnum::ANY, 0, 1 << 12)?;
            // Windows of the server come and go.
            let title = property.reply().map(|property| property.value).unwrap_or_default();
            let title = String::from_utf8_lossy(&title).into_owned();
            if title.starts_with("Drypoint") {
                return Ok(Some((window, title)));
            }
        }
        Ok(None)
    }

    fn title(&self) -> Result<String, Box<dyn Error>> {
        Ok(self.window()?.map(|(_, title)| title).unwrap_or_default())
    }

    /// As a window manager would.
    pub(crate) fn focus(&self) -> Result<(), Box<dyn Error>> {
        let (window, _) = self.window()?.ok_or("the window is gone")?;
        let focus = InputFocus::PARENT;
        Ok(self.connection.set_input_focus(focus, window, CURRENT_TIME)?.check()?)
    }

    /// Waits for a title that is as it should be, and gives it.
    #[track_caller]
    pub(crate) fn wait_for(&self, what: &str, is_right: &dyn Fn(&str) -> bool) -> String {
        let start = Instant::now();
        loop {
            let title = self.title().expect("the server is there");
            if is_right(&title) {
                return title;
            }
            assert!(start.elapsed() < PATIENCE, "{what}: {title}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Presses and releases the key of a letter on a usual keyboard.
    pub(crate) fn press(&self, keycode: u8) -> Result<(), Box<dyn Error>> {
        for event in [KEY_PRESS_EVENT, KEY_RELEASE_EVENT] {
            self.connection.xtest_fake_input(event, keycode, 0, self.root, 0, 0, 0)?.check()?;
        }
        Ok(())
    }

    /// Gives the window another size, as a window manager would.
    pub(crate) fn resize(&self, [width, height]: [u16; 2]) -> Result<(), Box<dyn Error>> {
        let (window, _) = self.window()?.ok_or("the window is gone")?;
        let size = ConfigureWindowAux::new().width(u32::from(width)).height(u32::from(height));
        Ok(self.connection.configure_window(window, &size)?.check()?)
    }

    /// What the screen shows, from its upper left corner on. Kept as `name` in the folder of test output.
    pub(crate) fn look(
        &self,
        name: &str,
        [width, height]: [u16; 2],
    ) -> Result<Picture, Box<dyn Error>> {
        let image =
            self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0)?;
        let pixels: Vec<[u8; 3]> =
            image.reply()?.data.chunks_exact(4).map(|bgra| [bgra[2], bgra[1], bgra[0]]).collect();
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        let file = fs::File::create(folder.join(format!("{name}.png")))?;
        let mut png = png::Encoder::new(file, width.into(), height.into());
        png.set_color(png::ColorType::Rgb);
        png.write_header()?.write_image_data(pixels.as_flattened())?;
        Ok(Picture { pixels })
    }

    /// Looks until it is as it should be.
    #[track_caller]
    pub(crate) fn look_for(
        &self,
        name: &str,
        size: [u16; 2],
        is_right: &dyn Fn(&Picture) -> bool,
    ) -> Picture {
        let start = Instant::now();
        loop {
            let picture = self.look(name, size).expect("the server is there");
            if is_right(&picture) {
                return picture;
            }
            let shares = picture.shares();
            assert!(start.elapsed() < PATIENCE, "{name}.png is not as it should be: {shares:?}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Picture {
    pub(crate) fn shares(&self) -> Shares {
        let share = |is_so: &dyn Fn(&[u8; 3]) -> bool| {
            let count = self.pixels.iter().filter(|pixel| is_so(pixel)).count();
            count as f64 / self.pixels.len() as f64
        };
        let spread = |p: &[u8; 3]| {
            p.iter().max().copied().unwrap_or(0) - p.iter().min().copied().unwrap_or(0)
        };
        Shares {
            dark: share(&|pixel| pixel.iter().all(|&channel| channel < 100)),
            white: share(&|pixel| pixel.iter().all(|&channel| channel > 250)),
            colorful: share(&|pixel| spread(pixel) > 30),
        }
    }

    /// Whether it has lines on white, and nothing else.
    pub(crate) fn is_drawing(&self) -> bool {
        let Shares { dark, white, colorful } = self.shares();
        (0.01..0.3).contains(&dark) && white > 0.5 && colorful < 0.001
    }
}

/// What the title says.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub(crate) contours: u64,
    pub(crate) tested: u64,
    pub(crate) edges: u64,
}

impl Counts {
    pub(crate) fn of(title: &str) -> Self {
        let words: Vec<_> = title.split_whitespace().collect();
        // "… N contour edges; … N of N edges tested in …"
        let before = |word: &str, back: usize| {
            let place = words.iter().position(|&w| w == word).expect("the title has its words");
            words[place - back].parse().expect("a number is before it")
        };
        Self {
            contours: before("contour", 1),
            tested: before("tested", 4),
            edges: before("tested", 2),
        }
    }
}

/// Keycodes of the X server's own keyboard.
pub(crate) const C: u8 = 54;
pub(crate) const P: u8 = 33;
pub(crate) const V: u8 = 55;
pub(crate) const SPACE: u8 = 65;
pub(crate) const ESCAPE: u8 = 9;
