//! Cuts the work of a rig's frame into dispatches that a device allows.

use super::layout::{RigLayout, count};
use crate::plan::{ROUNDS, Tiles};
use crate::{Chunk, Method, Plan, PlanLimits, Stage, Work};

/// What a dispatch does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigStep {
    /// Poses vertices.
    Vertices,
    /// Finds the sides of faces, after all vertices are posed.
    Faces,
    /// Tests loose edges, after the sides of all faces are found.
    LooseEdges,
    /// Finds contours of the rigid parts of a class.
    Parts {
        /// Index of the class.
        class: usize,
        /// What it begins with.
        stage: Stage,
        /// The chunk of the class.
        chunk: usize,
    },
}

/// One dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigDispatch {
    /// What it does.
    pub step: RigStep,
    /// Its work.
    pub work: Work,
    /// Workgroups along x and y.
    pub grid: [u32; 2],
}

/// What is to be done for `instances` of a rig.
#[derive(Clone, Copy, Debug)]
pub struct RigPlan<'a> {
    /// How the rig is laid out.
    pub layout: &'a RigLayout,
    /// The pieces of each class.
    pub classes: &'a [Vec<Chunk>],
    /// Number of loose edges.
    pub loose_edges: u32,
    /// How contour edges of rigid parts are found.
    pub method: Method,
    /// Number of instances.
    pub instances: u32,
    /// Instances that there is room for.
    pub most_instances: u32,
    /// Segments that fit the output.
    pub segment_capacity: u32,
    /// What bounds a dispatch.
    pub limits: PlanLimits,
}

impl RigPlan<'_> {
    /// Hands its dispatches to `visit`, in order.
    pub fn dispatches(&self, visit: &mut impl FnMut(RigDispatch)) {
        let counts = self.layout.counts;
        let width = self.limits.width;
        if self.loose_edges > 0 || counts.bending_count > 0 {
            self.cut_loose(RigStep::Vertices, counts.vertex_count, width, visit);
        }
        if self.loose_edges > 0 {
            self.cut_loose(RigStep::Faces, counts.face_count, width, visit);
            self.cut_loose(RigStep::LooseEdges, self.loose_edges, width * ROUNDS[0], visit);
        }
        for (class, (layout, chunks)) in self.layout.classes.iter().zip(self.classes).enumerate() {
            let plan = Plan {
                chunks,
                part_count: count(layout.shapes.len()),
                method: self.method,
                instances: self.instances * layout.copies,
                segment_capacity: self.segment_capacity,
                limits: self.limits,
            };
            plan.dispatches(&mut |dispatch| {
                let step = RigStep::Parts { class, stage: dispatch.stage, chunk: dispatch.chunk };
                let work = Work {
                    first_placement: layout.placements_before * self.most_instances,
                    most_instances: self.most_instances,
                    ..dispatch.work
                };
                visit(RigDispatch { step, work, grid: dispatch.grid });
            });
        }
    }

    /// Most dispatches that fewer instances or other shares could need: with the least for a workgroup.
    pub fn most_dispatches(&self) -> usize {
        let mut count = 0;
        let limits = PlanLimits { width: 1, ..self.limits };
        Self { limits, instances: self.most_instances, ..*self }.dispatches(&mut |_| count += 1);
        count
    }

    fn cut_loose(
        &self,
        step: RigStep,
        items: u32,
        share: u32,
        visit: &mut impl FnMut(RigDispatch),
    ) {
        let tiles = Tiles {
            limits: self.limits,
            items: [0, items],
            share,
            instances: self.instances,
            most_instances: self.limits.edges / items.max(1),
        };
        tiles.cut(&mut |work, grid| {
            let work = Work {
                part_count: 1,
                segment_capacity: self.segment_capacity,
                first_placement: self.layout.part_count() * self.most_instances,
                most_instances: self.most_instances,
                ..work
            };
            visit(RigDispatch { step, work, grid });
        });
    }
}
