// Turns the calls of a frame's setup into a GraphDecl; see frame_graph.hpp. Nothing is checked
// here: validate sees the whole declaration and can name pass and resource. Rendering thread.
#include "engine/graph/frame_graph.hpp"

#include "engine/core/check.hpp"

namespace neritic::graph {

// --- PassBuilder --------------------------------------------------------------------------------

ImageHandle PassBuilder::create_image(const std::string& name, const TransientImage& desc) {
  ResourceDecl resource;
  resource.name = name;
  resource.kind = ResourceKind::kImage;
  resource.format = desc.format;
  resource.width = desc.width;
  resource.height = desc.height;
  resource.layers = desc.layers;
  return {graph_.add_resource(std::move(resource), nullptr, nullptr), 0};
}

BufferHandle PassBuilder::create_buffer(const std::string& name, std::uint64_t size_bytes) {
  ResourceDecl resource;
  resource.name = name;
  resource.kind = ResourceKind::kBuffer;
  resource.size_bytes = size_bytes;
  return {graph_.add_resource(std::move(resource), nullptr, nullptr), 0};
}

void PassBuilder::use(std::uint32_t resource, std::uint32_t version, Access access, bool write) {
  const PassDecl& pass = graph_.declaration_.passes[pass_];
  NERITIC_CHECK(access_info(access).write == write, "pass \"{}\": {} is {}a write", pass.name,
                access_info(access).name, write ? "not " : "");
  graph_.declaration_.passes[pass_].uses.push_back({resource, version, access});
}

void PassBuilder::read(ImageHandle image, Access access) {
  use(image.resource, image.version, access, false);
}
void PassBuilder::read(BufferHandle buffer, Access access) {
  use(buffer.resource, buffer.version, access, false);
}
ImageHandle PassBuilder::write(ImageHandle image, Access access) {
  use(image.resource, image.version, access, true);
  return {image.resource, image.version + 1};
}
BufferHandle PassBuilder::write(BufferHandle buffer, Access access) {
  use(buffer.resource, buffer.version, access, true);
  return {buffer.resource, buffer.version + 1};
}
void PassBuilder::side_effect() {
  graph_.declaration_.passes[pass_].side_effect = true;
}

// --- PassContext --------------------------------------------------------------------------------

void PassContext::check_declared(std::uint32_t resource) const {
  for (const Use& use : pass_.uses)
    if (use.resource == resource) return;
  NERITIC_CHECK(false, "pass \"{}\" asks for resource {}, which it did not declare", pass_.name,
                resource);
}

const gpu::Image& PassContext::image(ImageHandle handle) const {
  check_declared(handle.resource);
  const gpu::Image* image = images_[handle.resource];
  NERITIC_CHECK(image, "pass \"{}\": resource {} is no image", pass_.name, handle.resource);
  return *image;
}

const gpu::Buffer& PassContext::buffer(BufferHandle handle) const {
  check_declared(handle.resource);
  const gpu::Buffer* buffer = buffers_[handle.resource];
  NERITIC_CHECK(buffer, "pass \"{}\": resource {} is no buffer", pass_.name, handle.resource);
  return *buffer;
}

// --- FrameGraph ---------------------------------------------------------------------------------

std::uint32_t FrameGraph::add_resource(ResourceDecl&& resource, const gpu::Image* image,
                                       const gpu::Buffer* buffer) {
  declaration_.resources.push_back(std::move(resource));
  imported_images_.push_back(image);
  imported_buffers_.push_back(buffer);
  return static_cast<std::uint32_t>(declaration_.resources.size() - 1);
}

ImageHandle FrameGraph::import_image(const gpu::Image& image, const ImportState& state) {
  // One image is one resource, however often it is imported: two would hide each other's hazards.
  for (std::uint32_t r = 0; r < imported_images_.size(); ++r)
    if (imported_images_[r] == &image) return {r, 0};
  const gpu::ImageDesc& desc = image.desc();
  ResourceDecl resource;
  resource.name = desc.name;
  resource.kind = ResourceKind::kImage;
  resource.imported = true;
  resource.format = desc.format;
  resource.width = desc.width;
  resource.height = desc.height;
  resource.layers = desc.layers;
  resource.image_usage = desc.usage;
  resource.initial_stages = state.stages;
  resource.initial_access = state.access;
  resource.initial_layout = state.layout;
  return {add_resource(std::move(resource), &image, nullptr), 0};
}

BufferHandle FrameGraph::import_buffer(const std::string& name, const gpu::Buffer& buffer,
                                       const ImportState& state) {
  for (std::uint32_t r = 0; r < imported_buffers_.size(); ++r)
    if (imported_buffers_[r] == &buffer) return {r, 0};
  ResourceDecl resource;
  resource.name = name;
  resource.kind = ResourceKind::kBuffer;
  resource.imported = true;
  resource.size_bytes = buffer.size();
  resource.initial_stages = state.stages;
  resource.initial_access = state.access;
  return {add_resource(std::move(resource), nullptr, &buffer), 0};
}

void FrameGraph::output(ImageHandle image, Access access) {
  declaration_.outputs.push_back({image.resource, image.version, access});
}
void FrameGraph::output(BufferHandle buffer, Access access) {
  declaration_.outputs.push_back({buffer.resource, buffer.version, access});
}

PassBuilder FrameGraph::begin_pass(const std::string& name) {
  declaration_.passes.push_back({name, {}, false});
  records_.emplace_back();
  return PassBuilder(*this, static_cast<std::uint32_t>(declaration_.passes.size() - 1));
}

}  // namespace neritic::graph
