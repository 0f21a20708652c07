//! Work is cut so that each edge, patch or block of each instance is done once, within the limits.

#![allow(clippy::cast_possible_truncation, reason = "the meshes are small")]

use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, Levels, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, shapes};
use drypoint_shaders::{
    BLOCK_PATCHES, Chunk, Content, Culling, Draw, DrawLimits, DrawPlan, MAX_GROUP, MAX_PIECE,
    MeshShape, Method, Plan, PlanLimits, Stage, WIDTHS,
};

const SHAPE: MeshShape =
    MeshShape { task_width: 8, mesh_width: 8, edges_per_workgroup: 16, records: false };

/// A model of two parts, in chunks of few edges.
fn content(levels: Levels) -> Content {
    let params = FusionParams { levels, ..FusionParams::FAST };
    let sets = [shapes::torus_knot(3_000), shapes::bumpy_sphere(1_000)].map(|mesh| {
        let adjacency = MeshAdjacency::new(&mesh);
        let go_on = |_| ControlFlow::Continue(());
        fuse(&mesh, &adjacency, EdgeFilter::All, &params, &go_on).expect("nothing stops it")
    });
    Content::new(&sets.each_ref())
}

/// Which items of which instance each draw does, lane by lane, as shaders number them.
fn done(draw: &Draw) -> Vec<[u32; 2]> {
    let work = &draw.work;
    let lanes = draw.grid[0] * draw.grid[1] * work.items_per_workgroup;
    let items = (0..lanes).filter(|item| *item < work.item_count * work.instance_count);
    items
        .map(|i| [work.first_item + i % work.item_count, work.first_instance + i / work.item_count])
        .collect()
}

/// What there is to do in a chunk by one kind of draws: items of each instance.
fn wanted(chunk: &Chunk, culling: Culling, part: u32) -> std::ops::Range<u32> {
    match culling {
        Culling::Nothing => {
            chunk.parts.iter().find(|(p, _)| *p == part).expect("it is of the chunk").1.clone()
        }
        Culling::Patches => 0..chunk.patches.len() as u32,
        Culling::SuperPatches => 0..chunk.blocks(BLOCK_PATCHES).len() as u32 - 1,
    }
}

#[test]
fn each_item_of_each_instance_is_done_once() {
    for levels in [Levels::One, Levels::Two] {
        let content = content(levels);
        let chunks = content.chunks(4 * MAX_PIECE, MAX_PIECE);
        assert!(chunks.len() > 4, "there are several");
        let blocks: Vec<u32> = chunks
            .iter()
            .map(|chunk| (chunk.blocks(BLOCK_PATCHES).len() as u32).saturating_sub(1))
            .collect();
        for method in [Method::BruteForce, Method::Patches] {
            for [row, workgroups, edges] in
                [[3, 7, 1 << 28], [2, 4, 1 << 28], [100, 1_000, 3_000], [65_535, 1 << 22, 1 << 28]]
            {
                let limits = DrawLimits { shape: SHAPE, row, workgroups, edges };
                let plan = DrawPlan {
                    chunks: &chunks,
                    block_counts: &blocks,
                    part_count: 2,
                    method,
                    instances: 5,
                    segment_capacity: 0,
                    limits,
                };
                check(&plan, &format!("{levels:?}, {method:?}, {limits:?}"));
            }
        }
    }
}

fn check(plan: &DrawPlan<'_>, what: &str) {
    let limits = plan.limits;
    let mut draws = Vec::new();
    plan.draws(&mut |draw| draws.push(draw));
    assert_eq!(draws.len(), plan.count(), "{what}");
    for instances in 0..plan.instances {
        assert!(DrawPlan { instances, ..*plan }.count() <= plan.count(), "{what}");
    }
    let mut expected = Vec::new();
    let mut found = Vec::new();
    for draw in &draws {
        let [x, y] = draw.grid;
        assert_eq!(draw.work.row, x, "{what}: workgroups are numbered by it");
        assert!(
            x <= limits.row && y <= limits.row && x * y <= limits.workgroups,
            "{what}: {x}, {y}"
        );
        if draw.culling == Culling::Nothing {
            // A mesh workgroup without an edge would be there for nothing.
            let edges = draw.work.item_count * draw.work.instance_count;
            assert_eq!(x * y, edges.div_ceil(SHAPE.edges_per_workgroup), "{what}");
        }
        let key = |[item, instance]: [u32; 2]| (draw.chunk, draw.work.part, item, instance);
        found.extend(done(draw).into_iter().map(key));
    }
    let kinds: std::collections::BTreeSet<_> =
        draws.iter().map(|draw| (draw.chunk, draw.work.part)).collect();
    for (chunk, part) in kinds {
        let culling = draws.iter().find(|draw| draw.chunk == chunk).expect("it is there").culling;
        for item in wanted(&plan.chunks[chunk], culling, part) {
            expected.extend((0..plan.instances).map(|instance| (chunk, part, item, instance)));
        }
    }
    found.sort_unstable();
    expected.sort_unstable();
    assert!(found == expected, "{what}");
    assert_eq!(
        draws.iter().map(|draw| draw.chunk).collect::<std::collections::BTreeSet<_>>().len(),
        plan.chunks.len(),
        "{what}: all chunks"
    );
}

