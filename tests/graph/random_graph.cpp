#include "random_graph.hpp"

#include <algorithm>
#include <iterator>

#include "engine/core/random.hpp"

namespace neritic::graph {
namespace {

constexpr Access kImageReads[] = {Access::kDepthTest,           Access::kSampledFragment,
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
    version_.push_back(0);
    filled_.push_back(imported && (!is_image || import.layout != VK_IMAGE_LAYOUT_UNDEFINED));
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
      filled_[u.resource] = true;
    }
    result_.maker.graph.passes.push_back(std::move(pass));
  }

  void add_uses(PassDecl& pass, std::uint32_t r) {
    const std::uint32_t v = version_[r];
    if (filled_[r] && chance(60)) {
      const Access access = image(r) ? pick(kImageReads) : pick(kBufferReads);
      pass.uses.push_back({r, v, access});
      // A second read in the same pass, where the layout allows.
      const Access second = image(r) ? pick(kImageReads) : pick(kBufferReads);
      if (chance(30) && (!image(r) || access_info(second).layout == access_info(access).layout))
        pass.uses.push_back({r, v, second});
      return;
    }
    const Access access = image(r) ? pick(kImageWrites) : pick(kBufferWrites);
    if (filled_[r] && access == Access::kStorageWriteCompute && chance(30))
      pass.uses.push_back({r, v, Access::kStorageReadCompute});
    pass.uses.push_back({r, v, access});
  }

  void add_outputs() {
    for (std::uint32_t r = 0; r < version_.size(); ++r) {
      if (!filled_[r] || !chance(20)) continue;
      Access access = image(r) ? pick(kImageReads) : pick(kBufferReads);
      if (chance(30)) access = image(r) ? Access::kPresent : Access::kHostRead;
      result_.maker.output(r, version_[r], access);
    }
  }

  RandomKey key_;
  std::uint64_t index_ = 0;
  RandomGraph result_;
  std::vector<std::uint32_t> version_;
  std::vector<bool> filled_;
};

}  // namespace

RandomGraph random_graph(std::uint64_t seed) {
  return Draw(seed).run();
}

}  // namespace neritic::graph
