//! What an animation moves, and when.

use super::Curve;

/// Curves that move nodes and weights together.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// As the file names it, else "animation 0".
    pub name: String,
    /// What it moves. Of two that move the same, the later one wins.
    pub channels: Vec<Channel>,
}

impl Animation {
    /// Time of the last key of any curve, in seconds; at least 0.
    pub fn duration(&self) -> f64 {
        self.channels.iter().map(|channel| channel.curve.end()).fold(0.0, f64::max)
    }
}

/// One property of one node over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index of the node.
    pub node: u32,
    /// What of it.
    pub property: Property,
    /// Of the width that the property has.
    pub curve: Curve,
}

/// What of a node an animation moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Three numbers, in the parent's units.
    Translation,
    /// A quaternion: x, y, z, w.
    Rotation,
    /// Three factors along the node's axes.
    Scale,
    /// A weight for each morph target of the node's mesh.
    Weights,
}
