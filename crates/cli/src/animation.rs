//! `--animation` and `--time`: models that move, in one of their poses.

use clap::Args;
use drypoint_mesh::io;
use drypoint_mesh::rig::{Animation, Pose, Rig};

use crate::args::number;
use crate::source::Source;

/// Which pose a model is in.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Animation")]
pub(crate) struct AnimationArgs {
    /// Pose the model as this animation does: its name, or its number from 0; `drypoint info` lists
    /// them
    #[arg(long, value_name = "NAME")]
    pub(crate) animation: Option<String>,
    /// Moment of the animation in seconds; before its first key and after its last the model stays
    /// as it is there [default: 0]
    #[arg(long, value_name = "SECONDS", value_parser = number, requires = "animation")]
    #[arg(allow_hyphen_values = true)]
    pub(crate) time: Option<f64>,
}

impl AnimationArgs {
    /// The animation that is asked for, by its index.
    pub(crate) fn find(&self, source: &Source) -> Result<Option<usize>, String> {
        let Some(wanted) = &self.animation else { return Ok(None) };
        let animations = source.model.rig.as_ref().map_or(&[][..], Rig::animations);
        let is_wanted = |animation: &Animation| animation.name == *wanted;
        let numbered = || wanted.parse().ok().filter(|&number: &usize| number < animations.len());
        if let Some(found) = animations.iter().position(is_wanted).or_else(numbered) {
            return Ok(Some(found));
        }
        if animations.is_empty() {
            return Err(format!("--animation: {} has no animations", source.name));
        }
        let names: Vec<&str> = animations.iter().map(|animation| &*animation.name).collect();
        Err(format!(
            "--animation: {} has no animation '{wanted}'; it has {}",
            source.name,
            names.join(", ")
        ))
    }

    /// The pose that is asked for, at rest unless there is an animation; `None` if nothing can move.
    pub(crate) fn pose(&self, source: &Source) -> Result<Option<Pose>, String> {
        let animation = self.find(source)?;
        let at = |rig: &Rig| match animation {
            Some(animation) => rig.pose_at(animation, self.time.unwrap_or(0.0)),
            None => rig.rest(),
        };
        Ok(source.model.rig.as_ref().map(at))
    }

    /// Refuses an animation of a model that comes with patches, which are those of its rest pose.
    pub(crate) fn check_patches(&self, model: &std::path::Path) -> Result<(), String> {
        match self.animation {
            Some(_) => Err(format!(
                "--animation: the patches of {} are those of the model at rest",
                model.display()
            )),
            None => Ok(()),
        }
    }
}

impl Source {
    /// The model as it is drawn: in the pose that `args` ask for, if it can move.
    pub(crate) fn in_pose(self, args: &AnimationArgs) -> Result<Self, String> {
        match args.pose(&self)? {
            Some(pose) => self.posed(&pose),
            None => Ok(self),
        }
    }

    /// The surface of a model that moves, in one pose: its triangles, on the vertices of its rig.
    ///
    /// # Panics
    /// If it cannot move.
    pub(crate) fn posed(&self, pose: &Pose) -> Result<Self, String> {
        let rig = self.model.rig.as_ref().expect("a model that moves has a rig");
        let mesh = rig.mesh(pose).map_err(|error| format!("{}: {error}", self.name))?;
        let io::Model { parts, materials, .. } = &self.model;
        let (parts, materials) = (parts.clone(), materials.clone());
        let model = io::Model { mesh, parts, materials, ..io::Model::default() };
        Ok(Self { name: self.name.clone(), model, is_posed: true })
    }
}

/// Frames from the begin of so many seconds to their end.
pub(crate) fn frames_of(duration: f64, fps: f64) -> usize {
    // Keys are f32: a last frame that their rounding puts a hair behind the end is one.
    let steps = duration * fps * (1.0 + f64::from(f32::EPSILON)) + 1e-6;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let whole = steps as usize;
    whole.saturating_add(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frame_is_at_the_end() {
        for fps in [24.0, 25.0, 30.0, 60.0] {
            for steps in 0..2000u16 {
                let exact = f64::from(steps) / fps;
                // As files have it.
                #[expect(clippy::cast_possible_truncation, reason = "what it is about")]
                let stored = f64::from(exact as f32);
                assert_eq!(frames_of(stored, fps), usize::from(steps) + 1, "{steps} at {fps}");
                assert_eq!(frames_of(stored + 0.5 / fps, fps), usize::from(steps) + 1);
            }
        }
        assert_eq!(frames_of(1e30, 1e3), usize::MAX);
    }
}
