//! What safe code can get wrong is refused, or does no harm.

#[path = "support/scene.rs"]
mod scene;
mod support;

use ash::vk;
use drypoint_ash::{
    Attached, Canvas, Capacity, Commands, Contours, Counting, DepthOrder, Error, Extractor,
    LinePass, LineStyle, MeshContours, MeshOptions, MeshOutput, MeshPass, Method, Model, Offscreen,
    Picture, Queries, Subject, Surface, View,
};
use drypoint_fusion::Levels;
use drypoint_mesh::shapes;
use scene::{ATTACHED, CAPACITY, SIZE, model, scene};
use support::{Expected, gpu, patches, placements};

/// A model, contours and a pass may go before what was recorded with them has executed.
#[test]
fn what_commands_use_stays_until_they_have_executed() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::torus_knot(3_000);
    let set = patches(&mesh, Levels::Two);
    let all = &placements(&mesh)[..4];
    let (found, executed) = gpu
        .run(|commands| {
            let pass = MeshPass::new(commands.device(), &MeshOptions::default())?;
            let model = Model::new(commands, &[&set])?;
            let capacity = Capacity { placements: 4, segments: 20_000 };
            let mut contours = MeshContours::new(&pass, &model, capacity)?;
            contours.prepare(commands, all, Method::Patches)?;
            pass.extract(commands, &contours)?;
            contours.download(commands)
        })
        .expect("it is drawn");
    // The device stays as long as something that was made from it.
    drop(gpu);
    let mut segments = found.segments(&executed).expect("they fit");
    segments.sort_unstable();
    Expected::new(&set, all).compare(&segments, "after all is gone");
    support::expect_silence();
}

#[test]
fn queries_are_refused_where_they_do_not_fit_and_new_where_they_are_under_way() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let set = patches(&shapes::icosphere(500), Levels::One);
    let all = &placements(&shapes::icosphere(500))[..2];
    let pass = MeshPass::new(gpu.device(), &MeshOptions::default()).expect("shaders compile");
    let mut mesh = Queries::new(gpu.device(), Counting::MeshShaders).expect("it can count");
    let mut compute = Queries::new(gpu.device(), Counting::Compute).expect("it can count");
    let refused = gpu.run(|commands| {
        mesh.begin(commands)?;
        compute.begin(commands)
    });
    assert_eq!(refused.err(), Some(Error::Counting { what: "more queries" }));
    // What is under way when recording ends, ends there: it is not read, and hangs nobody.
    let ((), executed) = gpu.run(|commands| mesh.begin(commands)).expect("it is recorded");
    let unread = mesh.read(&executed);
    assert_eq!(unread.err(), Some(Error::OtherCommands { what: "queries" }));
    let refused = gpu.run(|commands| {
        let model = Model::new(commands, &[&set])?;
        let capacity = Capacity { placements: 2, segments: 1_000 };
        let mut contours = MeshContours::new(&pass, &model, capacity)?;
        contours.prepare(commands, all, Method::Patches)?;
        compute.begin(commands)?;
        pass.extract(commands, &contours)
    });
    assert!(matches!(refused.err(), Some(Error::Counting { .. })));
    // What was asked for in vain has nothing to read, and what was read before neither.
    let (again, executed) = gpu
        .run(|commands| {
            mesh.begin(commands)?;
            mesh.end(commands)?;
            compute.begin(commands)?;
            Ok(mesh.begin(commands))
        })
        .expect("it is recorded");
    assert_eq!(again, Err(Error::Counting { what: "more queries" }));
    mesh.read(&executed).expect("it was counted before");
    // Twice in the same commands: the second time with new ones.
    let counts = gpu.run(|commands| {
        let model = Model::new(commands, &[&set])?;
        let capacity = Capacity { placements: 2, segments: 1_000 };
        let mut contours = MeshContours::new(&pass, &model, capacity)?;
        for few in [1, 2] {
            contours.prepare(commands, &all[..few], Method::BruteForce)?;
            mesh.begin(commands)?;
            pass.extract(commands, &contours)?;
            mesh.end(commands)?;
        }
        Ok(())
    });
    let ((), executed) = counts.expect("it is drawn");
    let edges = 2 * set.wings().len() as u64;
    let [lanes, share] = [pass.mesh_width(), pass.edges_per_workgroup()].map(u64::from);
    let counts = mesh.read(&executed).expect("it was counted");
    assert_eq!(counts.mesh_invocations, edges.div_ceil(share) * lanes);
    support::expect_silence();
}

