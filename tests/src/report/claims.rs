//! What is claimed of patches, held against what was measured.

use super::paper::TB24_TESTED_SHARE;
use super::tables::count;
use super::{Decomposition, Report};

/// A claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// What is claimed.
    pub what: String,
    /// The numbers.
    pub measured: String,
    /// Whether it is so.
    pub holds: bool,
    /// Why it may not be so.
    pub why: &'static str,
}

/// Names of decompositions that claims are about.
pub const OURS: &str = "patches, DEFAULT";
/// Patches of patches.
pub const TWO_LEVELS: &str = "patches, two levels";
/// Spatialized normal cone hierarchy, with as many edges in a leaf as make its cost least.
pub const SNCH: &str = "SNCH";
/// The same down to single edges.
pub const SNCH_SINGLE: &str = "SNCH, an edge in a leaf";
/// Anchored-cone forest.
pub const CONES: &str = "anchored cones";
/// Meshlets.
pub const MESHLETS: &str = "meshlets";

/// On the bunny, if it was measured: per view, mean of the 252 viewpoints.
pub fn claims(report: &Report) -> Vec<Claim> {
    let Some(bunny) = report.mesh("stanford-bunny") else { return Vec::new() };
    let Some(ours) = bunny.decomposition(OURS) else { return Vec::new() };
    let our_edges = ours.tested.far.edges.mean;
    let mut claims = vec![Claim {
        what: "patches test fewer edges than the 16 % of TB24".to_owned(),
        measured: format!("{:.1} %", 100.0 * our_edges / bunny.edges as f64),
        holds: our_edges < TB24_TESTED_SHARE * bunny.edges as f64,
        why: "",
    }];
    for name in [SNCH, SNCH_SINGLE] {
        claims.extend(bunny.decomposition(name).into_iter().flat_map(|snch| hierarchy(ours, snch)));
    }
    claims.extend([(OURS, CONES), (TWO_LEVELS, CONES), (OURS, MESHLETS)].into_iter().filter_map(
        |(ours, theirs)| {
            Some(fewer_edges(bunny.decomposition(ours)?, bunny.decomposition(theirs)?))
        },
    ));
    claims
}

fn hierarchy(ours: &Decomposition, snch: &Decomposition) -> [Claim; 2] {
    let name = &snch.name;
    let (ours, theirs) = (&ours.tested.far, &snch.tested.far);
    [
        Claim {
            what: format!("{name} tests at least twice the edges that patches do"),
            measured: format!("{} and {}", count(theirs.edges.mean), count(ours.edges.mean)),
            holds: theirs.edges.mean >= 2.0 * ours.edges.mean,
            why: "Down to the single edge, a leaf's bound is as tight as can be: what that saves in edges \
                  costs more in nodes, as the cost says.",
        },
        Claim {
            what: format!("{name} visits more nodes than patches are tested"),
            measured: format!("{} and {}", count(theirs.bounds.mean), count(ours.bounds.mean)),
            holds: theirs.bounds.mean > ours.bounds.mean,
            why: "",
        },
    ]
}

fn fewer_edges(ours: &Decomposition, theirs: &Decomposition) -> Claim {
    let [our_edges, their_edges] = [ours, theirs].map(|each| each.tested.far.edges.mean);
    let costs = [ours, theirs].map(|each| count(each.tested.far.cost()));
    Claim {
        what: format!("{} test fewer edges than {}", ours.name, theirs.name),
        measured: format!(
            "{} and {}, at costs of {} and {}",
            count(our_edges),
            count(their_edges),
            costs[0],
            costs[1]
        ),
        holds: our_edges < their_edges,
        why: "A forest has more levels, so that its lowest nodes are smaller; patches on one level are \
              those that a GPU tests in one pass.",
    }
}
