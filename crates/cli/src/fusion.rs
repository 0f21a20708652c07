//! The options that say how patches are built, and the one table from options to parameters.

use drypoint_fusion::{
    BoundKind, CostModel, FusionParams, Levels, Method, SphereKind, VIEW_DISTANCES, ViewProfile,
};

use clap::{Args, ValueEnum};

/// How patches are built.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Patches")]
pub(crate) struct FusionArgs {
    /// How long to look for good patches [default: default]
    #[arg(long, value_enum)]
    pub(crate) preset: Option<Preset>,
    /// For whom: far (from 5 to 75), near (from 1 to 10), paper (10) or any one distance, between
    /// viewpoint and patch, in units of half the model's longest side
    /// [default: far; paper with --preset paper]
    #[arg(long, value_name = "PROFILE", value_parser = profile, allow_hyphen_values = true)]
    pub(crate) profile: Option<Profile>,
    /// What bounds the faces of a patch [default: tight; reduced with --preset paper]
    #[arg(long, value_enum)]
    pub(crate) bound: Option<Bound>,
    /// 2 groups the patches once more, for large models [default: 1]
    #[arg(long, value_name = "1|2", value_parser = levels, allow_hyphen_values = true)]
    pub(crate) levels: Option<Levels>,
    /// Who will test the patches: what a test costs there, and how many edges at a time
    /// [default: paper]
    #[arg(long, value_enum)]
    pub(crate) runtime: Option<Runtime>,
    /// With --preset paper: most edges that are fused as one group, more is slower and better;
    /// none for all at once [default: 4096]
    #[arg(long, value_name = "EDGES|none", value_parser = partition)]
    pub(crate) partition: Option<Partition>,
}

/// How long the search takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Preset {
    /// Short enough to build patches whenever a model is loaded
    Fast,
    /// Built once, viewed often
    #[default]
    Default,
    /// For a model that is shipped: the last percent takes most of the time
    Best,
    /// The published method (Tsiapkolis and Bénard 2024), for comparison: slow
    Paper,
}

impl Preset {
    fn params(self) -> FusionParams {
        match self {
            Self::Fast => FusionParams::FAST,
            Self::Default => FusionParams::DEFAULT,
            Self::Best => FusionParams::BEST,
            Self::Paper => FusionParams::PAPER,
        }
    }
}

/// What bounds a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Bound {
    /// Cone around the mean normal, sphere around the mean of the vertices
    Mean,
    /// Cone around the mean normal, sphere that touches the lines of the edges
    Reduced,
    /// Narrowest cone, smallest sphere that touches the lines of the edges
    Minimal,
    /// Narrowest cone, fitted to the planes of the faces: culls most
    Tight,
}

impl From<Bound> for BoundKind {
    fn from(bound: Bound) -> Self {
        match bound {
            Bound::Mean => Self::Mean,
            Bound::Reduced => Self::Reduced,
            Bound::Minimal => Self::Minimal,
            Bound::Tight => Self::Tight,
        }
    }
}

/// Who tests the patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Runtime {
    /// The graphics card of Tsiapkolis and Bénard 2024, edge by edge
    Paper,
    /// A processor, edge by edge
    CpuScalar,
    /// A processor, 16 edges at a time
    CpuSimd,
    /// A GPU's compute shaders, edge by edge
    Gpu,
    /// A mesh shader: at most 64 vertices and 126 edges a patch
    MeshShader,
}

impl From<Runtime> for CostModel {
    fn from(runtime: Runtime) -> Self {
        match runtime {
            Runtime::Paper => Self::PAPER,
            Runtime::CpuScalar => Self::CPU_SCALAR,
            Runtime::CpuSimd => Self::CPU_SIMD,
            Runtime::Gpu => Self::GPU,
            Runtime::MeshShader => Self::MESH_SHADER,
        }
    }
}

/// From how far away the model is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Profile {
    Far,
    Near,
    Paper,
    At(f64),
}

impl From<Profile> for ViewProfile {
    fn from(profile: Profile) -> Self {
        match profile {
            Profile::Far => Self::FAR,
            Profile::Near => Self::NEAR,
            Profile::Paper => Self::PAPER,
            Profile::At(distance) => Self::at(distance),
        }
    }
}

/// Most edges fused as one group; `None` for no limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Partition(pub(crate) Option<u32>);

impl FusionArgs {
    /// The first option that was given, if any: where nothing is built none may be.
    pub(crate) fn first_given(&self) -> Option<&'static str> {
        let given = [
            (self.preset.is_some(), "--preset"),
            (self.profile.is_some(), "--profile"),
            (self.bound.is_some(), "--bound"),
            (self.levels.is_some(), "--levels"),
            (self.runtime.is_some(), "--runtime"),
            (self.partition.is_some(), "--partition"),
        ];
        given.into_iter().find_map(|(given, name)| given.then_some(name))
    }

    /// What the options ask for, or which of them contradict each other.
    pub(crate) fn params(&self) -> Result<FusionParams, String> {
        let preset = self.preset.unwrap_or_default();
        let mut params = preset.params();
        if let Some(profile) = self.profile {
            params.views = profile.into();
        }
        if let Some(levels) = self.levels {
            params.levels = levels;
        }
        if let Some(runtime) = self.runtime {
            params.cost = runtime.into();
        }
        if let Some(bound) = self.bound {
            params.bound = bound.into();
        }
        if preset != Preset::Paper {
            return match self.partition {
                None => Ok(params),
                Some(_) => Err("--partition: only --preset paper cuts a model into parts".into()),
            };
        }
        if self.runtime.is_some_and(|runtime| runtime != Runtime::Paper) {
            return Err("--runtime: the method of --preset paper knows its own cost only".into());
        }
        if let (Some(Bound::Mean), Method::Greedy { cache_size, max_partition, .. }) =
            (self.bound, params.method)
        {
            params.method = Method::Greedy { sphere: SphereKind::Mean, cache_size, max_partition };
        }
        Ok(self.partition.map_or(params, |most| params.with_max_partition(most.0)))
    }

    /// Name of the preset, as it is typed.
    pub(crate) fn preset_name(&self) -> String {
        name_of(self.preset.unwrap_or_default())
    }
}

