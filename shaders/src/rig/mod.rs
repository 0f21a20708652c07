//! Rigs: models whose vertices are carried by joints and other spaces that move.

mod content;
mod input;
mod layout;
mod margin;
mod plan;
mod twin;

pub use content::RigContent;
pub use input::{PoseError, RigInput, RigInstance};
pub use layout::{
    BendingFace, CarrierTransform, ClassLayout, LooseEdge, MorphOffset, PartFace, RigCounts,
    RigLayout, VertexInfluence,
};
pub use plan::{RigDispatch, RigPlan, RigStep};
