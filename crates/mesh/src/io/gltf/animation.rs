//! Animations of nodes.

use ::gltf::json;
use ::gltf::json::accessor::Type;
use ::gltf::json::validation::Checked::Valid;

use super::accessor::Elements;
use super::document::{Document, object};
use crate::io::error::{Fault, Place, ReadError};
use crate::rig::{Animation, Channel, Curve, Interpolation, Property};

/// All animations of a document, with the channels that move what is there: extensions may name other
/// targets. `morph_count` says how many morph targets the mesh of a node has.
pub(super) fn animations(
    document: &Document<'_>,
    morph_count: impl Fn(usize) -> usize,
) -> Result<Vec<Animation>, ReadError> {
    let mut animations = Vec::with_capacity(document.root.animations.len());
    for (index, json) in document.root.animations.iter().enumerate() {
        let mut channels = Vec::with_capacity(json.channels.len());
        for (number, channel) in json.channels.iter().enumerate() {
            let place = Place::Json(format!("animations[{index}].channels[{number}]"));
            let node = channel.target.node.value();
            object(&document.root.nodes, node, "nodes", &place)?;
            let Some((property, width)) = property(channel, morph_count(node)) else { continue };
            let sampler = object(&json.samplers, channel.sampler.value(), "samplers", &place)?;
            let place =
                Place::Json(format!("animations[{index}].samplers[{}]", channel.sampler.value()));
            let curve = curve(document, sampler, (property, width), &place)?;
            channels.push(Channel {
                node: u32::try_from(node).unwrap_or(u32::MAX),
                property,
                curve,
            });
        }
        let name = json.name.clone().unwrap_or_else(|| format!("animation {index}"));
        animations.push(Animation { name, channels });
    }
    Ok(animations)
}

/// What a channel moves, and of how many numbers that is. `None` if it moves nothing that is known.
fn property(channel: &json::animation::Channel, morphs: usize) -> Option<(Property, usize)> {
    use json::animation::Property::{MorphTargetWeights, Rotation, Scale, Translation};
    match channel.target.path {
        Valid(Translation) => Some((Property::Translation, 3)),
        Valid(Rotation) => Some((Property::Rotation, 4)),
        Valid(Scale) => Some((Property::Scale, 3)),
        Valid(MorphTargetWeights) if morphs > 0 => Some((Property::Weights, morphs)),
        _ => None,
    }
}

fn curve(
    document: &Document<'_>,
    sampler: &json::animation::Sampler,
    (property, width): (Property, usize),
    place: &Place,
) -> Result<Curve, ReadError> {
    let Valid(interpolation) = sampler.interpolation else {
        return Err(Fault::WrongType { expected: "a known interpolation" }.at(place.clone()));
    };
    let interpolation = match interpolation {
        json::animation::Interpolation::Step => Interpolation::Step,
        json::animation::Interpolation::Linear => Interpolation::Linear,
        json::animation::Interpolation::CubicSpline => Interpolation::CubicSpline,
    };
    let times = Elements::times(document, sampler.input.value(), place)?;
    let shape = match property {
        Property::Rotation => Type::Vec4,
        Property::Translation | Property::Scale => Type::Vec3,
        Property::Weights => Type::Scalar,
    };
    let values = Elements::curve_values(document, sampler.output.value(), shape, place)?;
    let components = shape.multiplicity();
    document
        .spend(8 * (times.count() + components * values.count()) as u64)
        .map_err(|fault| fault.at(place.clone()))?;
    let numbers = |elements: &Elements<'_>, components: usize| -> Vec<f64> {
        let of_element = |i| (0..components).map(move |component| (i, component));
        let each = (0..elements.count()).flat_map(of_element);
        each.map(|(i, component)| elements.real(i, component)).collect()
    };
    Curve::new(numbers(&times, 1), numbers(&values, components), width, interpolation)
        .map_err(|error| Fault::Curve { error }.at(place.clone()))
}
