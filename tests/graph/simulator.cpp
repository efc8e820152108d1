#include "simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace neritic::graph {
namespace {

// What ALL_COMMANDS and MEMORY_* stand for here: every bit an Access can have. HOST is no command.
constexpr VkPipelineStageFlags2 kHost = VK_PIPELINE_STAGE_2_HOST_BIT;

VkPipelineStageFlags2 every_stage() {
  VkPipelineStageFlags2 stages = 0;
  for (int a = 0; a <= static_cast<int>(Access::kPresent); ++a)
    stages |= access_info(static_cast<Access>(a)).stages;
  return stages & ~kHost;
}

VkPipelineStageFlags2 expand_stages(VkPipelineStageFlags2 stages) {
  return stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT ? stages | every_stage() : stages;
}

constexpr VkAccessFlags2 kWrites =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;

VkAccessFlags2 expand_access(VkAccessFlags2 access) {
  constexpr VkAccessFlags2 kBoth = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkAccessFlags2 reads = 0;
  for (int a = 0; a <= static_cast<int>(Access::kPresent); ++a)
    reads |= access_info(static_cast<Access>(a)).access & ~kWrites;
  if (access & VK_ACCESS_2_MEMORY_WRITE_BIT) access |= kWrites;
  if (access & VK_ACCESS_2_MEMORY_READ_BIT) access |= reads;
  return access & ~kBoth;
}

// Stages and accesses that see a write.
struct Sight {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
};

// Something that touched the memory, at one stage.
struct Touch {
  std::string who;
  std::uint32_t position;
  VkPipelineStageFlags2 stage = 0;  // one bit; 0: a layout transition, or something long ago
  VkAccessFlags2 writes = 0;        // write bits; 0 for a pure read
  bool is_write = false;
  VkPipelineStageFlags2 before = 0;  // stages of later commands that come after it
  bool available = false;
  std::vector<Sight> seen_by;

  bool reached_by(VkPipelineStageFlags2 src) const { return ((stage | before) & src) != 0; }
  bool seen(VkPipelineStageFlags2 at, VkAccessFlags2 access) const {
    VkAccessFlags2 known = 0;
    for (const Sight& sight : seen_by)
      if (sight.stages & at) known |= sight.access;
    return (access & ~known) == 0;
  }
};

// One mip and layer of a resource.
struct Member {
  std::uint32_t resource, mip, layer;
};

bool touches(const Plan& plan, const ImageRange& range, const Member& member) {
  const ResourceDecl& r = plan.graph.resources[member.resource];
  const ImageRange part = range.within(r.mips, r.layers);
  return member.mip - part.mip < part.mips && member.layer - part.layer < part.layers;
}

// A stretch of memory that is one mip and layer of each resource that has it, or of one import.
class Cell {
 public:
  Cell(const Plan& plan, std::vector<Member> members, std::vector<std::string>& hazards)
      : plan_(plan), members_(std::move(members)), hazards_(hazards) {
    const ResourceDecl& r = plan.graph.resources[members_.front().resource];
    if (r.imported) {
      start_imported(members_.front().resource, r);
    } else {
      start_transient();
    }
  }

  void run() {
    const auto end = static_cast<std::uint32_t>(plan_.order.size());
    for (std::uint32_t position = 0; position < end; ++position) {
      for (const Barrier& barrier : plan_.barriers.before[position]) apply(barrier, position);
      const PassDecl& pass = plan_.graph.passes[plan_.order[position]];
      for (const Use& u : pass.uses)
        if (!access_info(u.access).write) access(u, pass.name, position);
      for (const Use& u : pass.uses)
        if (access_info(u.access).write) access(u, pass.name, position);
    }
    for (const Barrier& barrier : plan_.barriers.at_end) apply(barrier, end);
    for (const Use& u : plan_.graph.outputs) access(u, "output", end);
  }

