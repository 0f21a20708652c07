//! The example `viewer` in a window of a virtual X server: what it shows, and that it hears keys.

mod support;

use std::error::Error;
use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use x11rb::CURRENT_TIME;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, ConnectionExt, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Longer than anything takes, even where shaders are compiled by a busy processor.
const PATIENCE: Duration = Duration::from_secs(120);

/// A process that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual X server, and the number of its display.
fn start_server() -> (Running, String) {
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

struct Session {
    connection: RustConnection,
    root: Window,
}

/// How the pixels of the screen are, in shares of all.
#[derive(Clone, Copy, Debug)]
struct Pixels {
    dark: f64,
    white: f64,
    colorful: f64,
}

impl Session {
    fn new(display: &str) -> Result<Self, Box<dyn Error>> {
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
    fn focus(&self) -> Result<(), Box<dyn Error>> {
        let (window, _) = self.window()?.ok_or("the window is gone")?;
        let focus = InputFocus::PARENT;
        Ok(self.connection.set_input_focus(focus, window, CURRENT_TIME)?.check()?)
    }

    /// Waits for a title that is as it should be, and gives it.
    #[track_caller]
    fn wait_for(&self, what: &str, is_right: &dyn Fn(&str) -> bool) -> String {
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
    fn press(&self, keycode: u8) -> Result<(), Box<dyn Error>> {
        for event in [KEY_PRESS_EVENT, KEY_RELEASE_EVENT] {
            self.connection.xtest_fake_input(event, keycode, 0, self.root, 0, 0, 0)?.check()?;
        }
        Ok(())
    }

    /// What the screen shows. Kept as `name` in the folder of test output.
    fn look(&self, name: &str) -> Result<Pixels, Box<dyn Error>> {
        let (width, height) = (1280, 800);
        let image =
            self.connection.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0)?;
        let pixels: Vec<[u8; 3]> =
            image.reply()?.data.chunks_exact(4).map(|bgra| [bgra[2], bgra[1], bgra[0]]).collect();
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        let file = fs::File::create(folder.join(format!("viewer-{name}.png")))?;
        let mut png = png::Encoder::new(file, width.into(), height.into());
        png.set_color(png::ColorType::Rgb);
        png.write_header()?.write_image_data(pixels.as_flattened())?;
        let share = |is_so: &dyn Fn(&[u8; 3]) -> bool| {
            pixels.iter().filter(|pixel| is_so(pixel)).count() as f64 / pixels.len() as f64
        };
        let spread = |p: &[u8; 3]| {
            p.iter().max().max(p.first()).copied().unwrap_or(0)
                - p.iter().min().copied().unwrap_or(0)
        };
        Ok(Pixels {
            dark: share(&|pixel| pixel.iter().all(|&channel| channel < 100)),
            white: share(&|pixel| pixel.iter().all(|&channel| channel > 250)),
            colorful: share(&|pixel| spread(pixel) > 30),
        })
    }
}

/// What the title says.
#[derive(Clone, Copy, Debug)]
struct Counts {
    contours: u64,
    tested: u64,
    edges: u64,
}

impl Counts {
    fn of(title: &str) -> Self {
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
const C: u8 = 54;
const P: u8 = 33;
const ESCAPE: u8 = 9;

#[test]
fn the_viewer_shows_contours_and_hears_keys() -> Result<(), Box<dyn Error>> {
    if support::is_without_gpu() {
        return Ok(());
    }
    let (_server, display) = start_server();
    let mut viewer = Command::new(support::example("viewer"));
    viewer.args(["--instances", "30", "--still"]).env("DISPLAY", &display);
    viewer.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let mut viewer = Running(viewer.spawn()?);
    let session = Session::new(&display)?;

    let is_counted = |title: &str| title.contains("edge") && Counts::of(title).contours > 0;
    let culled = session.wait_for("contours are counted", &is_counted);
    assert!(culled.contains("30 instances") && culled.contains("culling on"), "{culled}");
    let culled = Counts::of(&culled);
    assert!(culled.tested < culled.edges / 2, "most are culled: {culled:?}");
    let lines = session.look("lines")?;
    assert!((0.01..0.3).contains(&lines.dark), "lines are drawn: {lines:?}");
    assert!(lines.white > 0.5 && lines.colorful < 0.001, "on white: {lines:?}");

    session.focus()?;
    session.press(C)?;
    let tests_all = |title: &str| {
        let counts = Counts::of(title);
        title.contains("culling off") && counts.tested == counts.edges
    };
    let all = session.wait_for("without culling all are tested", &tests_all);
    assert_eq!(Counts::of(&all).contours, culled.contours);

    session.press(P)?;
    let start = Instant::now();
    let mut patches = session.look("patches")?;
    while patches.colorful < 0.05 {
        assert!(start.elapsed() < PATIENCE, "patches have colors: {patches:?}");
        patches = session.look("patches")?;
    }
    assert!(patches.dark > 0.5 * lines.dark, "lines are still there: {patches:?}");

    session.press(ESCAPE)?;
    assert!(viewer.0.wait()?.success());
    Ok(())
}
