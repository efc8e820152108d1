// A plan for Graphviz (dot -Tsvg): passes are boxes numbered in order, resource versions ellipses,
// culled passes dashed. Pure; any thread.
#include <fmt/format.h>

#include <iterator>
#include <set>
#include <utility>

#include "engine/graph/access.hpp"
#include "engine/graph/names.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {
namespace {

// Inside a quoted string, dot only needs quotes and backslashes escaped; no name has line breaks.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c == '\n' ? ' ' : c;
  }
  return text;
}

class DotWriter {
 public:
  explicit DotWriter(const Plan& plan) : plan_(plan) {}

  std::string run() {
    line("digraph frame_graph {{");
    line("  rankdir=LR; node [fontname=\"sans-serif\", fontsize=10]; edge [fontsize=8];");
    for (std::uint32_t p = 0; p < plan_.graph.passes.size(); ++p) add_pass(p);
    for (const Use& output : plan_.graph.outputs) add_output(output);
    line("}}");
    return std::move(text_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void add_pass(std::uint32_t p) {
    const PassDecl& pass = plan_.graph.passes[p];
    if (plan_.kept[p]) {
      std::size_t position = 0;
      while (plan_.order[position] != p) ++position;
      line("  p{} [shape=box, label=\"{}: {}{}{}\\n{} barriers\"];", p, position,
           escaped(pass.name), pass.terms.empty() ? "" : "\\n", escaped(pass.terms),
           plan_.barriers.first[position].size() + plan_.barriers.before[position].size());
    } else {
      line("  p{} [shape=box, style=dashed, color=gray, label=\"{}\\nculled\"];", p,
           escaped(pass.name));
    }
    const char* style = plan_.kept[p] ? "solid" : "dashed";
    for (const Use& use : pass.uses) {
      const AccessInfo& info = access_info(use.access);
      const std::string label = info.name + part_of(use);
      if (info.write) {
        add_version(use.resource, use.version + 1);
        // A write over an earlier version keeps its contents: it is an input as well.
        if (use.version > 0 || plan_.graph.resources[use.resource].imported) {
          add_version(use.resource, use.version);
          line("  r{}_{} -> p{} [style={}];", use.resource, use.version, p, style);
        }
        line("  p{} -> r{}_{} [style={}, label=\"{}\"];", p, use.resource, use.version + 1, style,
             label);
      } else {
        add_version(use.resource, use.version);
        line("  r{}_{} -> p{} [style={}, label=\"{}\"];", use.resource, use.version, p, style,
             label);
      }
    }
  }

  // "\nmip 1, layer 0" of a use of a part.
  std::string part_of(const Use& use) const {
    const ResourceDecl& resource = plan_.graph.resources[use.resource];
    const ImageRange part = range_of(plan_.graph, use);
    if (part == ImageRange{0, resource.mips, 0, resource.layers}) return "";
    return "\\n" + range_name(part);
  }

  void add_version(std::uint32_t resource, std::uint32_t version) {
    if (!drawn_.insert({resource, version}).second) return;
    const ResourceDecl& decl = plan_.graph.resources[resource];
    line("  r{}_{} [shape=ellipse{}, label=\"{} {}\"];", resource, version,
         decl.imported ? ", peripheries=2" : "", escaped(decl.name), version);
  }

  void add_output(const Use& output) {
    add_version(output.resource, output.version);
    line("  out{}_{} [shape=plaintext, label=\"output\"];", output.resource, output.version);
    line("  r{}_{} -> out{}_{} [label=\"{}\"];", output.resource, output.version, output.resource,
         output.version, access_info(output.access).name);
  }

  const Plan& plan_;
  std::string text_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> drawn_;
};

}  // namespace

std::string dump_graphviz(const Plan& plan) {
  return DotWriter(plan).run();
}

}  // namespace neritic::graph