 private:
  bool has(std::uint32_t resource, const ImageRange& range) const {
    return std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
      return member.resource == resource && touches(plan_, range, member);
    });
  }

  // The newest version up to the use's in which a declared write changed this mip and layer.
  std::uint32_t expected_version(const Use& u) const {
    std::uint32_t newest = 0;
    for (const PassDecl& pass : plan_.graph.passes)
      for (const Use& w : pass.uses)
        if (w.resource == u.resource && access_info(w.access).write && w.version < u.version &&
            has(w.resource, w.range))
          newest = std::max(newest, w.version + 1);
    return newest;
  }

  // The frame before may have done anything here; the frame's opening barrier has covered it.
  void start_transient() {
    for (VkPipelineStageFlags2 left = every_stage(); left; left &= left - 1) {
      Touch touch{"the frame before", ~0u};
      touch.stage = left & ~(left - 1);
      touch.writes = kWrites;
      touch.is_write = touch.available = true;
      touch.before = every_stage();
      touch.seen_by = {{every_stage(),
                        expand_access(VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT)}};
      touches_.push_back(touch);
    }
  }

  void start_imported(std::uint32_t resource, const ResourceDecl& decl) {
    layout_ = decl.initial_layout;
    owner_ = resource;
    const bool image = decl.kind == ResourceKind::kImage;
    version_ = image && layout_ == VK_IMAGE_LAYOUT_UNDEFINED ? kGarbage : 0;
    const VkAccessFlags2 access = expand_access(decl.initial_access);
    const VkPipelineStageFlags2 stages = expand_stages(decl.initial_stages);
    for (VkPipelineStageFlags2 left = stages; left; left &= left - 1) {
      Touch touch{"before the frame", ~0u};
      touch.stage = left & ~(left - 1);
      touch.writes = access & kWrites;
      touch.is_write = touch.writes != 0;
      touches_.push_back(touch);
    }
    if (stages != 0 && (access & kWrites) == 0) {
      // Read so far: whoever wrote it is seen by those reads, and by nobody else yet.
      Touch written{"the import's writer", ~0u};
      written.is_write = written.available = true;
      written.before = stages;
      written.seen_by = {{stages, access}};
      touches_.push_back(written);
    }
  }

  void apply(const Barrier& barrier, std::uint32_t position) {
    if (!has(barrier.resource, barrier.range)) return;
    const ResourceDecl& decl = plan_.graph.resources[barrier.resource];
    const VkPipelineStageFlags2 src = expand_stages(barrier.src_stages);
    const VkPipelineStageFlags2 dst = expand_stages(barrier.dst_stages);
    const VkAccessFlags2 src_access = expand_access(barrier.src_access);
    const VkAccessFlags2 dst_access = expand_access(barrier.dst_access);
    const bool transition = decl.kind == ResourceKind::kImage &&
                            (barrier.old_layout != barrier.new_layout || barrier.discards);
    const std::string who = fmt::format("barrier on \"{}\" at {}", decl.name, position);
    for (Touch& touch : touches_) {
      const bool reached = touch.reached_by(src);
      if (reached) {
        if ((touch.stage & src) && (touch.writes & ~src_access) == 0) touch.available = true;
        touch.before |= dst;
        if (touch.is_write && touch.available) touch.seen_by.push_back({dst, dst_access});
      }
      if (!transition) continue;
      if (!reached) complain("{} changes the layout before {} is done", who, touch.who);
      if (touch.is_write && !touch.available)
        complain("{} changes the layout before {} is available", who, touch.who);
    }
    if (!transition) return;
    if (barrier.old_layout != VK_IMAGE_LAYOUT_UNDEFINED &&
        (owner_ != barrier.resource || layout_ != barrier.old_layout))
      complain("{} expects layout {}, it is {}", who, barrier.old_layout, layout_);
    if (barrier.old_layout == VK_IMAGE_LAYOUT_UNDEFINED) version_ = kGarbage;
    owner_ = barrier.resource;
    layout_ = barrier.new_layout;
    Touch changed{who, position};
    changed.is_write = changed.available = true;
    changed.before = dst;
    changed.seen_by = {{dst, dst_access}};
    touches_ = {changed};  // it came after all of them, and later commands have to come after it
  }

  void access(const Use& u, const std::string& who, std::uint32_t position) {
    if (!has(u.resource, u.range)) return;
    const ResourceDecl& decl = plan_.graph.resources[u.resource];
    const AccessInfo& info = access_info(u.access);
    check_contents(u, decl, who, info);
    std::vector<Touch> mine;
    for (VkPipelineStageFlags2 left = info.stages; left; left &= left - 1) {
      const VkPipelineStageFlags2 stage = left & ~(left - 1);
      for (const Touch& touch : touches_) check_pair(touch, stage, info, decl, who, position);
      Touch touch{fmt::format("\"{}\" ({})", who, info.name), position};
      touch.stage = stage;
      touch.writes = info.access & kWrites;
      touch.is_write = info.write;
      mine.push_back(touch);
    }
    touches_.insert(touches_.end(), mine.begin(), mine.end());
    if (info.write) {
      owner_ = u.resource;
      version_ = static_cast<std::int64_t>(u.version) + 1;
    }
  }

  void check_contents(const Use& u, const ResourceDecl& decl, const std::string& who,
                      const AccessInfo& info) {
    if (decl.kind == ResourceKind::kImage && (owner_ != u.resource || layout_ != info.layout))
      complain("\"{}\" needs \"{}\" in layout {}, it is {}", who, decl.name, info.layout, layout_);
    const std::uint32_t expected = expected_version(u);
    const bool starts_empty = expected == 0 && info.write;
    const bool there = owner_ == u.resource && version_ == static_cast<std::int64_t>(expected);
    if (!there && !starts_empty)
      complain("\"{}\" expects version {} of \"{}\", which is not there", who, u.version,
               decl.name);
  }

  void check_pair(const Touch& touch, VkPipelineStageFlags2 stage, const AccessInfo& info,
                  const ResourceDecl& decl, const std::string& who, std::uint32_t position) {
    if (touch.position == position && touch.stage != 0) return;  // the pass's own accesses
    if (!touch.is_write && !info.write) return;
    if ((touch.before & stage) == 0)
      complain("\"{}\" uses \"{}\" ({}) before {} is done", who, decl.name, info.name, touch.who);
    else if (touch.is_write && !touch.available)
      complain("\"{}\" uses \"{}\" ({}): {} is not available", who, decl.name, info.name,
               touch.who);
    else if (touch.is_write && !touch.seen(stage, info.access))
      complain("\"{}\" uses \"{}\" ({}): {} is not visible to it", who, decl.name, info.name,
               touch.who);
  }

  template <class... Args>
  void complain(fmt::format_string<Args...> format, Args&&... args) {
    hazards_.push_back(fmt::format(format, std::forward<Args>(args)...));
  }

  static constexpr std::int64_t kGarbage = -1;
  const Plan& plan_;
  std::vector<Member> members_;
  std::vector<std::string>& hazards_;
  std::vector<Touch> touches_;
  std::uint32_t owner_ = ~0u;
  std::int64_t version_ = kGarbage;
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
};

}  // namespace

