// Declares this frame's passes and runs them. A pass is a name, a struct of typed handles, a setup
// that runs now and a record that runs later. write() returns a new version of the handle, so that
// an ambiguous order cannot be written. Passes nobody needs are culled: an undeclared or culled
// pass costs nothing. Rendering thread only.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {

inline constexpr std::uint32_t kNoResource = ~0u;

// One version of an image, or of the part of it that range names. Valid only in the graph that
// returned it (graph: its number), so only in one frame: using one from an earlier frame stops the
// program.
struct ImageHandle {
  std::uint32_t resource = kNoResource, version = 0;
  std::uint64_t graph = 0;
  ImageRange range;
  explicit operator bool() const { return resource != kNoResource; }

  // The same version of other mips or layers, counted from the image's first.
  ImageHandle mip(std::uint32_t index) const { return mip_range(index, 1); }
  ImageHandle layer(std::uint32_t index) const { return layer_range(index, 1); }
  ImageHandle mip_range(std::uint32_t first, std::uint32_t count) const {
    return {resource, version, graph, {first, count, range.layer, range.layers}};
  }
  ImageHandle layer_range(std::uint32_t first, std::uint32_t count) const {
    return {resource, version, graph, {range.mip, range.mips, first, count}};
  }
  ImageHandle whole() const { return {resource, version, graph, {}}; }
};
struct BufferHandle {
  std::uint32_t resource = kNoResource, version = 0;
  std::uint64_t graph = 0;
  explicit operator bool() const { return resource != kNoResource; }
};

struct TransientImage {
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 1, height = 1, layers = 1, mips = 1;
};

class FrameGraph;

class PassBuilder {
 public:
  ImageHandle create_image(const std::string& name, const TransientImage& desc);
  BufferHandle create_buffer(const std::string& name, std::uint64_t size_bytes);
  void read(ImageHandle image, Access access);
  void read(BufferHandle buffer, Access access);
  // The returned handle names the same part. One pass may write several parts of an image.
  [[nodiscard]] ImageHandle write(ImageHandle image, Access access);
  [[nodiscard]] BufferHandle write(BufferHandle buffer, Access access);
  // Keeps the pass although no output needs it.
  void side_effect();
  // Names the options that the pass computes, for the dump.
  void terms(std::string names);

 private:
  friend class FrameGraph;
  PassBuilder(FrameGraph& graph, std::uint32_t pass) : graph_(graph), pass_(pass) {}
  template <class Handle>
  void use(const Handle& handle, Access access, bool write);
  FrameGraph& graph_;
  std::uint32_t pass_;
};

// The real objects behind a pass's handles while it records. A pass may ask only for what it
// declared.
class PassContext {
 public:
  gpu::Commands& commands;
  VkCommandBuffer cmd() const { return commands.handle(); }
  const gpu::Image& image(ImageHandle handle) const;
  // A view of the mips and layers that the handle names; a 2D_ARRAY one of transients.
  VkImageView view(ImageHandle handle) const;
  const gpu::Buffer& buffer(BufferHandle handle) const;

 private:
  friend class Executor;
  PassContext(gpu::Commands& c, std::uint64_t graph, const PassDecl& pass,
              const std::vector<const gpu::Image*>& images,
              const std::vector<const gpu::Buffer*>& buffers)
      : commands(c), graph_(graph), pass_(pass), images_(images), buffers_(buffers) {}
  void check_declared(std::uint32_t resource, std::uint64_t graph) const;
  std::uint64_t graph_;
  const PassDecl& pass_;
  const std::vector<const gpu::Image*>& images_;
  const std::vector<const gpu::Buffer*>& buffers_;
};

