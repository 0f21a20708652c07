//! Descriptor sets: what shaders see of buffers and images.

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use crate::memory::{Buffer, Image};
use crate::{Device, Error};

/// Kinds of what is bound at 0, 1, 2 and so on.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    shared: Arc<SharedLayout>,
}

#[derive(Debug)]
struct SharedLayout {
    device: Device,
    raw: vk::DescriptorSetLayout,
    types: Vec<vk::DescriptorType>,
}

/// What is bound.
#[derive(Clone, Debug)]
pub(crate) struct Set {
    shared: Arc<SharedSet>,
}

#[derive(Debug)]
struct SharedSet {
    layout: Layout,
    /// Holds this set alone.
    pool: vk::DescriptorPool,
    raw: vk::DescriptorSet,
    _resources: Vec<Arc<dyn Any + Send + Sync>>,
}

/// Something to bind.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Resource<'a> {
    Buffer(&'a Buffer),
    /// So many bytes, at an offset that is given when the set is bound.
    Piece(&'a Buffer, u64),
    /// In the layout for reading.
    Image(&'a Image),
}

pub(crate) const STORAGE: vk::DescriptorType = vk::DescriptorType::STORAGE_BUFFER;
pub(crate) const STORAGE_PIECE: vk::DescriptorType = vk::DescriptorType::STORAGE_BUFFER_DYNAMIC;
pub(crate) const UNIFORM: vk::DescriptorType = vk::DescriptorType::UNIFORM_BUFFER;
pub(crate) const UNIFORM_PIECE: vk::DescriptorType = vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC;
pub(crate) const IMAGE: vk::DescriptorType = vk::DescriptorType::SAMPLED_IMAGE;

impl Layout {
    pub(crate) fn new(
        device: &Device,
        what: &'static str,
        stages: vk::ShaderStageFlags,
        types: &[vk::DescriptorType],
    ) -> Result<Self, Error> {
        let binding = |(index, ty): (u32, &vk::DescriptorType)| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(index)
                .descriptor_type(*ty)
                .descriptor_count(1)
                .stage_flags(stages)
        };
        let bindings: Vec<_> = (0..).zip(types).map(binding).collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: each binding has one descriptor, and a number of its own.
        let raw = unsafe { device.raw().create_descriptor_set_layout(&info, None) };
        let raw = raw.map_err(|error| Error::of(what, error))?;
        let shared = SharedLayout { device: device.clone(), raw, types: types.to_vec() };
        Ok(Self { shared: Arc::new(shared) })
    }

    pub(crate) fn raw(&self) -> vk::DescriptorSetLayout {
        self.shared.raw
    }
}

impl Drop for SharedLayout {
    fn drop(&mut self) {
        // SAFETY: sets and pipelines of this layout keep it.
        unsafe { self.device.raw().destroy_descriptor_set_layout(self.raw, None) };
    }
}

impl Set {
    /// A resource for each binding of `layout`.
    pub(crate) fn new(
        layout: &Layout,
        what: &'static str,
        resources: &[Resource<'_>],
    ) -> Result<Self, Error> {
        let types = &layout.shared.types;
        assert_eq!(types.len(), resources.len(), "{what}: something for each binding");
        let device = &layout.shared.device;
        let size =
            |ty: &vk::DescriptorType| vk::DescriptorPoolSize { ty: *ty, descriptor_count: 1 };
        let sizes: Vec<_> = types.iter().map(size).collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: a pool for one set.
        let pool = unsafe { device.raw().create_descriptor_pool(&info, None) };
        let pool = pool.map_err(|error| Error::of(what, error))?;
        let layouts = [layout.raw()];
        let info =
            vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        // SAFETY: the pool has room for one set of that layout.
        let allocated = unsafe { device.raw().allocate_descriptor_sets(&info) };
        let raw = allocated.map(|sets| sets[0]).map_err(|error| {
            // SAFETY: nobody else has seen the pool.
            unsafe { device.raw().destroy_descriptor_pool(pool, None) };
            Error::of(what, error)
        })?;
        let kept = |resource: &Resource<'_>| match resource {
            Resource::Buffer(buffer) | Resource::Piece(buffer, _) => buffer.kept(),
            Resource::Image(image) => image.kept(),
        };
        let resources_kept = resources.iter().map(kept).collect();
        let shared = SharedSet { layout: layout.clone(), pool, raw, _resources: resources_kept };
        for (index, resource) in (0..).zip(resources) {
            shared.write(index, resource);
        }
        Ok(Self { shared: Arc::new(shared) })
    }

    pub(crate) fn raw(&self) -> vk::DescriptorSet {
        self.shared.raw
    }

    pub(crate) fn kept(&self) -> Arc<dyn Any + Send + Sync> {
        self.shared.clone()
    }
}

impl SharedSet {
    fn write(&self, binding: u32, resource: &Resource<'_>) {
        let SharedLayout { device, types, .. } = &*self.layout.shared;
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.raw)
            .dst_binding(binding)
            .descriptor_type(types[binding as usize]);
        let (buffers, images);
        let write = match resource {
            Resource::Buffer(buffer) => {
                buffers = [buffer_info(buffer, buffer.size())];
                write.buffer_info(&buffers)
            }
            Resource::Piece(buffer, size) => {
                buffers = [buffer_info(buffer, *size)];
                write.buffer_info(&buffers)
            }
            Resource::Image(image) => {
                images = [vk::DescriptorImageInfo::default()
                    .image_view(image.view())
                    .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)];
                write.image_info(&images)
            }
        };
        // SAFETY: the set is new and not yet in use; it keeps what is bound.
        unsafe { device.raw().update_descriptor_sets(&[write], &[]) };
    }
}

fn buffer_info(buffer: &Buffer, size: u64) -> vk::DescriptorBufferInfo {
    vk::DescriptorBufferInfo::default().buffer(buffer.raw()).range(size)
}

impl Drop for SharedSet {
    fn drop(&mut self) {
        // SAFETY: commands that use the set keep it until they have executed. Its pool has no other.
        unsafe { self.layout.shared.device.raw().destroy_descriptor_pool(self.pool, None) };
    }
}
