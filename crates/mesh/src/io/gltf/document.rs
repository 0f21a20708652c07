//! The JSON of a file and the bytes that it describes.

use std::borrow::Cow;
use std::cell::Cell;
use std::fs;
use std::path::Path;

use ::gltf::json;
use ::gltf::{Glb, binary};
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

use crate::io::error::{Fault, Place, ReadError};

/// Extensions that a file may require and that change nothing of what is drawn here, by how their
/// names begin.
const HARMLESS: [&str; 9] = [
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_mesh_quantization",
    "KHR_animation_",
    "KHR_xmp",
    "EXT_texture_",
    "EXT_lights_",
    "MSFT_texture_",
];

/// What reading may cost whatever the file, in units of a few bytes or nanoseconds: 67 million triangles,
/// say, of places of one mesh. What names the same data again and again would else need any memory.
const ALLOWANCE: u64 = 1 << 30;

/// What it may cost for each byte of the document and its buffers. Data that is used once needs up to 24
/// units, for triangles of strips by single bytes on vertices that follow joints.
const ALLOWANCE_PER_BYTE: u64 = 64;

/// A glTF document and its buffers.
#[derive(Debug)]
pub(super) struct Document<'a> {
    pub(super) root: json::Root,
    /// Each at least as long as it says.
    pub(super) buffers: Vec<Cow<'a, [u8]>>,
    /// Of the document and its buffers.
    bytes: u64,
    /// What reading may still cost.
    pub(super) allowance: Cell<u64>,
}

impl<'a> Document<'a> {
    pub(super) fn parse(bytes: &'a [u8], folder: Option<&Path>) -> Result<Self, ReadError> {
        let (text, blob) = split(bytes)?;
        let root = root(&text)?;
        let harmless = |name: &&String| !HARMLESS.iter().any(|known| name.starts_with(known));
        if let Some(name) = root.extensions_required.iter().find(harmless) {
            return Err(ReadError::RequiredExtension { name: name.clone() });
        }
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            let bytes = match (&buffer.uri, &blob) {
                (Some(uri), _) => external(uri, folder).map(Cow::Owned),
                (None, Some(blob)) if index == 0 => Ok(blob.clone()),
                (None, _) => Err(Fault::Missing { missing: "uri and no data in this file" }),
            };
            let place = || Place::Json(format!("buffers[{index}]"));
            let bytes = bytes.map_err(|fault| fault.at(place()))?;
            let (needed, available) = (buffer.byte_length.0, bytes.len() as u64);
            if needed > available {
                return Err(Fault::TooShort { needed, available }.at(place()));
            }
            buffers.push(bytes);
        }
        let bytes = buffers.iter().map(|buffer| buffer.len() as u64).sum::<u64>();
        let bytes = bytes + text.len() as u64;
        let allowance = Cell::new(ALLOWANCE.max(ALLOWANCE_PER_BYTE.saturating_mul(bytes)));
        Ok(Self { root, buffers, bytes, allowance })
    }

    /// Takes what something costs, in units of a few bytes or nanoseconds, from what reading may cost.
    ///
    /// # Errors
    /// That was too much: something is used too often.
    pub(super) fn spend(&self, units: u64) -> Result<(), Fault> {
        let left = self.allowance.get().checked_sub(units);
        self.allowance.set(left.ok_or(Fault::OutOfProportion { bytes: self.bytes })?);
        Ok(())
    }
}