/// The same of dispatches, for every width and few or many instances.
#[test]
fn each_item_of_each_instance_is_dispatched_once() {
    for levels in [Levels::One, Levels::Two] {
        let content = content(levels);
        let chunks = content.chunks(4 * MAX_PIECE, MAX_PIECE);
        for method in [Method::BruteForce, Method::Patches] {
            for width in WIDTHS {
                for (row, edges, instances) in
                    [(3, 1 << 28, 5), (65_535, 1 << 28, 1), (65_535, 1 << 28, 40), (100, 3_000, 40)]
                {
                    let limits = PlanLimits { width, row, edges };
                    let plan = Plan {
                        chunks: &chunks,
                        part_count: 2,
                        method,
                        instances,
                        segment_capacity: 0,
                        limits,
                    };
                    check_dispatches(&plan, &format!("{levels:?}, {method:?}, {limits:?}"));
                }
            }
        }
    }
}

fn check_dispatches(plan: &Plan<'_>, what: &str) {
    let PlanLimits { width, row, .. } = plan.limits;
    let mut found = Vec::new();
    let mut count = 0;
    plan.dispatches(&mut |dispatch| {
        count += 1;
        let (work, [x, y]) = (&dispatch.work, dispatch.grid);
        assert!(x <= row && y <= row, "{what}: {x}, {y}");
        assert_eq!(work.row, x, "{what}: workgroups are numbered by it");
        let is_one_round = work.items_per_workgroup <= width;
        assert!(dispatch.stage == Stage::Edges || is_one_round, "{what}: one item a lane");
        let share = work.items_per_workgroup;
        let blocks = work.item_count.div_ceil(share);
        for number in (0..x * y).filter(|number| *number < blocks * work.instance_count) {
            let first = number % blocks * share;
            let items = first..(first + share).min(work.item_count);
            let instance = work.first_instance + number / blocks;
            let key = |item| (dispatch.chunk, work.part, work.first_item + item, instance);
            found.extend(items.map(key));
        }
    });
    assert!(count <= plan.most_dispatches(), "{what}: {count} dispatches");
    let mut expected = Vec::new();
    for (index, chunk) in plan.chunks.iter().enumerate() {
        let mut expect = |part: u32, items: std::ops::Range<u32>| {
            let of = |instance| items.clone().map(move |item| (index, part, item, instance));
            expected.extend((0..plan.instances).flat_map(of));
        };
        match plan.method {
            Method::BruteForce => {
                chunk.parts.iter().for_each(|(part, edges)| expect(*part, edges.clone()));
            }
            Method::Patches if chunk.super_patches.is_empty() => {
                expect(0, 0..chunk.patches.len() as u32);
            }
            Method::Patches => expect(0, 0..chunk.super_patches.len() as u32),
        }
    }
    found.sort_unstable();
    expected.sort_unstable();
    assert!(found == expected, "{what}");
}

#[test]
fn blocks_hold_every_super_patch_once_and_fit_the_payload() {
    let content = content(Levels::Two);
    assert!(content.super_patches.iter().all(|group| (1..=MAX_GROUP).contains(&group.count)));
    for chunk in content.chunks(1 << 20, 1 << 20) {
        for most in [MAX_GROUP, BLOCK_PATCHES] {
            let blocks = chunk.blocks(most);
            assert_eq!(blocks.first(), Some(&0));
            assert_eq!(blocks.last(), Some(&(chunk.super_patches.len() as u32)));
            for block in blocks.windows(2) {
                let groups = &chunk.super_patches[block[0] as usize..block[1] as usize];
                assert!(!groups.is_empty());
                assert!(groups.iter().map(|group| group.count).sum::<u32>() <= most);
            }
        }
    }
}

#[test]
fn contents_that_refer_to_what_is_not_there_are_told() {
    let good = content(Levels::Two);
    assert_eq!(good.check(), Ok(()));
    let broken = |breaking: &dyn Fn(&mut Content)| {
        let mut content = good.clone();
        breaking(&mut content);
        content.check()
    };
    let vertices = good.positions.len() as u32;
    let edges = good.edge_count();
    assert_eq!(broken(&|c| c.ends[7].to_vertex = vertices), Err("vertices"));
    assert_eq!(broken(&|c| c.ends.truncate(9)), Err("planes or ends of edges"));
    assert_eq!(broken(&|c| c.parts[1].end = edges + 1), Err("edges"));
    assert_eq!(broken(&|c| c.frames.truncate(1)), Err("parts"));
    assert_eq!(broken(&|c| c.patches.last_mut().unwrap().count += 1), Err("edges of patches"));
    assert_eq!(broken(&|c| c.patches[0].count = 0), Err("pieces of patches"));
    assert_eq!(broken(&|c| c.patches[0].part = 2), Err("parts of patches"));
    assert_eq!(
        broken(&|c| c.super_patches[0].count = MAX_GROUP + 1),
        Err("pieces of super-patches")
    );
    let patches = good.patches.len() as u32;
    let broke = broken(&|c| c.super_patches.last_mut().unwrap().first = patches);
    assert_eq!(broke, Err("patches of super-patches"));
}