/// Commands of two devices that change places, and a closure that panics, leave nothing behind that was not done.
#[test]
fn commands_are_not_taken_for_others() {
    if support::is_without_gpu() {
        return;
    }
    let [one, two] = [gpu(), gpu()];
    let exchanged = one.run(|first| {
        let inner = two.run(|second| {
            std::mem::swap(first, second);
            Ok(())
        });
        assert_eq!(inner.err(), Some(Error::Exchanged));
        Ok(())
    });
    assert_eq!(exchanged.err(), Some(Error::Exchanged));

    let set = patches(&shapes::icosphere(500), Levels::One);
    let mut leaked = None;
    let panicking = std::panic::AssertUnwindSafe(|| {
        one.run(|commands| {
            leaked = Some(Model::new(commands, &[&set])?);
            panic!("on purpose");
            #[allow(unreachable_code, reason = "it says what is not given")]
            Ok(())
        })
    });
    assert!(std::panic::catch_unwind(panicking).is_err());
    let model = leaked.expect("it was made");
    let pass = MeshPass::new(one.device(), &MeshOptions::default()).expect("shaders compile");
    let capacity = Capacity { placements: 1, segments: 1_000 };
    let error = MeshContours::new(&pass, &model, capacity).expect_err("nothing was uploaded");
    assert_eq!(error, Error::Abandoned { what: "the model" });
    // Nothing was prepared: there is nothing to copy.
    let (model, _) = one.run(|commands| Model::new(commands, &[&set])).expect("there is memory");
    let contours = MeshContours::new(&pass, &model, capacity).expect("there is memory");
    let error = one.run(|commands| contours.download(commands)).expect_err("nothing is prepared");
    assert_eq!(error, Error::Unprepared);
    support::expect_silence();
}

#[test]
fn fragment_shaders_that_bind_or_are_not_there_are_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let binding = "@group(0) @binding(0) var<uniform> color: vec4f;
        @fragment fn fragment() -> @location(0) vec4f { return color; }";
    let other = "@fragment fn other() -> @location(0) vec4f { return vec4f(); }";
    let far =
        "@fragment fn fragment(@location(7) x: f32) -> @location(0) vec4f { return vec4f(x); }";
    let whole = "@fragment fn fragment() -> @location(0) vec4u { return vec4u(); }";
    for (source, why) in [
        (binding, "binds"),
        (other, "no fragment entry point"),
        ("fn", "expected"),
        (far, "reads something else"),
        (whole, "gives something else"),
    ] {
        let output = MeshOutput::Custom(ATTACHED, source);
        let options = MeshOptions { output, ..MeshOptions::default() };
        let error = MeshPass::new(gpu.device(), &options).expect_err("it is refused");
        assert!(error.to_string().contains(why), "{error}");
    }
    support::expect_silence();
}

