// Executor: caches plans by declaration, gives the graphs in use real memory, records passes and
// barriers. The first uses of a run wait for the accesses that earlier runs left pending
// (past.hpp). Rendering thread.
#include <algorithm>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/log.hpp"
#include "engine/gpu/device.hpp"
#include "engine/graph/declaration_hash.hpp"
#include "engine/graph/frame_graph.hpp"
#include "engine/graph/histories.hpp"
#include "engine/graph/past.hpp"
#include "engine/graph/realisation.hpp"
#include "engine/graph/record_barriers.hpp"
#include "engine/graph/transient_heaps.hpp"

namespace neritic::graph {
namespace {

// Plans are small; memory is not. A program that alternates between graphs (sensors at rates of
// their own, a screenshot now and then) should allocate nothing: they share the memory of the
// largest. A graph gives up its part, and a history its images, after kRunsRemembered runs without
// it, which are some seconds.
constexpr std::size_t kPlansKept = 32;
constexpr std::uint64_t kRunsRemembered = 256;
// More imported objects than a program has at any time. Most of them must be gone, so all are
// forgotten behind a full barrier.
constexpr std::size_t kObjectsKept = 4096;

}  // namespace

struct Executor::Impl {
  struct Entry {
    std::uint64_t hash = 0;
    std::uint64_t last_use = 0;
    GraphDecl declaration;  // as declared, before usage flags are gathered
    Plan plan;
    std::vector<MemoryClass> classes;
    std::uint64_t last_run = 0;                // 0: never
    std::unique_ptr<Realisation> realisation;  // null until first run, and again without memory
  };

  explicit Impl(gpu::Frames& f) : frames(f) {}

  gpu::Frames& frames;
  std::vector<std::unique_ptr<Entry>> entries;  // stable addresses: callers hold Plan pointers
  std::uint64_t clock = 0, runs = 0;
  TransientHeaps heaps;  // what every realisation lies in
  Histories histories;
  Past past;
  std::uint64_t recording = 0;  // Frames::recording at the last run
  std::function<void(Plan&)> spoil;
  Plan spoiled;
  // Scratch, kept to allocate nothing in a frame.
  BarrierRecorder recorder;
  std::vector<const gpu::Image*> images;
  std::vector<const gpu::Buffer*> buffers;
  std::vector<std::uint64_t> objects, class_keys;

  // Objects and memory that frames in flight may still use. The objects go first.
  struct Retired {
    std::vector<gpu::Allocation> heaps;
    std::vector<std::unique_ptr<Realisation>> realisations;
    std::vector<gpu::Image> images;
  };
  void retire(Retired retired) {
    // std::function must be copyable, so the owner is shared with the copies it may make.
    auto owner = std::make_shared<Retired>(std::move(retired));
    frames.retire([owner]() mutable { owner.reset(); });
  }
  void retire(std::unique_ptr<Realisation> realisation) {
    if (!realisation) return;
    Retired retired;
    retired.realisations.push_back(std::move(realisation));
    retire(std::move(retired));
  }
  void retire(std::vector<gpu::Image> gone) {
    if (!gone.empty()) retire(Retired{{}, {}, std::move(gone)});
  }
  // All transient memory, and what lies in it.
  void retire_transients() {
    Retired retired{heaps.take(), {}, {}};
    past.forget_memory();
    for (const auto& entry : entries)
      if (entry->realisation) retired.realisations.push_back(std::move(entry->realisation));
    retire(std::move(retired));
  }

