#include "engine/gpu/pipeline_shelf.hpp"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/pipeline_work.hpp"

namespace neritic::gpu {
namespace {

// Values one after the other, each list with its length, so that no two descriptions share a key.
class Key {
 public:
  template <class T>
  Key& add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Key& add(const std::string& text) {
    add(text.size());
    bytes_ += text;
    return *this;
  }
  Key& add(std::span<const std::uint32_t> code) {
    Hash64 hash;
    hash.add_span(code);
    return add(hash.value()).add(code.size());
  }
  Key& add(const std::vector<BindingDesc>& bindings) {
    add(bindings.size());
    for (const BindingDesc& b : bindings) add(b.binding).add(b.type).add(b.count);
    return *this;
  }
  Key& add(const PipelineLayoutDesc& layout) {
    add(layout.bindings).add(layout.push_constant_bytes).add(layout.other_sets.size());
    for (const SetLayout* set : layout.other_sets) add(set->bindings()).add(set->stages());
    return *this;
  }
  Key& add(const std::vector<SpecConstant>& constants) {
    add(constants.size());
    for (const SpecConstant& c : constants) add(c.id).add(c.value);
    return *this;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

std::string pipeline_key(const ComputePipelineDesc& desc) {
  return Key().add('c').add(desc.name).add(desc.code).add(desc.layout).add(desc.constants).take();
}

std::string pipeline_key(const GraphicsPipelineDesc& desc) {
  Key key;
  key.add('g').add(desc.name).add(desc.vertex_code).add(desc.fragment_code).add(desc.layout);
  key.add(desc.constants).add(desc.streams.size());
  for (const VertexStream& stream : desc.streams) {
    key.add(stream.stride).add(stream.per_instance).add(stream.attributes.size());
    for (const VertexStream::Attribute& a : stream.attributes)
      key.add(a.location).add(a.format).add(a.offset);
  }
  key.add(desc.topology).add(desc.color_formats.size());
  for (const VkFormat format : desc.color_formats) key.add(format);
  key.add(desc.depth_format).add(desc.depth_write).add(desc.depth_compare);
  return key.add(desc.blend).add(desc.view_mask).take();
}

Result<PipelineShelf::Made> PipelineShelf::get(const std::string& key,
                                               const std::function<Result<Made>()>& make) {
  const std::lock_guard lock(mutex_);
  if (const auto found = entries_.find(key); found != entries_.end()) {
    found->second.asked = ++requests_;
    return found->second.made;
  }
  const TimeNs begun = now_ns();
  NERITIC_TRY(Made made, make());
  work_ = {work_.made + 1, work_.took_ns + now_ns() - begun};
  entries_[key] = {made, ++requests_};
  drop_unused();
  return made;
}

void PipelineShelf::drop_unused() {
  std::vector<std::pair<std::uint64_t, const std::string*>> unused;
  for (const auto& [key, entry] : entries_)
    if (entry.made.use_count() == 1) unused.emplace_back(entry.asked, &key);
  if (unused.size() <= kUnusedKept) return;
  std::ranges::sort(unused);
  for (std::size_t i = 0; i + kUnusedKept < unused.size(); ++i) entries_.erase(*unused[i].second);
}

PipelineShelf::Work PipelineShelf::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

PipelineWork pipeline_work(const Device& device) {
  const PipelineShelf::Work work = device.pipelines().work();
  PipelineWork out{work.made, 1e-9 * static_cast<double>(work.took_ns)};
  if (device.pipeline_cache() != VK_NULL_HANDLE &&
      vkGetPipelineCacheData(device.handle(), device.pipeline_cache(), &out.cache_bytes, nullptr) !=
          VK_SUCCESS)
    out.cache_bytes = 0;
  return out;
}

}  // namespace neritic::gpu
