// See histories.hpp.
#include "engine/graph/histories.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/graph/record_barriers.hpp"

namespace neritic::graph {
namespace {

bool same_image(const gpu::ImageDesc& a, const gpu::ImageDesc& b) {
  return a.format == b.format && a.width == b.width && a.height == b.height &&
         a.layers == b.layers && a.mips == b.mips && a.usage == b.usage;
}

Past::State state_after_clear(const gpu::ImageDesc& desc) {
  const AccessInfo& clear = access_info(Access::kTransferWrite);
  return Past::State(std::size_t{desc.mips} * desc.layers,
                     {{0, clear.stages, clear.access, clear.layout, true}, false});
}

template <class Handle>
std::uint64_t number_of(Handle handle, bool image) {
  return reinterpret_cast<std::uint64_t>(handle) << 1 | (image ? 1 : 0);
}

}  // namespace

std::uint64_t object_of(const gpu::Image& image) {
  return number_of(image.handle(), true);
}
std::uint64_t object_of(const gpu::Buffer& buffer) {
  return number_of(buffer.handle(), false);
}

Histories::Pair* Histories::find(const std::string& name) const {
  for (const auto& pair : pairs_)
    if (pair->name == name) return pair.get();
  return nullptr;
}

Result<std::unique_ptr<Histories::Pair>> Histories::make(const gpu::Device& device,
                                                         const HistoryDecl& declared) const {
  auto pair = std::make_unique<Pair>();
  pair->name = declared.name;
  for (gpu::Image& image : pair->images) {
    NERITIC_TRY(image, gpu::Image::create(device, declared.desc));
    pair->bytes += gpu::image_requirements(device, declared.desc).size;
  }
  return pair;
}

Status Histories::prepare(const gpu::Device& device, const std::vector<HistoryDecl>& declared,
                          std::uint64_t recording, std::uint64_t run, VkCommandBuffer cmd,
                          Past& past, std::vector<gpu::Image>& retired) {
  for (const HistoryDecl& wanted : declared) {
    Pair* pair = find(wanted.name);
    if (pair && !same_image(pair->images[0].desc(), wanted.desc)) {
      const auto at = std::find_if(pairs_.begin(), pairs_.end(),
                                   [pair](const auto& other) { return other.get() == pair; });
      drop(static_cast<std::size_t>(at - pairs_.begin()), past, retired);
      pair = nullptr;
    }
    if (!pair) {
      NERITIC_TRY(auto made, make(device, wanted));
      bytes_ += made->bytes;
      pairs_.push_back(std::move(made));
      pair = pairs_.back().get();
      pair->made_in = recording;
      const gpu::Image& last = pair->images[pair->last];
      record_clear(cmd, last);
      past.set_object(object_of(last), state_after_clear(last.desc()));
    }
    pair->last_run = run;
    if (pair->recording == recording) continue;
    pair->recording = recording;
    pair->last_before = pair->last;
    for (int i = 0; i < 2; ++i) pair->states_before[i] = past.object(object_of(pair->images[i]));
  }
  return {};
}

const gpu::Image& Histories::last(const std::string& name) const {
  const Pair* pair = find(name);
  NERITIC_CHECK(pair, "no history \"{}\"", name);
  return pair->images[pair->last];
}

const gpu::Image& Histories::next(const std::string& name) const {
  const Pair* pair = find(name);
  NERITIC_CHECK(pair, "no history \"{}\"", name);
  return pair->images[1 - pair->last];
}

void Histories::advance(const std::vector<HistoryDecl>& declared, const Plan& plan) {
  for (const HistoryDecl& history : declared) {
    const bool written = std::any_of(plan.parts.begin(), plan.parts.end(), [&](const Part& part) {
      return part.resource == history.next &&
             std::any_of(part.epochs.begin(), part.epochs.end(),
                         [](const Epoch& epoch) { return epoch.write; });
    });
    Pair* pair = find(history.name);
    if (written) pair->last = 1 - pair->last;
  }
}

void Histories::rewind(std::uint64_t recording, Past& past, std::vector<gpu::Image>& retired) {
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    Pair& pair = *pairs_[i];
    if (pair.recording != recording) continue;
    if (pair.made_in == recording) {
      drop(i, past, retired);  // it was never cleared
      continue;
    }
    pair.last = pair.last_before;
    pair.recording = 0;
    for (int k = 0; k < 2; ++k)
      past.set_object(object_of(pair.images[k]), std::move(pair.states_before[k]));
  }
  past.settle();
}

void Histories::drop_unused(std::uint64_t first_run, Past& past, std::vector<gpu::Image>& retired) {
  for (std::size_t i = pairs_.size(); i-- > 0;)
    if (pairs_[i]->last_run < first_run) drop(i, past, retired);
}

void Histories::drop(std::size_t index, Past& past, std::vector<gpu::Image>& retired) {
  Pair& pair = *pairs_[index];
  for (gpu::Image& image : pair.images) {
    past.forget_object(object_of(image));
    retired.push_back(std::move(image));
  }
  bytes_ -= pair.bytes;
  pairs_.erase(pairs_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Histories::drop_all(std::vector<gpu::Image>& retired) {
  for (const auto& pair : pairs_)
    for (gpu::Image& image : pair->images) retired.push_back(std::move(image));
  pairs_.clear();
  bytes_ = 0;
}

}  // namespace neritic::graph
