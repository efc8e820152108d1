#include "random_graph.hpp"

#include <algorithm>
#include <iterator>

#include "engine/core/random.hpp"

namespace neritic::graph {
namespace {

constexpr Access kImageReads[] = {Access::kDepthTest,           Access::kDepthTestAndSampled,
                                  Access::kSampledVertex,       Access::kSampledFragment,
                                  Access::kSampledCompute,      Access::kStorageReadCompute,
                                  Access::kStorageReadFragment, Access::kTransferRead};
constexpr Access kImageWrites[] = {Access::kColorAttachment, Access::kDepthAttachment,
                                   Access::kStorageWriteCompute, Access::kTransferWrite};
constexpr Access kBufferReads[] = {Access::kStorageReadCompute,  Access::kStorageReadVertex,
                                   Access::kStorageReadFragment, Access::kVertexBuffer,
                                   Access::kIndexBuffer,         Access::kIndirectBuffer,
                                   Access::kTransferRead};
constexpr Access kBufferWrites[] = {Access::kStorageWriteCompute, Access::kTexelWriteCompute,
                                    Access::kTransferWrite};

struct Import {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
};
constexpr Import kImports[] = {
    {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
     VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
    {0, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
     VK_IMAGE_LAYOUT_GENERAL},
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : key_{seed, 7, 0} {}

  RandomGraph run() {
    const std::uint32_t resources = 2 + below(15), passes = 1 + below(20);
    for (std::uint32_t r = 0; r < resources; ++r) add_resource(r);
    for (std::uint32_t p = 0; p < passes; ++p) add_pass(p);
    add_outputs();
    return std::move(result_);
  }

 private:
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(random_bits(key_, index_++) % n);
  }
  bool chance(std::uint32_t percent) { return below(100) < percent; }
  template <class T, std::size_t N>
  T pick(const T (&list)[N]) {
    return list[below(N)];
  }

  bool image(std::uint32_t r) const { return decl(r).kind == ResourceKind::kImage; }
  const ResourceDecl& decl(std::uint32_t r) const { return result_.maker.graph.resources[r]; }

  void add_resource(std::uint32_t r) {
    GraphMaker& maker = result_.maker;
    const std::string name = "r" + std::to_string(r);
    const bool is_image = chance(60), imported = chance(25);
    const Import import = pick(kImports);
    if (imported) {
      is_image ? maker.imported_image(name, import.stages, import.access, import.layout)
               : maker.imported_buffer(name, import.stages, import.access);
    } else {
      is_image ? maker.image(name) : maker.buffer(name);
    }
    if (is_image && chance(15)) {
      maker.graph.resources[r].mips = 1 + below(2);
      maker.graph.resources[r].layers = 1 + below(2);
    }
    version_.push_back(0);
    const bool filled = imported && (!is_image || import.layout != VK_IMAGE_LAYOUT_UNDEFINED);
    changed_.push_back(std::vector<int>(decl(r).mips * decl(r).layers, filled ? 0 : kEmpty));
    result_.needs.push_back({1 + below(5000), std::uint64_t{1} << below(9),
                             (is_image ? 2u : 0u) + (chance(20) ? 1u : 0u)});
  }

  void add_pass(std::uint32_t p) {
    PassDecl pass{"p" + std::to_string(p), {}, chance(10)};
    const std::uint32_t wanted = 1 + below(4);
    std::vector<std::uint32_t> taken;
    for (std::uint32_t i = 0; i < wanted; ++i) {
      const std::uint32_t r = below(static_cast<std::uint32_t>(version_.size()));
      if (std::find(taken.begin(), taken.end(), r) != taken.end()) continue;
      taken.push_back(r);
      add_uses(pass, r);
    }
    for (const Use& u : pass.uses) {
      if (!access_info(u.access).write) continue;
      ++version_[u.resource];
      visit(u.resource, u.range, [&](int& at) { at = static_cast<int>(version_[u.resource]); });
    }
    result_.maker.graph.passes.push_back(std::move(pass));
  }

  template <class F>
  void visit(std::uint32_t r, const ImageRange& range, F&& f) {
    const ImageRange part = range.within(decl(r).mips, decl(r).layers);
    for (std::uint32_t m = part.mip; m < part.mip + part.mips; ++m)
      for (std::uint32_t l = part.layer; l < part.layer + part.layers; ++l)
        f(changed_[r][m * decl(r).layers + l]);
  }

  // The newest version in which something of the part changed; kEmpty where some of it is empty.
  int newest_change(std::uint32_t r, const ImageRange& range) {
    int newest = 0;
    bool empty = false;
    visit(r, range, [&](int& at) {
      empty |= at == kEmpty;
      newest = std::max(newest, at);
    });
    return empty ? kEmpty : newest;
  }

  ImageRange some_part(std::uint32_t r) {
    ImageRange part;
    if (decl(r).mips > 1 && chance(60)) part.mip = below(decl(r).mips), part.mips = 1;
    if (decl(r).layers > 1 && chance(60)) part.layer = below(decl(r).layers), part.layers = 1;
    return part.within(decl(r).mips, decl(r).layers);
  }

  void add_uses(PassDecl& pass, std::uint32_t r) {
    const ImageRange part = some_part(r);
    const int newest = newest_change(r, part);
    if (newest == kEmpty || !chance(60)) {
      add_write(pass, r, part);
      return;
    }
    // Any version since the part changed will do.
    const auto since = static_cast<std::uint32_t>(newest);
    const std::uint32_t v = since + below(version_[r] - since + 1);
    const Access access = image(r) ? pick(kImageReads) : pick(kBufferReads);
    pass.uses.push_back({r, v, access, part});
    // A second read in the same pass, where the layout allows.
    const Access second = image(r) ? pick(kImageReads) : pick(kBufferReads);
    if (chance(30) && (!image(r) || access_info(second).layout == access_info(access).layout))
      pass.uses.push_back({r, v, second, part});
    const ImageRange other = some_part(r);
    if (!other.overlaps(part) && chance(60)) add_write(pass, r, other);
  }

  void add_write(PassDecl& pass, std::uint32_t r, const ImageRange& part) {
    const Access access = image(r) ? pick(kImageWrites) : pick(kBufferWrites);
    if (newest_change(r, part) != kEmpty && access == Access::kStorageWriteCompute && chance(30))
      pass.uses.push_back({r, version_[r], Access::kStorageReadCompute, part});
    pass.uses.push_back({r, version_[r], access, part});
  }

  void add_outputs() {
    for (std::uint32_t r = 0; r < version_.size(); ++r) {
      if (newest_change(r, {}) == kEmpty || !chance(20)) continue;
      Access access = image(r) ? pick(kImageReads) : pick(kBufferReads);
      if (chance(30) && !image(r)) access = Access::kHostRead;
      if (chance(30) && image(r) && decl(r).imported) access = Access::kPresent;
      result_.maker.output(r, version_[r], access);
    }
  }

  RandomKey key_;
  std::uint64_t index_ = 0;
  RandomGraph result_;
  std::vector<std::uint32_t> version_;
  static constexpr int kEmpty = -1;
  std::vector<std::vector<int>> changed_;  // by resource, mip, layer: the version that changed it
};

}  // namespace

RandomGraph random_graph(std::uint64_t seed) {
  return Draw(seed).run();
}

}  // namespace neritic::graph
