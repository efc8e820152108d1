// Turns the calls of a frame's setup into a GraphDecl; see frame_graph.hpp. Nothing is checked
// here: validate sees the whole declaration and can name pass and resource. Rendering thread.
#include "engine/graph/frame_graph.hpp"

#include <atomic>
#include <type_traits>

#include "engine/core/check.hpp"
#include "engine/graph/names.hpp"

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
  resource.mips = desc.mips;
  return {graph_.add_resource(std::move(resource), nullptr, nullptr), 0, graph_.id_, {}};
}

BufferHandle PassBuilder::create_buffer(const std::string& name, std::uint64_t size_bytes) {
  ResourceDecl resource;
  resource.name = name;
  resource.kind = ResourceKind::kBuffer;
  resource.size_bytes = size_bytes;
  return {graph_.add_resource(std::move(resource), nullptr, nullptr), 0, graph_.id_};
}

template <class Handle>
void PassBuilder::use(const Handle& handle, Access access, bool write) {
  PassDecl& pass = graph_.declaration_.passes[pass_];
  NERITIC_CHECK(access_info(access).write == write, "pass \"{}\": {} is {}a write", pass.name,
                access_info(access).name, write ? "not " : "");
  pass.uses.push_back(graph_.use_of(handle, access, "pass " + pass.name));
}

void PassBuilder::read(ImageHandle image, Access access) {
  use(image, access, false);
}
void PassBuilder::read(BufferHandle buffer, Access access) {
  use(buffer, access, false);
}
ImageHandle PassBuilder::write(ImageHandle image, Access access) {
  use(image, access, true);
  return {image.resource, image.version + 1, image.graph, image.range};
}
BufferHandle PassBuilder::write(BufferHandle buffer, Access access) {
  use(buffer, access, true);
  return {buffer.resource, buffer.version + 1, buffer.graph};
}
void PassBuilder::side_effect() {
  graph_.declaration_.passes[pass_].side_effect = true;
}
// A part of the declaration, by which plans are found: a text that changes with each frame would
// have each of them compiled anew.
void PassBuilder::terms(std::string names) {
  graph_.declaration_.passes[pass_].terms = std::move(names);
}

// --- PassContext --------------------------------------------------------------------------------

void PassContext::check_declared(std::uint32_t resource, std::uint64_t graph) const {
  NERITIC_CHECK(graph == graph_, "pass \"{}\" of graph {} asks for a resource of graph {}",
                pass_.name, graph_, graph);
  for (const Use& use : pass_.uses)
    if (use.resource == resource) return;
  NERITIC_CHECK(false, "pass \"{}\" asks for resource {}, which it did not declare", pass_.name,
                resource);
}

const gpu::Image& PassContext::image(ImageHandle handle) const {
  check_declared(handle.resource, handle.graph);
  const gpu::Image* image = images_[handle.resource];
  NERITIC_CHECK(image, "pass \"{}\": resource {} is no image", pass_.name, handle.resource);
  return *image;
}

VkImageView PassContext::view(ImageHandle handle) const {
  const gpu::Image& whole = image(handle);
  const auto concrete = [&whole](const ImageRange& range) {
    return range.within(whole.desc().mips, whole.desc().layers);
  };
  const ImageRange wanted = concrete(handle.range);
  for (const Use& use : pass_.uses)
    if (use.resource == handle.resource && concrete(use.range) == wanted)
      return whole.view_of(wanted).value();  // Executor::run has made it
  NERITIC_CHECK(false, "pass \"{}\" asks for {} of \"{}\", which it did not declare", pass_.name,
                range_name(wanted), whole.desc().name);
}

const gpu::Buffer& PassContext::buffer(BufferHandle handle) const {
  check_declared(handle.resource, handle.graph);
  const gpu::Buffer* buffer = buffers_[handle.resource];
  NERITIC_CHECK(buffer, "pass \"{}\": resource {} is no buffer", pass_.name, handle.resource);
  return *buffer;
}

// --- FrameGraph ---------------------------------------------------------------------------------

FrameGraph::FrameGraph() {
  static std::atomic<std::uint64_t> made{0};  // only so that no two graphs share a number
  id_ = ++made;
}

