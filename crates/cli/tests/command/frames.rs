//! `drypoint draw --frames`: what lies in the folder.

use std::collections::BTreeMap;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::bench::{Bench, CORNER};
use crate::moving;

/// What is in a folder of the bench, by name.
fn frames(bench: &Bench, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(bench.path().join(folder)).unwrap();
    let named = entries.map(|entry| entry.unwrap()).map(|entry| {
        let name = entry.file_name().into_string().unwrap();
        (name, std::fs::read(entry.path()).unwrap())
    });
    named.collect()
}

#[test]
fn an_animation_is_drawn_from_its_begin_to_its_end() {
    let bench = Bench::new();
    moving::write(&bench);
    let report = bench.json("draw moving.gltf --animation bend --frames a --fps 4 --json");
    assert_eq!(report, serde_json::json!({"frames": 5, "drawn": 5, "kept": 0, "blank": 0}));
    let names: Vec<_> = frames(&bench, "a").into_keys().collect();
    let mut expected: Vec<_> = (0..5).map(|i| format!("frame-{i:04}.svg")).collect();
    expected.push("frames.json".to_owned());
    assert_eq!(names, expected);
    let command =
        "draw moving.gltf --animation grow --animation-frames b --format png --size 40x30";
    assert!(bench.run(command).status.success());
    let drawn = frames(&bench, "b");
    assert_eq!(drawn.len(), 17, "half a second at 30 frames, its begin, and the note");
    assert!(drawn["frame-0015.png"].starts_with(b"\x89PNG"));
}

#[test]
fn what_does_not_move_stays_where_it_is() {
    let bench = Bench::new();
    moving::write(&bench);
    bench.succeed("draw moving.gltf --animation slide --frames a --fps 2 --view front");
    let drawn = frames(&bench, "a");
    let lines = |name: &str| -> Vec<String> {
        let text = String::from_utf8(drawn[name].clone()).unwrap();
        let lines = text.lines().filter(|line| line.contains("<path"));
        lines.map(|line| line.trim().to_owned()).collect()
    };
    let [first, last] = ["frame-0000.svg", "frame-0004.svg"].map(lines);
    let same = first.iter().filter(|line| last.contains(line)).count();
    assert!(same >= 2 && first != last, "{same} of {first:?} in {last:?}");
    // All that moves is on the page: each frame has the four things.
    let alone = bench.json("draw moving.gltf -o a.svg --json --view front");
    assert!(alone["contour"]["chains"].as_u64().unwrap() >= 3);
}

#[test]
fn a_turn_keeps_its_distance() {
    let bench = Bench::new();
    for view in ["--view front", "--view front --ortho", "--eye 0,0,4"] {
        let command = format!("draw shape:cube --turntable 4 --frames a --format png {view}");
        bench.succeed(&format!("{command} --overwrite --size 60x40"));
        let drawn = frames(&bench, "a");
        assert_eq!(drawn.len(), 5);
        for frame in ["frame-0001.png", "frame-0002.png", "frame-0003.png"] {
            assert_eq!(drawn[frame], drawn["frame-0000.png"], "{view}: {frame}");
        }
    }
    // While the view turns, the animation plays, or stands still.
    moving::write(&bench);
    let turn = "draw moving.gltf --turntable 3 --animation bend";
    bench.succeed(&format!("{turn} --frames plays --fps 2"));
    bench.succeed(&format!("{turn} --frames stands --time 0"));
    let [plays, stands] = ["plays", "stands"].map(|folder| frames(&bench, folder));
    assert_ne!(plays["frame-0001.svg"], stands["frame-0001.svg"]);
    assert_ne!(stands["frame-0000.svg"], stands["frame-0001.svg"]);
}

#[test]
fn what_was_cut_off_goes_on() {
    let bench = Bench::new();
    moving::write(&bench);
    let command = |folder: &str| {
        format!(
            "draw moving.gltf --animation bend --fps 9 --hidden dashed --frames {folder} --json"
        )
    };
    bench.succeed(&command("whole"));
    let expected = frames(&bench, "whole");
    bench.succeed(&command("part"));
    let path = bench.path().join("part");
    for gone in ["frame-0002.svg", "frame-0007.svg"] {
        std::fs::remove_file(path.join(gone)).unwrap();
    }
    // Somebody copied half of it.
    std::fs::write(path.join("frame-0004.svg"), &expected["frame-0004.svg"][..200]).unwrap();
    std::fs::write(path.join("notes.txt"), "mine").unwrap();
    let report = bench.json(&command("part"));
    assert_eq!((&report["drawn"], &report["kept"]), (&3.into(), &7.into()));
    let mut found = frames(&bench, "part");
    assert_eq!(found.remove("notes.txt").as_deref(), Some(&b"mine"[..]));
    assert_eq!(found, expected);
    assert_eq!(bench.json(&command("part"))["drawn"], 0);
}