  Result<Entry*> find_or_compile(const GraphDecl& declaration) {
    const std::uint64_t hash = hash_of(declaration);
    for (const auto& entry : entries) {
      if (entry->hash != hash || entry->declaration != declaration) continue;
      entry->last_use = ++clock;
      return entry.get();
    }
    auto entry = std::make_unique<Entry>();
    entry->hash = hash;
    entry->declaration = declaration;
    const auto needs_of = [&](const GraphDecl& graph) {
      return memory_needs(frames.device(), graph, entry->classes);
    };
    NERITIC_TRY(entry->plan, graph::compile(declaration, needs_of));
    entry->last_use = ++clock;
    log_info("frame graph {}: {} of {} passes kept, {:.1f} MiB of transient memory", entries.size(),
             entry->plan.order.size(), declaration.passes.size(),
             static_cast<double>(entry->plan.placement.bytes_with_aliasing) / (1 << 20));
    if (entries.size() >= kPlansKept) evict_oldest_plan();
    entries.push_back(std::move(entry));
    return entries.back().get();
  }

  void evict_oldest_plan() {
    const auto oldest =
        std::min_element(entries.begin(), entries.end(),
                         [](const auto& a, const auto& b) { return a->last_use < b->last_use; });
    retire(std::move((*oldest)->realisation));
    entries.erase(oldest);
  }

  bool in_use(const Entry& entry) const {
    return entry.last_run > 0 && entry.last_run + kRunsRemembered >= runs;
  }

  // Objects for the entry, which runs now, in memory for the largest of the graphs in use.
  Status realise(Entry& entry) {
    entry.last_run = ++runs;
    const Status made = make_realisation(entry);
    // In use it would make every later graph ask for memory of its size.
    if (!made.ok()) entry.last_run = 0;
    return made;
  }

  Status make_realisation(Entry& entry) {
    bool changed = !entry.realisation;
    for (const auto& other : entries) {
      if (!other->realisation || in_use(*other)) continue;
      retire(std::move(other->realisation));
      changed = true;
    }
    if (!changed) return {};
    NERITIC_TRY_STATUS(fit_heaps());
    if (entry.realisation) return {};
    NERITIC_TRY(Realisation made,
                Realisation::create(frames.device(), entry.plan, entry.classes, heaps));
    entry.realisation = std::make_unique<Realisation>(std::move(made));
    return {};
  }

  // Where the memory is too small, or twice too large, all of it is made anew: graphs in use get
  // their objects again when they run.
  Status fit_heaps() {
    std::vector<TransientHeaps::Need> needs;
    for (const auto& entry : entries)
      if (in_use(*entry))
        // Classes of which only culled passes have something come last and have no heap.
        for (std::size_t c = 0; c < entry->plan.placement.heap_size.size(); ++c)
          TransientHeaps::add(needs, entry->classes[c], entry->plan.placement.heap_size[c]);
    if (heaps.fit(needs)) return {};
    retire_transients();
    return heaps.allocate(frames.device().allocator(), needs);
  }

  // The object behind every resource in this frame: imports may move between equal declarations.
  void resolve(const FrameGraph& graph, const Realisation& realisation) {
    images = graph.imported_images_;
    buffers = graph.imported_buffers_;
    for (const HistoryDecl& history : graph.histories_) {
      images[history.last] = &histories.last(history.name);
      images[history.next] = &histories.next(history.name);
    }
    objects.assign(images.size(), 0);
    for (std::size_t r = 0; r < images.size(); ++r) {
      if (images[r]) objects[r] = object_of(*images[r]);
      if (buffers[r]) objects[r] = object_of(*buffers[r]);
      if (realisation.images()[r]) images[r] = &realisation.images()[r];
      if (realisation.buffers()[r]) buffers[r] = &realisation.buffers()[r];
    }
  }

  // The past must describe what the GPU will have executed: if a recording was dropped, its changes
  // to the past are undone.
  void check_past(VkCommandBuffer cmd) {
    const bool dropped =
        recording != 0 && !frames.was_submitted(recording) && frames.recording() != recording;
    std::vector<gpu::Image> gone;
    if (dropped) histories.rewind(recording, past, gone);
    const bool crowded = past.object_count() > kObjectsKept;
    if (crowded) past.settle();
    if (dropped || crowded) gpu::record_full_barrier(cmd);
    recording = frames.recording();
    if (runs > kRunsRemembered) histories.drop_unused(runs - kRunsRemembered, past, gone);
    retire(std::move(gone));
  }