#[test]
fn what_does_not_fit_together_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::icosphere(100);
    let model = model(&gpu, &patches(&mesh, Levels::One));
    let lines = MeshOptions { output: MeshOutput::Lines(ATTACHED), ..MeshOptions::default() };
    let lines = MeshPass::new(gpu.device(), &lines).expect("shaders compile");
    let contours = MeshContours::new(&lines, &model, CAPACITY).expect("there is memory");
    // Nothing is drawn by it, but it is not for that.
    let (mut prepared, placement) = (contours, scene().0[0]);
    let error = gpu.run(|commands| {
        prepared.prepare(commands, &[placement], Method::Patches)?;
        lines.extract(commands, &prepared)
    });
    assert!(matches!(error.expect_err("it draws"), Error::OtherAttachments { .. }));
    let narrow = MeshOptions { mesh_width: Some(16), ..MeshOptions::default() };
    let narrow = MeshPass::new(gpu.device(), &narrow).expect("shaders compile");
    let error = gpu.run(|commands| {
        prepared.prepare(commands, &[placement], Method::Patches)?;
        narrow.extract(commands, &prepared)
    });
    assert_eq!(error.expect_err("other workgroups"), Error::OtherPass);
    let error = gpu.run(|commands| lines.extract(commands, &prepared));
    assert_eq!(error.expect_err("in other commands"), Error::Unprepared);
    let error = gpu.run(|commands| Surface::new(commands, &prepared, &[&shapes::icosphere(500)]));
    assert_eq!(error.expect_err("another mesh"), Error::OtherMeshes);
    let error = gpu.run(|commands| Picture::new(commands, [0, 5], DepthOrder::Standard));
    assert!(matches!(error.expect_err("no pixels"), Error::PictureSize { .. }));
    let other = support::gpu();
    let error = other.run(|commands| Surface::new(commands, &prepared, &[&mesh]));
    assert!(matches!(error.expect_err("another device"), Error::OtherDevice { .. }));
    let error = Contours::new(&Extractor::new(other.device()).unwrap(), &model, CAPACITY);
    assert!(matches!(error.expect_err("another device"), Error::OtherDevice { .. }));
    let ((), executed) = gpu.run(|_| Ok(())).expect("nothing is done");
    let (found, _) = gpu
        .run(|commands| {
            prepared.prepare(commands, &[placement], Method::Patches)?;
            prepared.download(commands)
        })
        .expect("it is copied");
    let error = found.statistics(&executed).expect_err("other commands");
    assert!(matches!(error, Error::OtherCommands { .. }));
    support::expect_silence();
}

/// What safe code can get wrong, and the GPU must not hear of.
#[test]
fn what_was_never_executed_or_made_for_others_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::icosphere(100);
    let set = patches(&mesh, Levels::One);
    let extractor = Extractor::new(gpu.device()).expect("shaders compile");
    let (placements, scene_to_clip) = scene();
    let style = LineStyle::default();
    let view = View { scene_to_clip, background: [1.0; 4], lines: style };
    let mut leaked = None;
    let stop = gpu.run(|commands| {
        leaked = Some((Model::new(commands, &[&set])?, Offscreen::new(commands, SIZE)?));
        Err::<(), _>(Error::NoPatches)
    });
    assert_eq!(stop.err(), Some(Error::NoPatches));
    let (never, offscreen) = leaked.expect("it was made");
    let error = Contours::new(&extractor, &never, CAPACITY).expect_err("it is empty");
    assert_eq!(error, Error::Abandoned { what: "the model" });
    let error = gpu.run(|commands| offscreen.download(commands)).expect_err("it is nothing");
    assert_eq!(error, Error::Abandoned { what: "the picture" });

    let model = model(&gpu, &set);
    let mut contours = Contours::new(&extractor, &model, CAPACITY).expect("there is memory");
    let mut others = Contours::new(&extractor, &model, CAPACITY).expect("there is memory");
    let ((picture, surface), _) = gpu
        .run(|commands| {
            let picture = Picture::new(commands, SIZE, DepthOrder::Standard)?;
            Ok((picture, Surface::new(commands, &contours, &[&mesh])?))
        })
        .expect("there is memory");
    let draw = |contours: &Contours, commands: &mut Commands| {
        let subject = Subject { contours: contours.into(), surface: &surface };
        picture.draw(commands, &view, &[subject]).map(|_| ())
    };
    let error = gpu.run(|commands| draw(&contours, commands)).expect_err("nothing is prepared");
    assert_eq!(error, Error::Unprepared);
    let error = gpu.run(|commands| extractor.record(commands, &contours));
    assert_eq!(error.expect_err("nothing is prepared"), Error::Unprepared);
    let error = gpu.run(|commands| {
        others.prepare(commands, &placements, Method::Patches)?;
        draw(&others, commands)
    });
    assert_eq!(error.expect_err("the surface is of others"), Error::OtherContours);
    // Nothing has been extracted: nothing is drawn.
    let drawn = gpu.run(|commands| {
        contours.prepare(commands, &placements, Method::Patches)?;
        draw(&contours, commands)
    });
    drawn.expect("it is drawn");
    support::expect_silence();
}

