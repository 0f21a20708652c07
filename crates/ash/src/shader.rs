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

    /// A fragment shader of the caller's own, for a color attachment of `format`.
    pub(crate) fn custom(
        device: &'a Device,
        source: &str,
        format: vk::Format,
    ) -> Result<Self, Error> {
        let what = "lines of one's own";
        let (module, words) = compile(what, source, BoundsCheckPolicy::Restrict)?;
        check_custom(&module, format)
            .map_err(|reason| Error::Shader { what, reason: reason.to_owned() })?;
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
    validator.subgroup_stages(ShaderStages::TASK | ShaderStages::MESH);
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
        // Our own loops end.
        force_loop_bounding: checks != BoundsCheckPolicy::Unchecked,
        ..spv::Options::default()
    };
    let words = spv::write_vec(&module, &info, &options, None)
        .map_err(|error| invalid(error.to_string()))?;
    Ok((module, words))
}

/// Entry point of a fragment shader of the caller's own.
pub(crate) const CUSTOM_ENTRY: &str = "fragment";

/// Whether such a shader reads no more than mesh shaders emit, and gives what `format` holds.
fn check_custom(module: &naga::Module, format: vk::Format) -> Result<(), &'static str> {
    let is_wanted = |entry: &&naga::EntryPoint| {
        entry.name == CUSTOM_ENTRY && entry.stage == naga::ShaderStage::Fragment
    };
    let entry = module.entry_points.iter().find(is_wanted);
    let function = &entry.ok_or("it has no fragment entry point `fragment`")?.function;
    if module.global_variables.iter().any(|(_, variable)| variable.binding.is_some()) {
        return Err("it binds something");
    }
    let arguments = function.arguments.iter();
    let read = arguments.flat_map(|a| members(module, a.ty, a.binding.as_ref()));
    let is_emitted = |(ty, binding): &(&naga::TypeInner, &naga::Binding)| match binding {
        naga::Binding::BuiltIn(_) => true,
        naga::Binding::Location { location, per_primitive, .. } => {
            *location < 2 && *per_primitive && **ty == naga::TypeInner::Scalar(naga::Scalar::U32)
        }
    };
    if !read.into_iter().all(|member| is_emitted(&member)) {
        return Err("it reads something else than the id and the class of an edge");
    }
    let result = function.result.as_ref().ok_or("it gives nothing")?;
    let name = format!("{format:?}");
    let kind = match () {
        () if name.contains("UINT") => naga::ScalarKind::Uint,
        () if name.contains("SINT") => naga::ScalarKind::Sint,
        () => naga::ScalarKind::Float,
    };
    let is_held = |(ty, binding): &(&naga::TypeInner, &naga::Binding)| match binding {
        naga::Binding::BuiltIn(_) => true,
        naga::Binding::Location { location, .. } => {
            *location == 0 && ty.scalar_kind() == Some(kind)
        }
    };
    let given = members(module, result.ty, result.binding.as_ref());
    let has_color = given.iter().any(|(_, b)| matches!(b, naga::Binding::Location { .. }));
    if !has_color || !given.iter().all(is_held) {
        return Err("it gives something else than what the color attachment holds");
    }
    Ok(())
}

/// What an argument or a result consists of, with where each is bound.
fn members<'a>(
    module: &'a naga::Module,
    ty: naga::Handle<naga::Type>,
    binding: Option<&'a naga::Binding>,
) -> Vec<(&'a naga::TypeInner, &'a naga::Binding)> {
    let inner = &module.types[ty].inner;
    match (binding, inner) {
        (Some(binding), _) => vec![(inner, binding)],
        (None, naga::TypeInner::Struct { members, .. }) => {
            let bound = members.iter().filter_map(|member| {
                Some((&module.types[member.ty].inner, member.binding.as_ref()?))
            });
            bound.collect()
        }
        (None, _) => Vec::new(),
    }
}
