// A plan's dump: complete, and valid for Graphviz.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

using testing::HasSubstr;

Plan small_plan() {
  GraphMaker m;
  const auto depth = m.image("depth", VK_FORMAT_D32_SFLOAT), color = m.image("scene \"color\"");
  const auto answers = m.imported_buffer("answers");
  m.pass("gbuffer", {use(depth, 0, Access::kDepthAttachment)});
  m.pass("shade",
         {use(depth, 1, Access::kSampledCompute), use(color, 0, Access::kStorageWriteCompute)});
  m.graph.passes.back().terms = "sun, water";
  m.pass("unwanted", {use(depth, 1, Access::kSampledFragment)});
  m.pass("count",
         {use(color, 1, Access::kSampledCompute), use(answers, 0, Access::kStorageWriteCompute)});
  m.output(answers, 1, Access::kHostRead);
  return m.plan();
}

TEST(DumpText, SaysWhatRunsWhatWaitsAndWhatItTakes) {
  const std::string text = dump_text(small_plan());
  EXPECT_THAT(text, HasSubstr("3 passes kept, 1 culled, 5 barriers"));
  EXPECT_THAT(text, HasSubstr("reads  depth 1 (sampled compute)"));
  EXPECT_THAT(text, HasSubstr("writes answers 0->1 (storage write compute)"));
  EXPECT_THAT(text, HasSubstr("barrier depth: early-depth+late-depth -> compute, layout depth -> "
                              "shader-read, access depth-write -> sampled-read"));
  EXPECT_THAT(text, HasSubstr("shade\n      terms  sun, water\n"));
  EXPECT_THAT(text, HasSubstr("culled\n  unwanted\n"));
  EXPECT_THAT(text, HasSubstr("D32_SFLOAT 64x32"));
  EXPECT_THAT(text, HasSubstr("transient memory: 16384 bytes"));
  EXPECT_THAT(text, HasSubstr("output answers 1 (host read)"));
}

TEST(DumpGraphviz, DrawsPassesResourcesAndCulledOnesDashed) {
  const std::string text = dump_graphviz(small_plan());
  EXPECT_THAT(text, HasSubstr("digraph frame_graph {"));
  EXPECT_THAT(text, HasSubstr("shape=box, label=\"0: gbuffer"));
  EXPECT_THAT(text, HasSubstr("style=dashed, color=gray, label=\"unwanted"));
  EXPECT_THAT(text, HasSubstr("scene \\\"color\\\" 1"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
}

// The statements of "The DOT Language" (graphviz.org) that are used, a line or more of each; edges
// end in nodes that have a statement of their own.
TEST(DumpGraphviz, IsDot) {
  const std::string id = "([A-Za-z_][A-Za-z_0-9]*|[0-9]+|\"([^\"\\\\]|\\\\.)*\")";
  const std::string one = id + "=" + id, attributes = " \\[" + one + "(, " + one + ")*\\]";
  const std::string statement = "(" + one + "|" + id + "( -> " + id + ")?" + attributes + ")";
  const std::string text = dump_graphviz(small_plan());
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  ASSERT_GE(lines.size(), 10u);
  EXPECT_THAT(lines.front(), testing::MatchesRegex("digraph " + id + " \\{"));
  EXPECT_EQ(lines.back(), "}");
  std::set<std::string> nodes, ends;
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    EXPECT_THAT(lines[i], testing::MatchesRegex("( +" + statement + ";)+"));
    std::istringstream words(lines[i]);
    std::string from, arrow, to;
    words >> from >> arrow >> to;
    if (arrow == "->")
      ends.insert({from, to});
    else
      nodes.insert(from);
  }
  EXPECT_GE(ends.size(), 8u);
  EXPECT_THAT(nodes, testing::IsSupersetOf(ends));
}

}  // namespace
}  // namespace neritic::graph
