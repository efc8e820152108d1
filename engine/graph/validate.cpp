// First stage: refuses a declaration that has no single meaning. Handles only go forward: a pass
// writes over the newest version, and reads what no pass declared before it has replaced, so
// declaration order is always one valid order, and each later stage can rely on that. Pure; any
// thread.
#include <algorithm>
#include <bit>

#include "engine/graph/access.hpp"
#include "engine/graph/names.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {
namespace {

// One write of a resource, by a pass declared so far. Write v made version v + 1.
struct Write {
  std::uint32_t pass = 0;
  ImageRange range;
};

// A wrong declaration is our bug, never the user's.
template <class... Args>
Error graph_bug(fmt::format_string<Args...> format, Args&&... args) {
  return failure(ErrorCode::kInternal, "frame graph: {}",
                 fmt::format(format, std::forward<Args>(args)...));
}

class Validator {
 public:
  explicit Validator(const GraphDecl& graph) : graph_(graph), writes_(graph.resources.size()) {}

  Status run() {
    for (const ResourceDecl& resource : graph_.resources) {
      NERITIC_TRY_STATUS(check_resource(resource));
    }
    for (std::uint32_t p = 0; p < graph_.passes.size(); ++p) {
      NERITIC_TRY_STATUS(check_pass(p));
    }
    return check_outputs();
  }

 private:
  static Status check_resource(const ResourceDecl& resource) {
    if (resource.kind == ResourceKind::kBuffer) return {};
    if (resource.format == VK_FORMAT_UNDEFINED)
      return graph_bug("image \"{}\" has no format", resource.name);
    if (resource.width == 0 || resource.height == 0 || resource.layers == 0 || resource.mips == 0)
      return graph_bug("image \"{}\" is {}x{} with {} layers and {} mips, all must be at least 1",
                       resource.name, resource.width, resource.height, resource.layers,
                       resource.mips);
    const auto most =
        static_cast<std::uint32_t>(std::bit_width(std::max(resource.width, resource.height)));
    if (resource.mips > most)
      return graph_bug("image \"{}\" of {}x{} has {} mips, at most {} are possible", resource.name,
                       resource.width, resource.height, resource.mips, most);
    return {};
  }

  Status check_pass(std::uint32_t p) {
    const PassDecl& pass = graph_.passes[p];
    const std::string who = fmt::format("pass \"{}\"", pass.name);
    for (const Use& use : pass.uses) {
      NERITIC_TRY_STATUS(check_use(who, use));
      if (only_as_output(use.access))
        return graph_bug("{} uses \"{}\" for {}, which only an output can", who, name(use),
                         access_info(use.access).name);
    }
    NERITIC_TRY_STATUS(check_combination(pass));
    for (const Use& use : pass.uses) {
      if (!access_info(use.access).write) NERITIC_TRY_STATUS(check_read(who, use));
    }
    for (const Use& use : pass.uses) {
      if (!access_info(use.access).write) continue;
      NERITIC_TRY_STATUS(check_write(who, use));
      writes_[use.resource].push_back({p, range_of(graph_, use)});
    }
    return {};
  }

  Status check_use(const std::string& who, const Use& use) const {
    if (use.resource >= graph_.resources.size())
      return graph_bug("{} uses a handle of no resource (index {}, there are {})", who,
                       use.resource, graph_.resources.size());
    const ResourceDecl& resource = graph_.resources[use.resource];
    const AccessInfo& info = access_info(use.access);
    const bool image = resource.kind == ResourceKind::kImage;
    if (!access_fits(use.access, resource.kind))
      return graph_bug("{} uses {} \"{}\" for {}, which it cannot be", who,
                       image ? "image" : "buffer", resource.name, info.name);
    const std::uint32_t made_for = image ? resource.image_usage : resource.buffer_usage;
    const std::uint32_t wanted = image ? info.image_usage : info.buffer_usage;
    if (resource.imported && made_for != 0 && (wanted & ~made_for) != 0)
      return graph_bug("{} uses imported \"{}\" for {}, which it was not made for", who,
                       resource.name, info.name);
    const ImageRange range = range_of(graph_, use);
    const ImageRange all{0, resource.mips, 0, resource.layers};
    if (range.mips == 0 || range.layers == 0 || !all.contains(range))
      return graph_bug("{} uses {} of \"{}\", which has {}", who, range_name(range), resource.name,
                       range_name(all));
    return {};
  }

  // Version 0 holds something only where it was imported with contents.
  bool has_contents(const ResourceDecl& resource) const {
    if (resource.history != History::kNone) return resource.history == History::kLast;
    return resource.imported && (resource.kind == ResourceKind::kBuffer ||
                                 resource.initial_layout != VK_IMAGE_LAYOUT_UNDEFINED);
  }

  // Whether every mip and layer of the range was imported with contents or written before version.
  bool filled(const Use& use, const ImageRange& range) const {
    if (has_contents(graph_.resources[use.resource])) return true;
    const auto before = std::span(writes_[use.resource]).first(use.version);
    const auto written = [&](const ImageRange& part) {
      return std::any_of(before.begin(), before.end(),
                         [&](const Write& write) { return write.range.contains(part); });
    };
    if (written(range)) return true;
    for (std::uint32_t m = range.mip; m < range.mip + range.mips; ++m)
      for (std::uint32_t l = range.layer; l < range.layer + range.layers; ++l)
        if (!written({m, 1, l, 1})) return false;
    return true;
  }