std::vector<std::string> find_hazards(const Plan& plan) {
  std::vector<std::string> hazards;
  // A byte of memory may be of any mip and layer of each resource that has it: every combination.
  const auto run_cells = [&](const std::vector<std::uint32_t>& sharing) {
    std::vector<std::vector<Member>> all{{}};
    for (const std::uint32_t r : sharing) {
      std::vector<std::vector<Member>> more;
      for (const std::vector<Member>& members : all)
        for (std::uint32_t m = 0; m < plan.graph.resources[r].mips; ++m)
          for (std::uint32_t l = 0; l < plan.graph.resources[r].layers; ++l) {
            more.push_back(members);
            more.back().push_back({r, m, l});
          }
      all = std::move(more);
    }
    for (std::vector<Member>& members : all) Cell(plan, std::move(members), hazards).run();
  };
  std::vector<std::uint32_t> transients;
  for (std::uint32_t r = 0; r < plan.graph.resources.size(); ++r) {
    if (plan.graph.resources[r].imported) {
      run_cells({r});
    } else if (plan.lifetimes[r].used()) {
      transients.push_back(r);
    }
  }
  // Cut each class's memory at every begin and end: between two cuts it is the same to all bytes.
  std::set<std::pair<std::uint32_t, std::uint64_t>> cuts;
  for (const std::uint32_t r : transients) {
    const MemoryNeed& need = plan.needs[r];
    cuts.insert({need.memory_class, plan.placement.offset[r]});
    cuts.insert({need.memory_class, plan.placement.offset[r] + need.size});
  }
  for (const auto& [memory_class, byte] : cuts) {
    std::vector<std::uint32_t> sharing;
    for (const std::uint32_t r : transients) {
      const std::uint64_t begin = plan.placement.offset[r];
      if (plan.needs[r].memory_class == memory_class && begin <= byte &&
          byte < begin + plan.needs[r].size)
        sharing.push_back(r);
    }
    if (!sharing.empty()) run_cells(sharing);
  }
  return hazards;
}

}  // namespace neritic::graph
