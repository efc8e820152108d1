// See epochs.hpp.
#include "engine/graph/epochs.hpp"

#include <algorithm>
#include <optional>

namespace neritic::graph {
namespace {

// Where the uses of one image cut its mips and layers; each list starts with 0 and ends with the
// count.
struct Cuts {
  std::vector<std::uint32_t> mips, layers;
};

void add_cut(std::vector<std::uint32_t>& cuts, std::uint32_t at) {
  const auto place = std::lower_bound(cuts.begin(), cuts.end(), at);
  if (place == cuts.end() || *place != at) cuts.insert(place, at);
}

// All uses of one part by one pass, as one.
struct Combined {
  std::uint32_t part = 0;
  Epoch epoch;
};

class Finder {
 public:
  Finder(const GraphDecl& graph, std::span<const std::uint32_t> order)
      : graph_(graph), order_(order) {}

  std::vector<Part> run() {
    make_parts();
    for (std::uint32_t position = 0; position < order_.size(); ++position)
      add_uses(graph_.passes[order_[position]].uses, position);
    add_uses(graph_.outputs, static_cast<std::uint32_t>(order_.size()));
    return std::move(parts_);
  }

 private:
  void make_parts() {
    const std::size_t count = graph_.resources.size();
    std::vector<Cuts> cuts(count);
    for (std::size_t r = 0; r < count; ++r)
      cuts[r] = {{0, graph_.resources[r].mips}, {0, graph_.resources[r].layers}};
    const auto cut = [&](const Use& use) {
      const ImageRange range = range_of(graph_, use);
      add_cut(cuts[use.resource].mips, range.mip);
      add_cut(cuts[use.resource].mips, range.mip + range.mips);
      add_cut(cuts[use.resource].layers, range.layer);
      add_cut(cuts[use.resource].layers, range.layer + range.layers);
    };
    for (const std::uint32_t pass : order_)
      for (const Use& use : graph_.passes[pass].uses) cut(use);
    for (const Use& use : graph_.outputs) cut(use);
    first_.reserve(count + 1);
    for (std::uint32_t r = 0; r < count; ++r) {
      first_.push_back(parts_.size());
      const auto &mips = cuts[r].mips, &layers = cuts[r].layers;
      for (std::size_t m = 0; m + 1 < mips.size(); ++m)
        for (std::size_t l = 0; l + 1 < layers.size(); ++l)
          parts_.push_back(
              {r, {mips[m], mips[m + 1] - mips[m], layers[l], layers[l + 1] - layers[l]}, {}});
    }
    first_.push_back(parts_.size());
  }

  void add_uses(std::span<const Use> uses, std::uint32_t position) {
    combined_.clear();
    for (const Use& use : uses) {
      const ImageRange range = range_of(graph_, use);
      for (std::size_t p = first_[use.resource]; p < first_[use.resource + 1]; ++p)
        if (range.contains(parts_[p].range)) combine(static_cast<std::uint32_t>(p), use, position);
    }
    for (const Combined& use : combined_) append(parts_[use.part].epochs, use.epoch);
  }

  void combine(std::uint32_t part, const Use& use, std::uint32_t position) {
    const AccessInfo& info = access_info(use.access);
    const bool image = graph_.resources[use.resource].kind == ResourceKind::kImage;
    const VkImageLayout layout = image ? info.layout : VK_IMAGE_LAYOUT_UNDEFINED;
    const auto same = std::find_if(combined_.begin(), combined_.end(),
                                   [part](const Combined& other) { return other.part == part; });
    if (same == combined_.end()) {
      combined_.push_back({part, {position, info.stages, info.access, layout, info.write}});
      return;
    }
    same->epoch.stages |= info.stages;
    same->epoch.access |= info.access;
    if (info.write) same->epoch.layout = layout;  // a write's layout serves the reads it subsumes
    same->epoch.write |= info.write;
  }

  static void append(std::vector<Epoch>& epochs, const Epoch& use) {
    if (!use.write && !epochs.empty()) {
      Epoch& last = epochs.back();
      if (!last.write && last.layout == use.layout) {
        last.stages |= use.stages;
        last.access |= use.access;
        return;
      }
    }
    epochs.push_back(use);
  }

  const GraphDecl& graph_;
  std::span<const std::uint32_t> order_;
  std::vector<Part> parts_;
  std::vector<std::size_t> first_;  // by resource: its first part
  std::vector<Combined> combined_;  // scratch
};

}  // namespace

std::vector<Part> find_parts(const GraphDecl& graph, std::span<const std::uint32_t> order) {
  return Finder(graph, order).run();
}

}  // namespace neritic::graph
