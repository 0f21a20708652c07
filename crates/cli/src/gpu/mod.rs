//! `--method wgpu` and `--method ash`: contours found and drawn by a GPU.

#[cfg(feature = "ash")]
mod ash;
#[cfg(any(feature = "ash", feature = "wgpu"))]
mod frame;
#[cfg(not(any(feature = "ash", feature = "wgpu")))]
#[path = "without.rs"]
mod frame;
#[cfg(feature = "wgpu")]
mod wgpu;

use std::fmt;

use crate::args::{DrawArgs, DrawMethod, Method, Show};
use crate::lines::{Class, Hidden};

#[cfg(feature = "wgpu")]
pub(crate) use frame::extract_rig;
pub(crate) use frame::{draw, extract};

/// What a program that was built without `drypoint-wgpu` says, which alone poses models.
#[cfg(not(feature = "wgpu"))]
pub(crate) fn extract_rig(
    api: Api,
    _: &crate::rigged::Posed<'_>,
    _: &[drypoint_fusion::PatchSet],
    _: drypoint_mesh::Viewpoint,
    _: &mut Vec<drypoint_mesh::EdgeId>,
) -> Result<drypoint_cpu::Statistics, String> {
    Err(api.refusal())
}

/// By what the GPU is spoken to, whether the program was built with it or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Api {
    Wgpu,
    Ash,
}

impl Api {
    /// As in `--method` and as its feature.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Wgpu => "wgpu",
            Self::Ash => "ash",
        }
    }

    /// Refuses what the program was built without.
    pub(crate) fn check_feature(self) -> Result<(), String> {
        let is_built_in = match self {
            Self::Wgpu => cfg!(feature = "wgpu"),
            Self::Ash => cfg!(feature = "ash"),
        };
        if is_built_in { Ok(()) } else { Err(self.refusal()) }
    }

    /// Refuses models that move, if it poses none.
    pub(crate) fn check_rig(self) -> Result<(), String> {
        match self {
            Self::Wgpu => Ok(()),
            Self::Ash => Err("--method ash: cannot pose a model, as --animation asks; --method wgpu and patches can".to_owned()),
        }
    }

    fn refusal(self) -> String {
        format!("--method {self}: this program was built without the feature {self}")
    }

    /// Refuses what the GPU's way of drawing does not know.
    pub(crate) fn check_options(self, args: &DrawArgs) -> Result<(), String> {
        let only_contours = |lines: &Vec<Class>| lines.iter().all(|class| *class == Class::Contour);
        let lines = &args.lines;
        let refused = [
            (args.show != Show::Lines, "--show", "draws lines alone"),
            (args.json, "--json", "counts no chains and measures no lengths"),
            (!lines.lines.as_ref().is_none_or(only_contours), "--lines", "draws contours alone"),
            (!matches!(lines.hidden, Hidden::None), "--hidden", "leaves hidden lines out"),
            (lines.specks.is_some_and(|specks| specks > 0.0), "--specks", "draws short pieces too"),
        ];
        let first = refused.into_iter().find(|(is_asked_for, ..)| *is_asked_for);
        first.map_or(Ok(()), |(_, option, why)| Err(format!("{option}: --method {self} {why}")))
    }
}

impl fmt::Display for Api {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl DrawMethod {
    /// The interface that it is, if a GPU draws.
    pub(crate) fn api(self) -> Option<Api> {
        match self {
            Self::Cpu => None,
            Self::Wgpu => Some(Api::Wgpu),
            Self::Ash => Some(Api::Ash),
        }
    }
}

impl Method {
    /// The interface that it is, if a GPU finds the contours.
    pub(crate) fn api(self) -> Option<Api> {
        match self {
            Self::BruteForce | Self::Patches => None,
            Self::Wgpu => Some(Api::Wgpu),
            Self::Ash => Some(Api::Ash),
        }
    }
}