#[test]
fn what_failed_or_was_forgotten_leaves_images_as_they_have_to_be() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let mesh = shapes::icosphere(100);
    let model = model(&gpu, &patches(&mesh, Levels::One));
    let (placements, scene_to_clip) = scene();
    let view = View { scene_to_clip, background: [1.0; 4], lines: LineStyle::default() };
    let narrow = MeshOptions { mesh_width: Some(16), ..MeshOptions::default() };
    let narrow = MeshPass::new(gpu.device(), &narrow).expect("shaders compile");
    let made = gpu.run(|commands| {
        let canvas = Canvas::new(commands, SIZE, DepthOrder::Standard, Offscreen::FORMAT)?;
        let offscreen = Offscreen::new(commands, SIZE)?;
        let mut meshed = MeshContours::new(&narrow, &model, CAPACITY)?;
        let surface = Surface::new(commands, &meshed, &[&mesh])?;
        meshed.prepare(commands, &placements, Method::Patches)?;
        let subject = Subject { contours: (&meshed).into(), surface: &surface };
        assert_eq!(canvas.cover(commands, &view, &[subject]), Err(Error::OtherPass));
        canvas.ink(&mut offscreen.render(commands, [1.0; 4])?)?;
        // Rendering that nobody ends.
        std::mem::forget(offscreen.render(commands, [1.0; 4])?);
        offscreen.download(commands)
    });
    made.expect("it is recorded");
    support::expect_silence();
}

#[test]
fn formats_that_cannot_be_drawn_to_are_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let depth = (vk::Format::R8_UNORM, DepthOrder::Standard);
    for attached in [
        Attached { color: vk::Format::R32_UINT, depth: None },
        Attached { color: vk::Format::BC1_RGB_UNORM_BLOCK, depth: None },
        Attached { depth: Some(depth), ..ATTACHED },
    ] {
        let error = LinePass::new(gpu.device(), &attached).expect_err("it cannot be blended");
        assert!(matches!(error, Error::Format { .. }), "{error}");
        let options = MeshOptions { output: MeshOutput::Lines(attached), ..MeshOptions::default() };
        let error = MeshPass::new(gpu.device(), &options).expect_err("it cannot be blended");
        assert!(matches!(error, Error::Format { .. }), "{error}");
    }
    // Whole numbers are for shaders that give such.
    let whole = Attached { color: vk::Format::R32_UINT, depth: None };
    let source = "@fragment fn fragment() -> @location(0) vec4u { return vec4u(1u); }";
    let options =
        MeshOptions { output: MeshOutput::Custom(whole, source), ..MeshOptions::default() };
    MeshPass::new(gpu.device(), &options).expect("it is drawn to as it is");
    let format = vk::Format::R32_UINT;
    let error = gpu.run(|commands| Canvas::new(commands, SIZE, DepthOrder::Standard, format));
    assert!(matches!(error.expect_err("it cannot be blended"), Error::Format { .. }));
    support::expect_silence();
}

#[test]
fn a_pass_without_a_look_is_refused() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = gpu();
    let model = model(&gpu, &patches(&shapes::icosphere(100), Levels::One));
    let options = MeshOptions { output: MeshOutput::Lines(ATTACHED), ..MeshOptions::default() };
    let pass = MeshPass::new(gpu.device(), &options).expect("shaders compile");
    let (placements, _) = scene();
    let error = gpu.run(|commands| {
        let mut contours = MeshContours::new(&pass, &model, CAPACITY)?;
        contours.prepare(commands, &placements, Method::Patches)?;
        let offscreen = Offscreen::new(commands, SIZE)?;
        pass.record(&mut offscreen.render(commands, [1.0; 4])?, &contours)
    });
    assert_eq!(error.expect_err("it has no matrix"), Error::NoStyle);
    support::expect_silence();
}