/// The document in `text`, but for channels of animations that move no node: such a channel is to be
/// ignored, or an extension says what it moves (§5.10.1 of the specification), and the crate refuses it.
fn root(text: &[u8]) -> Result<json::Root, ReadError> {
    let failed = |error: json::Error| invalid(error.to_string());
    let error = match json::deserialize::from_slice(text) {
        Ok(root) => return Ok(root),
        Err(error) => error,
    };
    let mut value: json::Value = json::deserialize::from_slice(text).map_err(failed)?;
    let mut is_changed = false;
    let animations = value.get_mut("animations").and_then(json::Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        let channels = animation.get_mut("channels").and_then(json::Value::as_array_mut);
        channels.into_iter().for_each(|channels| {
            let count = channels.len();
            let moves_nothing = |channel: &json::Value| {
                channel.get("target").is_some_and(|t| t.is_object() && t.get("node").is_none())
            };
            channels.retain(|channel| !moves_nothing(channel));
            is_changed |= channels.len() < count;
        });
    }
    // What was said first knows its line.
    if is_changed {
        json::deserialize::from_value(value).map_err(failed)
    } else {
        Err(failed(error))
    }
}

/// An object that `place` refers to by its index in the array `kind`.
pub(super) fn object<'r, T>(
    objects: &'r [T],
    index: usize,
    kind: &'static str,
    place: &Place,
) -> Result<&'r T, ReadError> {
    let (wanted, count) = (index as u64, objects.len() as u64);
    let missing = || Fault::NoSuchObject { kind, index: wanted, count }.at(place.clone());
    objects.get(index).ok_or_else(missing)
}

/// JSON and binary chunk.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

fn split(bytes: &[u8]) -> Result<Chunks<'_>, ReadError> {
    if !bytes.starts_with(b"glTF") {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok((text.into(), None));
    }
    // The crate subtracts this header from the length that it finds, unchecked.
    let length = bytes.get(8..12).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
    if length.is_none_or(|length| length < 12) {
        return Err(Fault::TooShort { needed: 12, available: length.unwrap_or(0).into() }
            .at(Place::Byte(8)));
    }
    let glb = Glb::from_slice(bytes).map_err(|error| {
        let ::gltf::Error::Binary(error) = error else { return invalid(error.to_string()) };
        match error {
            binary::Error::Length { length: needed, length_read: available }
            | binary::Error::ChunkLength { length: needed, length_read: available, .. } => {
                Fault::TooShort { needed: needed.into(), available: available as u64 }
                    .at(Place::Byte((bytes.len() - available) as u64))
            }
            error => invalid(error.to_string()),
        }
    })?;
    Ok((glb.json, glb.bin))
}

/// What the parser says, in one line. It quotes the file at any length: its start says what is wrong, and
/// its end where.
fn invalid(message: String) -> ReadError {
    const KEPT: usize = 80;
    let mut message = message.replace(char::is_control, " ");
    let (mut chars, mut last_chars) = (message.char_indices(), message.char_indices());
    if let (Some((start, _)), Some((end, _))) = (chars.nth(KEPT), last_chars.nth_back(KEPT - 1))
        && start < end
    {
        message.replace_range(start..end, "…");
    }
    Fault::Document { message }.at(Place::Byte(0))
}

/// The bytes that a URI stands for: base64 in itself, or a file in `folder`.
fn external(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, Fault> {
    if let Some(data) = uri.strip_prefix("data:") {
        let config =
            GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
        let engine = GeneralPurpose::new(&STANDARD, config);
        let text = data.split_once(";base64,").map(|(_, text)| text);
        let bytes = text.and_then(|text| engine.decode(text.trim()).ok());
        return bytes.ok_or(Fault::WrongType { expected: "valid base64 data" });
    }
    let path = percent_decode_str(uri).decode_utf8_lossy();
    let path = Path::new(&*path);
    if uri.contains(':') || path.is_absolute() {
        return Err(Fault::WrongType { expected: "a file beside this one" });
    }
    let folder = folder.ok_or(Fault::WrongType { expected: "within these bytes" })?;
    let path = folder.join(path);
    let failed = |error| Fault::External { uri: uri.to_owned(), error };
    // Not a device, which might never end.
    if !fs::metadata(&path).map_err(failed)?.is_file() {
        return Err(Fault::WrongType { expected: "a file beside this one" });
    }
    fs::read(&path).map_err(failed)
}