  Status check_read(const std::string& who, const Use& use) const {
    const std::vector<Write>& writes = writes_[use.resource];
    if (use.version > writes.size())
      return graph_bug(
          "{} reads version {} of \"{}\" before any pass has written it "
          "(newest is {})",
          who, use.version, name(use), writes.size());
    const ImageRange range = range_of(graph_, use);
    for (const Write& later : std::span(writes).subspan(use.version))
      if (later.range.overlaps(range))
        return graph_bug(
            "{} reads version {} of \"{}\", a stale handle: pass \"{}\" has already "
            "replaced it",
            who, use.version, name(use), graph_.passes[later.pass].name);
    if (!filled(use, range)) {
      const ResourceDecl& resource = graph_.resources[use.resource];
      const bool whole = range == ImageRange{0, resource.mips, 0, resource.layers};
      return graph_bug("{} reads {}\"{}\" before any pass has written {}", who,
                       whole ? "" : range_name(range) + " of ", name(use),
                       use.version == 0 ? "it" : "all of it");
    }
    return {};
  }

  Status check_write(const std::string& who, const Use& use) const {
    const std::vector<Write>& writes = writes_[use.resource];
    if (graph_.resources[use.resource].history == History::kLast)
      return graph_bug("{} writes \"{}\", which the frame before made: only reads are possible",
                       who, name(use));
    if (use.version < writes.size())
      return graph_bug(
          "two writers of version {} of \"{}\": pass \"{}\" and {} (write to the "
          "handle that the first write returned)",
          use.version, name(use), graph_.passes[writes[use.version].pass].name, who);
    if (use.version > writes.size())
      return graph_bug(
          "{} writes over version {} of \"{}\" before any pass has written that "
          "(newest is {})",
          who, use.version, name(use), writes.size());
    return {};
  }

  // All uses of one resource in one pass must fit a single state (layout), since no barrier is
  // possible inside a pass.
  Status check_combination(const PassDecl& pass) const {
    for (std::size_t i = 0; i < pass.uses.size(); ++i) {
      for (std::size_t j = i + 1; j < pass.uses.size(); ++j) {
        const Use &a = pass.uses[i], &b = pass.uses[j];
        if (a.resource == b.resource) {
          NERITIC_TRY_STATUS(check_pair(pass, a, b));
        }
      }
    }
    return {};
  }

  Status check_pair(const PassDecl& pass, const Use& a, const Use& b) const {
    const AccessInfo &ia = access_info(a.access), &ib = access_info(b.access);
    const bool meet = uses_meet(graph_, a, b);
    if (ia.write && ib.write) {
      if (!meet && a.version != b.version) return {};
      if (a.version == b.version)
        return graph_bug("two writers of version {} of \"{}\": both are pass \"{}\"", a.version,
                         name(a), pass.name);
      return graph_bug("pass \"{}\" writes \"{}\" twice ({} and {})", pass.name, name(a), ia.name,
                       ib.name);
    }
    if (ia.write || ib.write) {
      const Use &write = ia.write ? a : b, &read = ia.write ? b : a;
      if (read.version == write.version + 1)
        return graph_bug("pass \"{}\" reads version {} of \"{}\", which it writes", pass.name,
                         read.version, name(read));
      if (meet && !subsumes(write.access, read.access))
        return graph_bug("pass \"{}\" cannot both read (as {}) and write (as {}) \"{}\"", pass.name,
                         access_info(read.access).name, access_info(write.access).name, name(read));
      return {};
    }
    if (meet && graph_.resources[a.resource].kind == ResourceKind::kImage && ia.layout != ib.layout)
      return graph_bug("pass \"{}\" needs image \"{}\" in two layouts ({} and {})", pass.name,
                       name(a), ia.name, ib.name);
    return {};
  }

  Status check_outputs() const {
    for (std::size_t i = 0; i < graph_.outputs.size(); ++i) {
      const Use& use = graph_.outputs[i];
      NERITIC_TRY_STATUS(check_use("an output", use));
      NERITIC_TRY_STATUS(check_read("an output", use));
      if (use.access == Access::kPresent && !graph_.resources[use.resource].imported)
        return graph_bug("an output presents \"{}\", which no window gave", name(use));
      for (std::size_t j = 0; j < i; ++j) {
        const Use& other = graph_.outputs[j];
        if (!uses_meet(graph_, other, use)) continue;
        const AccessInfo &ia = access_info(other.access), &ib = access_info(use.access);
        if ((ia.write || ib.write || ia.layout != ib.layout) && other.access != use.access &&
            (ia.write || ib.write || graph_.resources[use.resource].kind == ResourceKind::kImage))
          return graph_bug("\"{}\" is an output in two ways ({} and {})", name(use), ia.name,
                           ib.name);
      }
    }
    return {};
  }

  const std::string& name(const Use& use) const { return graph_.resources[use.resource].name; }

  const GraphDecl& graph_;
  std::vector<std::vector<Write>> writes_;  // by resource
};

}  // namespace

Status validate(const GraphDecl& graph) {
  return Validator(graph).run();
}

}  // namespace neritic::graph