#[test]
fn frames_of_another_command_are_not_mixed_in() {
    let bench = Bench::new();
    moving::write(&bench);
    let first = "draw moving.gltf --animation bend --fps 9 --frames a";
    bench.succeed(first);
    for other in [
        "draw moving.gltf --animation slide --fps 9 --frames a",
        "draw moving.gltf --animation bend --fps 4 --frames a",
        "draw moving.gltf --animation bend --fps 9 --frames a --width 3",
        "draw moving.gltf --animation bend --fps 9 --frames a --view front",
        "draw moving.gltf --animation bend --fps 9 --frames a --format png",
    ] {
        bench.fail(other, &["a: holds frames of another", "--overwrite"]);
        assert_eq!(frames(&bench, "a").len(), 11);
    }
    std::fs::create_dir(bench.path().join("b")).unwrap();
    bench.write("b/frame-0001.svg", "not ours");
    bench.fail("draw moving.gltf --animation bend --frames b", &["b: holds frames"]);
    bench.succeed("draw moving.gltf --animation bend --fps 3 --frames a --format png --overwrite");
    let names: Vec<_> = frames(&bench, "a").into_keys().collect();
    let expected: Vec<_> = (0..4).map(|i| format!("frame-{i:04}.png")).collect();
    assert_eq!(names[..4], expected);
    assert_eq!(names[4..], ["frames.json"]);
}

#[test]
fn frames_through_other_patches_are_others() {
    let bench = Bench::new();
    let film = "draw a.patches --model shape:icosphere:320 --show patches --turntable 3 --frames a";
    bench.succeed("patches shape:icosphere:320 -o a.patches --preset fast");
    bench.succeed(film);
    bench.succeed("patches shape:icosphere:320 -o a.patches --preset paper");
    bench.fail(film, &["a: holds frames of another"]);
}

#[test]
fn any_number_of_threads_draws_the_same() {
    let bench = Bench::new();
    moving::write(&bench);
    let draw = |threads: &str| {
        let status = Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .args(["draw", "moving.gltf", "--animation", "bend", "--fps", "12", "--turntable", "9"])
            .args(["--lines", "contour,boundary,crease", "--frames", threads])
            .env("RAYON_NUM_THREADS", threads)
            .current_dir(bench.path())
            .stderr(std::process::Stdio::null())
            .status();
        assert!(status.unwrap().success());
        frames(&bench, threads)
    };
    assert_eq!(draw("1"), draw("7"));
}

#[test]
fn options_of_frames_that_make_no_sense_are_refused() {
    let bench = Bench::new();
    moving::write(&bench);
    bench.write("corner.obj", CORNER);
    for (options, words) in [
        ("--frames a", &["--frames", "--animation", "--turntable"][..]),
        ("--turntable 3", &["--frames"]),
        ("--turntable 0 --frames a", &["--turntable", "108000"]),
        ("--turntable 3 --frames a -o b.svg", &["--frames", "--output"]),
        ("--turntable 3 --frames a --fps 3", &["--animation"]),
        ("--turntable 3 --frames a --time 3", &["--animation"]),
        ("--turntable 3 --frames nowhere/a", &["nowhere/a", "does not exist"]),
        ("--turntable 3 --frames moving.bin", &["moving.bin", "no folder"]),
        ("--animation bend --frames a --time 1", &["--time", "--turntable"]),
        ("--animation bend --frames a --fps 0", &["--fps"]),
        ("--animation slide --frames a --fps 1 --time 1", &["--fps", "--time"]),
        ("--animation bend --frames a --show patches", &["--show", "--time"]),
        ("--animation bend --fps 3 -o a.svg", &["--frames"]),
        ("--overwrite -o a.svg", &["--overwrite", "--frames"]),
        ("--turntable 5 -o a.svg", &["--turntable", "--frames"]),
        ("--format png", &["--format", "--frames"]),
    ] {
        bench.fail(&format!("draw moving.gltf {options}"), words);
    }
    bench.fail("draw corner.obj --frames a", &["--frames", "--animation", "--turntable"]);
    bench.fail("draw missing.glb --turntable 3 --frames a", &["missing.glb"]);
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_whole_frames_and_the_next_run_goes_on() {
    let bench = Bench::new();
    let arguments = |folder: &str| {
        format!("draw shape:torus-knot:3000 --turntable 60 --frames {folder} --hidden dashed")
    };
    let child = Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .args(arguments("cut").split_whitespace())
        .current_dir(bench.path())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while !bench.path().join("cut/frame-0001.svg").exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "no frame after a minute");
        std::thread::sleep(Duration::from_millis(2));
    }
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success());
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    let cut = frames(&bench, "cut");
    assert!(cut.len() < 61, "all was drawn before it was cut off");
    bench.succeed(&arguments("whole"));
    let whole = frames(&bench, "whole");
    assert!(cut.iter().all(|(name, frame)| whole.get(name) == Some(frame)));
    bench.succeed(&arguments("cut"));
    assert_eq!(frames(&bench, "cut"), whole);
}

#[test]
fn two_films_do_not_mix() {
    let bench = Bench::new();
    for attempt in 0..4 {
        let folder = format!("film-{attempt}");
        let mut films = ["cube", "icosphere"].map(|shape| {
            let size = ["--size", "60x60", "--turntable", "200"];
            Command::new(env!("CARGO_BIN_EXE_drypoint"))
                .args(["draw", &format!("shape:{shape}"), "--frames", &folder])
                .args(size)
                .current_dir(bench.path())
                .stderr(std::process::Stdio::piped())
                .spawn()
                .unwrap()
        });
        let drew = films.each_mut().map(|film| film.wait().unwrap().success());
        assert_ne!(drew[0], drew[1], "one of them is refused, before or after the other is done");
        let title = if drew[0] { "<title>cube<" } else { "<title>icosphere<" };
        let drawn = frames(&bench, &folder);
        assert_eq!(drawn.len(), 201);
        for (name, frame) in drawn.iter().filter(|(name, _)| name.ends_with(".svg")) {
            let text = String::from_utf8_lossy(frame);
            assert!(text.contains(title), "{name} of {folder}: {text:.200}");
        }
    }
}
