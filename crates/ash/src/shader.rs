//! From WGSL to shader modules.

use ash::vk;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ShaderStages, SubgroupOperationSet, ValidationFlags, Validator};

use crate::{Device, Error};

/// A shader module, needed only while pipelines are made from it.
pub(crate) struct Shader<'a> {
    device: &'a Device,
    raw: vk::ShaderModule,
}

impl<'a> Shader<'a> {
    /// All entry points of `source`.
    pub(crate) fn new(device: &'a Device, what: &'static str, source: &str) -> Result<Self, Error> {
        // What indexes buffers was checked when it was uploaded.
        let (_, words) = compile(what, source, BoundsCheckPolicy::Unchecked)?;
        Self::of(device, what, &words)
    }

    /// A fragment shader of the caller's own, which binds nothing.
    pub(crate) fn custom(device: &'a Device, source: &str) -> Result<Self, Error> {
        let what = "a fragment shader of one's own";
        let (module, words) = compile(what, source, BoundsCheckPolicy::Restrict)?;
        let invalid = |reason: &str| Err(Error::Shader { what, reason: reason.to_owned() });
        let is_wanted = |entry: &naga::EntryPoint| {
            entry.name == "fragment" && entry.stage == naga::ShaderStage::Fragment
        };
        if !module.entry_points.iter().any(is_wanted) {
            return invalid("it has no fragment entry point `fragment`");
        }
        if module.global_variables.iter().any(|(_, variable)| variable.binding.is_some()) {
            return invalid("it binds something");
        }
        Self::of(device, what, &words)
    }

    fn of(device: &'a Device, what: &'static str, words: &[u32]) -> Result<Self, Error> {
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        // SAFETY: naga has validated the source, and writes valid SPIR-V.
        let raw = unsafe { device.raw().create_shader_module(&info, None) };
        let raw = raw.map_err(|error| Error::of(what, error))?;
        Ok(Self { device, raw })
    }

    pub(crate) fn raw(&self) -> vk::ShaderModule {
        self.raw
    }
}

impl Drop for Shader<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines do not need it once they are made.
        unsafe { self.device.raw().destroy_shader_module(self.raw, None) };
    }
}

/// SPIR-V 1.4, which mesh shaders need.
fn compile(
    what: &'static str,
    source: &str,
    checks: BoundsCheckPolicy,
) -> Result<(naga::Module, Vec<u32>), Error> {
    let invalid = |reason: String| Error::Shader { what, reason };
    let module = naga::front::wgsl::parse_str(source)
        .map_err(|error| invalid(error.emit_to_string(source)))?;
    let capabilities = Capabilities::MESH_SHADER | Capabilities::SUBGROUP;
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    validator.subgroup_stages(ShaderStages::COMPUTE | ShaderStages::TASK | ShaderStages::MESH);
    validator.subgroup_operations(SubgroupOperationSet::all());
    let info =
        validator.validate(&module).map_err(|error| invalid(error.emit_to_string(source)))?;
    let options = spv::Options {
        lang_version: (1, 4),
        // Clip space is turned over by the viewport: in mesh shaders some drivers lose what naga does for it.
        flags: spv::WriterFlags::empty(),
        // Shaders begin by writing what they read in workgroup memory.
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        bounds_check_policies: BoundsCheckPolicies {
            index: checks,
            buffer: checks,
            // Pixels beyond an image are asked for where the caller renders to a larger one.
            image_load: BoundsCheckPolicy::Restrict,
            binding_array: checks,
        },
        force_loop_bounding: false,
        ..spv::Options::default()
    };
    let words = spv::write_vec(&module, &info, &options, None)
        .map_err(|error| invalid(error.to_string()))?;
    Ok((module, words))
}