// How an imported resource is at the frame's start. stages, access: what is pending on it besides
// earlier runs of the executor, which knows those (a semaphore's wait stage, for one). layout: of
// the image; its contents are undefined where that is UNDEFINED.
struct ImportState {
  VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 access = VK_ACCESS_2_NONE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// An image that keeps its content from frame to frame.
struct HistoryImages {
  ImageHandle last;  // what the last frame wrote that declared it; zero where there is none
  ImageHandle next;  // empty; what is written becomes the next frame's last
};
struct HistoryDecl {
  std::string name;
  gpu::ImageDesc desc;
  std::uint32_t last = kNoResource, next = kNoResource;  // resources of the graph
};

class FrameGraph {
 public:
  FrameGraph();
  using ImportState = graph::ImportState;
  // The image and buffer must live until the GPU is done with the frame. Importing one again gives
  // the same resource. One executor's graphs may share it; other users must say in state what is
  // pending.
  ImageHandle import_image(const gpu::Image& image, const ImportState& state);
  BufferHandle import_buffer(const std::string& name, const gpu::Buffer& buffer,
                             const ImportState& state = {});

  // A history by name. accesses: all that any frame does with it. Its content is zero at first, and
  // again after a change of size, format or accesses; it stays as it is while no kept pass writes
  // next; it is freed when no graph has declared it for some seconds. A kept pass that writes next
  // in part is an error: next must be written whole. Writing next keeps no pass; an output does.
  HistoryImages history(const std::string& name, const TransientImage& desc,
                        std::initializer_list<Access> accesses);

  // setup: void(PassBuilder&, Data&), runs now. record: void(const Data&, PassContext&), runs in
  // Executor::run if the pass is kept. Returns the data with its handles.
  template <class Data, class Setup, class Record>
  const Data& add_pass(const std::string& name, Setup&& setup, Record&& record) {
    auto data = std::make_shared<Data>();
    PassBuilder builder = begin_pass(name);
    setup(builder, *data);
    records_.back() = [data, record = std::forward<Record>(record)](PassContext& context) mutable {
      record(std::as_const(*data), context);
    };
    return *data;  // owned by the record
  }

  // The version must be there at the frame's end, in that access (kHostRead, kPresent,
  // kSampled...).
  void output(ImageHandle image, Access access);
  void output(BufferHandle buffer, Access access);

  const GraphDecl& declaration() const { return declaration_; }

 private:
  friend class PassBuilder;
  friend class Executor;
  PassBuilder begin_pass(const std::string& name);
  std::uint32_t add_resource(ResourceDecl&& resource, const gpu::Image* image,
                             const gpu::Buffer* buffer);
  // The use of a handle's resource; CHECKs that the handle belongs to this graph.
  template <class Handle>
  Use use_of(const Handle& handle, Access access, const std::string& who) const;
  std::uint64_t id_;  // no other graph of the program has it
  GraphDecl declaration_;
  std::vector<std::function<void(PassContext&)>> records_;
  std::vector<const gpu::Image*> imported_images_;  // by resource; nullptr for others
  std::vector<const gpu::Buffer*> imported_buffers_;
  std::vector<HistoryDecl> histories_;
};

// Compiles graphs for a device and runs them. Graphs share transient memory, enough for the largest
// of those that ran lately, and keep their images in it: a frame that declares the same as one of
// the last few hundred allocates nothing. Frames in flight overlap: a run waits for earlier ones
// only where it touches the same import, history or bytes of transient memory.
class Executor {
 public:
  explicit Executor(gpu::Frames& frames);
  ~Executor();
  // Compiles (cached by declaration); errors name pass and resource. Valid until the next call.
  Result<const Plan*> compile(const FrameGraph& graph);
  // Compiles and records every kept pass with its barriers, each in a region of its name. The plan
  // has the barriers of this run, those after earlier runs included. Valid until the next call.
  Result<const Plan*> run(FrameGraph& graph, gpu::Commands& commands);
  std::uint64_t transient_bytes() const;  // device memory held for transients now
  std::uint64_t history_bytes() const;    // and for histories

  // For tests only: run() hands a copy of each plan to spoil before it records it, so that a test
  // can plant a wrong barrier and see validation catch it. An empty function takes it off again.
  void spoil_plans_for_test(std::function<void(Plan&)> spoil);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Adds a pass that copies a buffer into one that lives outside the frame and is as large at least,
// and imports that under a name. Gives the written handle.
BufferHandle copy_buffer(FrameGraph& graph, const std::string& pass, BufferHandle from,
                         const std::string& name, const gpu::Buffer& to);

}  // namespace neritic::graph