  // The histories of the graph, with their clears recorded where they are new.
  Status prepare_histories(const FrameGraph& graph, VkCommandBuffer cmd) {
    std::vector<gpu::Image> gone;
    const Status made =
        histories.prepare(frames.device(), graph.histories_, recording, runs, cmd, past, gone);
    retire(std::move(gone));
    return made;
  }

  // The barriers before the plan's first uses in this run.
  void start(Entry& entry) {
    class_keys.clear();
    for (const MemoryClass& c : entry.classes)
      class_keys.push_back(std::uint64_t{c.memory_type_bits} << 1 |
                           (c.kind == ResourceKind::kImage ? 1 : 0));
    past.run(entry.plan, objects, class_keys, entry.plan.barriers.first);
  }

  // The views of parts that the kept passes name, so that recording cannot fail.
  Status make_part_views(const Plan& plan) {
    constexpr VkImageUsageFlags kCopies =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    for (const std::uint32_t pass : plan.order)
      for (const Use& use : plan.graph.passes[pass].uses)
        if (images[use.resource] && (access_info(use.access).image_usage & ~kCopies) != 0)
          NERITIC_TRY_STATUS(images[use.resource]->view_of(use.range));
    return {};
  }

  void record(FrameGraph& graph, const Plan& plan, gpu::Commands& commands) {
    const VkCommandBuffer cmd = commands.handle();
    for (std::size_t position = 0; position < plan.order.size(); ++position) {
      const std::uint32_t pass = plan.order[position];
      commands.begin_region(plan.graph.passes[pass].name);
      record_barriers(cmd, plan, position);
      PassContext context(commands, graph.id_, plan.graph.passes[pass], images, buffers);
      graph.records_[pass](context);
      commands.end_region();
    }
    record_barriers(cmd, plan, plan.order.size());
  }
  void record_barriers(VkCommandBuffer cmd, const Plan& plan, std::size_t position) {
    recorder.record(cmd, plan.barriers.first[position], plan.barriers.before[position], images,
                    buffers);
  }
};

Executor::Executor(gpu::Frames& frames) : impl_(std::make_unique<Impl>(frames)) {}

Executor::~Executor() {
  impl_->retire_transients();
  std::vector<gpu::Image> gone;
  impl_->histories.drop_all(gone);
  impl_->retire(std::move(gone));
}

Result<const Plan*> Executor::compile(const FrameGraph& graph) {
  NERITIC_TRY(Impl::Entry* const entry, impl_->find_or_compile(graph.declaration()));
  return &entry->plan;
}

Result<const Plan*> Executor::run(FrameGraph& graph, gpu::Commands& commands) {
  NERITIC_TRY(Impl::Entry* const entry, impl_->find_or_compile(graph.declaration()));
  NERITIC_TRY_STATUS(impl_->realise(*entry));
  impl_->check_past(commands.handle());
  NERITIC_TRY_STATUS(impl_->prepare_histories(graph, commands.handle()));
  impl_->resolve(graph, *entry->realisation);
  NERITIC_TRY_STATUS(impl_->make_part_views(entry->plan));
  impl_->start(*entry);
  const Plan* plan = &entry->plan;
  if (impl_->spoil) {
    impl_->spoiled = *plan;
    impl_->spoil(impl_->spoiled);
    plan = &impl_->spoiled;
  }
  impl_->record(graph, *plan, commands);
  impl_->histories.advance(graph.histories_, *plan);
  return plan;
}

std::uint64_t Executor::history_bytes() const {
  return impl_->histories.bytes();
}

std::uint64_t Executor::transient_bytes() const {
  return impl_->heaps.bytes();
}

void Executor::spoil_plans_for_test(std::function<void(Plan&)> spoil) {
  impl_->spoil = std::move(spoil);
}

}  // namespace neritic::graph
