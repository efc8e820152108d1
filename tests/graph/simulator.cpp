#include "simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace neritic::graph {
namespace {

// The meaning of ALL_COMMANDS and MEMORY_* here: every bit an Access can have. HOST is no command.
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

// A stretch of memory: one mip and layer of each resource that has it in each run, or of one object
// outside of the frames. It is walked through all runs.
class Cell {
 public:
  Cell(std::span<const PlanRun> runs, std::vector<std::vector<Member>> members,
       std::vector<std::string>& hazards)
      : runs_(runs), members_by_run_(std::move(members)), hazards_(hazards) {}

  void walk() {
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      plan_ = &runs_[i].plan;
      members_ = members_by_run_[i];
      if (members_.empty()) continue;
      start();
      walk_plan();
      base_ += static_cast<std::uint32_t>(plan_->order.size()) + 1;
    }
  }

 private:
  void start() {
    owner_ = ~0u;
    version_ = kGarbage;
    const ResourceDecl& r = plan_->graph.resources[members_.front().resource];
    if (!r.imported) return;
    owner_ = members_.front().resource;
    if (seen_) {
      version_ = 0;
    } else {
      start_imported(r);
    }
    seen_ = true;
  }

  void walk_plan() {
    const auto end = static_cast<std::uint32_t>(plan_->order.size());
    for (std::uint32_t position = 0; position < end; ++position) {
      apply_all(position);
      const PassDecl& pass = plan_->graph.passes[plan_->order[position]];
      for (const Use& u : pass.uses)
        if (!access_info(u.access).write) access(u, pass.name, base_ + position);
      for (const Use& u : pass.uses)
        if (access_info(u.access).write) access(u, pass.name, base_ + position);
    }
    apply_all(end);
    for (const Use& u : plan_->graph.outputs) access(u, "output", base_ + end);
  }

  void apply_all(std::uint32_t position) {
    for (const Barrier& barrier : plan_->barriers.first[position]) apply(barrier, position);
    for (const Barrier& barrier : plan_->barriers.before[position]) apply(barrier, position);
  }

  bool has(std::uint32_t resource, const ImageRange& range) const {
    return std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
      return member.resource == resource && touches(*plan_, range, member);
    });
  }

  // The newest version up to the use's in which a declared write changed this mip and layer.
  std::uint32_t expected_version(const Use& u) const {
    std::uint32_t newest = 0;
    for (const PassDecl& pass : plan_->graph.passes)
      for (const Use& w : pass.uses)
        if (w.resource == u.resource && access_info(w.access).write && w.version < u.version &&
            has(w.resource, w.range))
          newest = std::max(newest, w.version + 1);
    return newest;
  }

  void start_imported(const ResourceDecl& decl) {
    layout_ = decl.initial_layout;
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
    const ResourceDecl& decl = plan_->graph.resources[barrier.resource];
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
    const ResourceDecl& decl = plan_->graph.resources[u.resource];
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
  std::span<const PlanRun> runs_;
  std::vector<std::vector<Member>> members_by_run_;
  std::vector<std::string>& hazards_;
  // State of the run that is walked.
  const Plan* plan_ = nullptr;
  std::vector<Member> members_;
  std::uint32_t base_ = 0;  // positions of the runs before
  bool seen_ = false;       // the object was there in a run before
  std::vector<Touch> touches_;
  std::uint32_t owner_ = ~0u;
  std::int64_t version_ = kGarbage;
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_UNDEFINED;
};

// Where a run's resources lie: by memory class and byte, or by object.
using Where = std::pair<std::uint64_t, std::uint64_t>;
constexpr std::uint64_t kObjects = ~std::uint64_t{0};  // instead of a memory class

bool is_at(const PlanRun& run, std::uint32_t r, const Where& where) {
  const auto& [memory_class, at] = where;
  if (run.plan.graph.resources[r].imported) return memory_class == kObjects && run.objects[r] == at;
  if (!run.plan.lifetimes[r].used()) return false;
  const MemoryNeed& need = run.plan.needs[r];
  const std::uint64_t begin = run.plan.placement.offset[r];
  return memory_class == run.classes[need.memory_class] && begin <= at && at < begin + need.size;
}

// Cuts memory at every begin and end: between two cuts it is the same to all bytes.
std::set<Where> places(std::span<const PlanRun> runs) {
  std::set<Where> all;
  for (const PlanRun& run : runs)
    for (std::uint32_t r = 0; r < run.plan.graph.resources.size(); ++r) {
      if (run.plan.graph.resources[r].imported) {
        all.insert({kObjects, run.objects[r]});
      } else if (run.plan.lifetimes[r].used()) {
        const std::uint64_t heap = run.classes[run.plan.needs[r].memory_class];
        all.insert({heap, run.plan.placement.offset[r]});
        all.insert({heap, run.plan.placement.offset[r] + run.plan.needs[r].size});
      }
    }
  return all;
}

// A byte may be of any mip and layer of the resources that have it. Choice k takes part k of each,
// counted round; with two strides, so that parts meet in other pairs too. An object has the same
// part in all runs.
void walk_cells(std::span<const PlanRun> runs, const Where& where,
                std::vector<std::string>& hazards) {
  std::uint32_t most = 1;
  for (const PlanRun& run : runs)
    for (std::uint32_t r = 0; r < run.plan.graph.resources.size(); ++r)
      if (is_at(run, r, where))
        most =
            std::max(most, run.plan.graph.resources[r].mips * run.plan.graph.resources[r].layers);
  const std::uint32_t strides = where.first == kObjects || most == 1 ? 1 : 2;
  for (std::uint32_t k = 0; k < most; ++k)
    for (std::uint32_t stride = 0; stride < strides; ++stride) {
      std::vector<std::vector<Member>> members(runs.size());
      std::uint32_t n = k;
      for (std::size_t i = 0; i < runs.size(); ++i)
        for (std::uint32_t r = 0; r < runs[i].plan.graph.resources.size(); ++r) {
          if (!is_at(runs[i], r, where)) continue;
          const ResourceDecl& decl = runs[i].plan.graph.resources[r];
          const std::uint32_t part = n % (decl.mips * decl.layers);
          members[i].push_back({r, part / decl.layers, part % decl.layers});
          n += stride;
        }
      Cell(runs, std::move(members), hazards).walk();
    }
}

}  // namespace

std::vector<std::string> find_hazards(std::span<const PlanRun> runs) {
  std::vector<std::string> hazards;
  for (const Where& where : places(runs)) walk_cells(runs, where, hazards);
  return hazards;
}

std::vector<std::string> find_hazards(const Plan& plan) {
  PlanRun run{plan, {}, {}};
  for (std::size_t r = 0; r < plan.graph.resources.size(); ++r) run.objects.push_back(r);
  for (std::size_t c = 0; c < plan.placement.heap_size.size(); ++c) run.classes.push_back(c);
  return find_hazards(std::span(&run, 1));
}

}  // namespace neritic::graph
