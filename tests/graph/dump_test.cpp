// What a person reads about a plan: complete, and valid for Graphviz.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "graph_maker.hpp"
#include "tests/support/support.hpp"

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

TEST(DumpGraphviz, IsAcceptedByDot) {
  if (std::system("command -v dot >/dev/null 2>&1") != 0) GTEST_SKIP() << "no Graphviz here";
  const test::ScratchFolder folder;
  const std::string path = (folder / "plan.dot").string();
  std::ofstream(path) << dump_graphviz(small_plan());
  EXPECT_EQ(std::system(("dot -Tplain '" + path + "' >/dev/null").c_str()), 0);
}

}  // namespace
}  // namespace neritic::graph
