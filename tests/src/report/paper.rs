//! What the papers report, to stand beside what is measured here.

/// A figure of a paper.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figure {
    pub(crate) mesh: &'static str,
    pub(crate) what: &'static str,
    pub(crate) value: &'static str,
    pub(crate) source: &'static str,
    /// How it was measured otherwise than here.
    pub(crate) differs: &'static str,
}

/// Share of the edges of its bunny that TB24 tests, mean of the 252 viewpoints.
pub(crate) const TB24_TESTED_SHARE: f64 = 0.16;

/// Those of the papers that this report can be held against.
pub(crate) const FIGURES: &[Figure] = &[
    Figure {
        mesh: "stanford-bunny",
        what: "edges that the convex filter keeps",
        value: "61,914",
        source: "TB24",
        differs: "the filter is exact here, on positions in f32",
    },
    Figure {
        mesh: "stanford-bunny",
        what: "patches",
        value: "3,584",
        source: "TB24, Figure 1",
        differs: "its c_max there is not stated",
    },
    Figure {
        mesh: "stanford-bunny",
        what: "edges tested, share of all",
        value: "16 %",
        source: "TB24",
        differs: "same viewpoints; scaled to [-1, 1] here, which the paper does not say",
    },
    Figure {
        mesh: "stanford-bunny",
        what: "seconds to build, c_max 4,096",
        value: "168",
        source: "TB24",
        differs: "its own program and machine; here, candidates that cannot win are not evaluated",
    },
    Figure {
        mesh: "stanford-bunny",
        what: "t_P / t_e",
        value: "1.363",
        source: "TB24 §4.2",
        differs: "edges are tested there without exact predicates",
    },
    Figure {
        mesh: "stanford-bunny",
        what: "nodes tested, edges tested and silhouette edges of 104,511, anchored cones",
        value: "4,282, 10,256 and 3,461",
        source: "S00, Table 2",
        differs: "other viewpoints, and all edges, which is the table \"all edges\" here",
    },
    Figure {
        mesh: "stanford-bunny",
        what: "times as fast as brute force, GTX 1080",
        value: "5.4",
        source: "TB24 §4.3",
        differs: "the GPU, where there is one; its shaders",
    },
    Figure {
        mesh: "dragon_vrip",
        what: "times as fast as brute force, GTX 1080",
        value: "2.8",
        source: "TB24 §4.3",
        differs: "the GPU, where there is one; its shaders",
    },
    Figure {
        mesh: "dragon_vrip",
        what: "edges that the convex filter keeps",
        value: "750,922",
        source: "TB24",
        differs: "vertices at one position are welded here",
    },
];