template <class Handle>
Use FrameGraph::use_of(const Handle& handle, Access access, const std::string& who) const {
  // No handle at all is left to validate(), which knows what to say.
  NERITIC_CHECK(!handle || handle.graph == id_,
                "{} of graph {} uses a handle of graph {}: kept from an earlier frame?", who, id_,
                handle.graph);
  Use use{handle.resource, handle.version, access, {}};
  if constexpr (std::is_same_v<Handle, ImageHandle>) use.range = handle.range;
  return use;
}

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
    if (imported_images_[r] == &image) return {r, 0, id_, {}};
  const gpu::ImageDesc& desc = image.desc();
  ResourceDecl resource;
  resource.name = desc.name;
  resource.kind = ResourceKind::kImage;
  resource.imported = true;
  resource.format = desc.format;
  resource.width = desc.width;
  resource.height = desc.height;
  resource.layers = desc.layers;
  resource.mips = desc.mips;
  resource.image_usage = desc.usage;
  resource.initial_stages = state.stages;
  resource.initial_access = state.access;
  resource.initial_layout = state.layout;
  return {add_resource(std::move(resource), &image, nullptr), 0, id_, {}};
}

BufferHandle FrameGraph::import_buffer(const std::string& name, const gpu::Buffer& buffer,
                                       const ImportState& state) {
  for (std::uint32_t r = 0; r < imported_buffers_.size(); ++r)
    if (imported_buffers_[r] == &buffer) return {r, 0, id_};
  ResourceDecl resource;
  resource.name = name;
  resource.kind = ResourceKind::kBuffer;
  resource.imported = true;
  resource.size_bytes = buffer.size();
  resource.buffer_usage = buffer.usage();
  resource.initial_stages = state.stages;
  resource.initial_access = state.access;
  return {add_resource(std::move(resource), nullptr, &buffer), 0, id_};
}

HistoryImages FrameGraph::history(const std::string& name, const TransientImage& desc,
                                  std::initializer_list<Access> accesses) {
  for (const HistoryDecl& known : histories_)
    if (known.name == name) return {{known.last, 0, id_, {}}, {known.next, 0, id_, {}}};
  HistoryDecl history{name, {name, desc.format, desc.width, desc.height, desc.layers, desc.mips}};
  history.desc.array_view = true;
  history.desc.usage = access_info(Access::kTransferWrite).image_usage;  // it is cleared at first
  for (const Access access : accesses) history.desc.usage |= access_info(access).image_usage;
  const auto add = [&](const char* which, History role) {
    ResourceDecl resource;
    resource.name = name + which;
    resource.imported = true;
    resource.history = role;
    resource.format = desc.format;
    resource.width = desc.width;
    resource.height = desc.height;
    resource.layers = desc.layers;
    resource.mips = desc.mips;
    resource.image_usage = history.desc.usage;
    return add_resource(std::move(resource), nullptr, nullptr);
  };
  history.last = add(" (last)", History::kLast);
  history.next = add(" (next)", History::kNext);
  histories_.push_back(history);
  return {{history.last, 0, id_, {}}, {history.next, 0, id_, {}}};
}

void FrameGraph::output(ImageHandle image, Access access) {
  declaration_.outputs.push_back(use_of(image, access, "an output"));
}
void FrameGraph::output(BufferHandle buffer, Access access) {
  declaration_.outputs.push_back(use_of(buffer, access, "an output"));
}

PassBuilder FrameGraph::begin_pass(const std::string& name) {
  declaration_.passes.push_back({name, {}, false});
  records_.emplace_back();
  return PassBuilder(*this, static_cast<std::uint32_t>(declaration_.passes.size() - 1));
}

BufferHandle copy_buffer(FrameGraph& graph, const std::string& pass, BufferHandle from,
                         const std::string& name, const gpu::Buffer& to) {
  struct Copy {
    BufferHandle from, to;
  };
  return graph
      .add_pass<Copy>(
          pass,
          [&](PassBuilder& builder, Copy& copy) {
            copy.from = from;
            builder.read(from, Access::kTransferRead);
            copy.to = builder.write(graph.import_buffer(name, to), Access::kTransferWrite);
          },
          [](const Copy& copy, PassContext& context) {
            const gpu::Buffer &in = context.buffer(copy.from), &out = context.buffer(copy.to);
            const VkBufferCopy all{0, 0, in.size()};
            vkCmdCopyBuffer(context.cmd(), in.handle(), out.handle(), 1, &all);
          })
      .to;
}

}  // namespace neritic::graph