/// Name of a profile, as it is typed; of one that has no name, its distances.
pub(crate) fn profile_name(preset: &str, views: &ViewProfile) -> String {
    let paper = ("paper", ViewProfile::PAPER);
    let named = [("far", ViewProfile::FAR), ("near", ViewProfile::NEAR), paper];
    // Where two names mean the same, the paper's is for the paper's method.
    let of_paper = (preset == "paper").then_some(paper);
    if let Some((name, _)) = of_paper.into_iter().chain(named).find(|(_, known)| known == views) {
        return name.to_owned();
    }
    let taken = (0..VIEW_DISTANCES).filter(|&i| views.weights[i] != 0.0);
    taken.map(|i| views.distances[i].to_string()).collect::<Vec<_>>().join(",")
}

/// Name of a bound, as it is typed.
pub(crate) fn bound_name(bound: BoundKind) -> String {
    let known = Bound::value_variants().iter().find(|&&known| BoundKind::from(known) == bound);
    known.map(|&bound| name_of(bound)).unwrap_or_default()
}

/// Name of a runtime, as it is typed; `custom` if it has none.
pub(crate) fn runtime_name(cost: &CostModel) -> String {
    let known = Runtime::value_variants().iter().find(|&&known| CostModel::from(known) == *cost);
    known.map_or_else(|| "custom".to_owned(), |&runtime| name_of(runtime))
}

fn name_of(value: impl ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

fn profile(text: &str) -> Result<Profile, String> {
    match (text, text.parse::<f64>()) {
        ("far", _) => Ok(Profile::Far),
        ("near", _) => Ok(Profile::Near),
        ("paper", _) => Ok(Profile::Paper),
        (_, Ok(distance)) if distance.is_finite() && distance > 0.0 => Ok(Profile::At(distance)),
        _ => Err("far, near, paper or a distance above 0 is wanted".to_owned()),
    }
}

fn levels(text: &str) -> Result<Levels, String> {
    match text {
        "1" => Ok(Levels::One),
        "2" => Ok(Levels::Two),
        _ => Err("there are 1 or 2 levels".to_owned()),
    }
}

fn partition(text: &str) -> Result<Partition, String> {
    match text.parse() {
        _ if text == "none" => Ok(Partition(None)),
        Ok(edges) if edges >= 2 => Ok(Partition(Some(edges))),
        _ => Err("a number of edges from 2, or none, is wanted".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(args: FusionArgs, expected: Result<FusionParams, &str>) {
        match (args.params(), expected) {
            (Ok(found), Ok(expected)) => assert_eq!(found, expected),
            (Err(found), Err(word)) => assert!(found.starts_with(word), "{found}"),
            (found, expected) => panic!("{found:?} is not {expected:?}"),
        }
    }

    #[test]
    fn options_become_parameters() {
        let none = FusionArgs::default();
        let paper = FusionArgs { preset: Some(Preset::Paper), ..none.clone() };
        check(none.clone(), Ok(FusionParams::DEFAULT));
        check(paper.clone(), Ok(FusionParams::PAPER));
        check(
            FusionArgs { bound: Some(Bound::Mean), ..paper.clone() },
            Ok(FusionParams::PAPER_MEAN),
        );
        check(
            FusionArgs { partition: Some(Partition(None)), ..paper.clone() },
            Ok(FusionParams::PAPER.with_max_partition(None)),
        );
        check(
            FusionArgs {
                profile: Some(Profile::Near),
                levels: Some(Levels::Two),
                runtime: Some(Runtime::MeshShader),
                bound: Some(Bound::Minimal),
                ..none.clone()
            },
            Ok(FusionParams {
                views: ViewProfile::NEAR,
                levels: Levels::Two,
                cost: CostModel::MESH_SHADER,
                bound: BoundKind::Minimal,
                ..FusionParams::DEFAULT
            }),
        );
        check(FusionArgs { partition: Some(Partition(None)), ..none }, Err("--partition"));
        check(FusionArgs { runtime: Some(Runtime::Gpu), ..paper }, Err("--runtime"));
    }

    #[test]
    fn help_tells_the_defaults() {
        let (default, paper) = (FusionParams::DEFAULT, FusionParams::PAPER);
        assert_eq!(profile_name("default", &default.views), "far");
        assert_eq!(profile_name("paper", &paper.views), "paper");
        assert_eq!((default.bound, paper.bound), (BoundKind::Tight, BoundKind::Reduced));
        assert_eq!((default.levels, default.cost), (Levels::One, CostModel::PAPER));
    }

    #[test]
    fn values_have_their_names() {
        for bound in Bound::value_variants() {
            assert_eq!(bound_name((*bound).into()), name_of(*bound));
        }
        for runtime in Runtime::value_variants() {
            assert_eq!(runtime_name(&(*runtime).into()), name_of(*runtime));
        }
        assert_eq!(profile_name("fast", &ViewProfile::at(2.5)), "2.5");
        assert_eq!(profile_name("fast", &ViewProfile::NEAR), "near");
        assert_eq!([profile("2"), profile("near")], [Ok(Profile::At(2.0)), Ok(Profile::Near)]);
        for wrong in ["0", "-1", "inf", "NaN", "nearly"] {
            assert!(profile(wrong).is_err(), "{wrong}");
        }
    }
}
