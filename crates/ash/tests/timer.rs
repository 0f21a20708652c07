//! How long the device takes, and what is no time at all; statistics without segments.

mod support;

use drypoint_ash::{
    Capacity, Contours, Error, Executed, Extractor, Method, Model, Placement, Timer,
};
use drypoint_fusion::Levels;
use drypoint_mesh::{Viewpoint, shapes};
use glam::DVec3;

fn elsewhere(result: Result<impl std::fmt::Debug, Error>) {
    assert_eq!(result.map(drop), Err(Error::OtherCommands { what: "a timer" }));
}

#[test]
fn only_what_was_begun_and_ended_has_a_time() -> Result<(), Error> {
    if support::is_without_gpu() {
        return Ok(());
    }
    let gpu = support::gpu();
    let set = support::patches(&shapes::torus_knot(2_000), Levels::One);
    let extractor = Extractor::new(gpu.device())?;
    let (model, before) = gpu.run(|commands| Model::new(commands, &[&set]))?;
    let capacity = Capacity { placements: 1, segments: 2_000 };
    let mut contours = Contours::new(&extractor, &model, capacity)?;
    assert_eq!(contours.capacity(), capacity);
    let placement = Placement::at_origin(Viewpoint::at(DVec3::new(0.0, 2.0, 9.0)));
    let mut timer = Timer::new(gpu.device())?;
    let mut extract = |timer: &mut Timer| -> Result<Executed, Error> {
        let ((all, counted), executed) = gpu.run(|commands| {
            timer.begin(commands)?;
            contours.prepare(commands, &[placement], Method::Patches)?;
            extractor.record(commands, &contours)?;
            timer.end(commands)?;
            Ok((contours.download(commands)?, contours.download_statistics(commands)?))
        })?;
        let statistics = counted.statistics(&executed)?;
        assert_eq!(statistics, all.statistics(&executed)?);
        assert_eq!(statistics.segments, all.segments(&executed)?.len() as u64);
        Ok(executed)
    };
    let executed = extract(&mut timer)?;
    let seconds = timer.seconds(&executed)?;
    assert!(seconds > 0.0 && seconds < 60.0, "{seconds}");
    elsewhere(timer.seconds(&before));

    // Again, and the first time is forgotten.
    let again = extract(&mut timer)?;
    assert!(timer.seconds(&again)? > 0.0);
    elsewhere(timer.seconds(&executed));

    let ((), executed) = gpu.run(|commands| {
        elsewhere(timer.end(commands));
        timer.begin(commands)?;
        timer.end(commands)?;
        elsewhere(timer.end(commands));
        timer.begin(commands)
    })?;
    elsewhere(timer.seconds(&executed));
    let other = support::gpu();
    let begun = other.run(|commands| timer.begin(commands));
    assert_eq!(begun.map(drop), Err(Error::OtherDevice { what: "a timer" }));
    support::expect_silence();
    Ok(())
}
