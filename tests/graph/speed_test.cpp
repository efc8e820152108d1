// The cost of planning. The numbers are printed; the limits are loose enough for a busy machine and
// sanitizers, tight enough to notice an accidental square.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

// Twenty passes as a frame has them: pictures from two views, each five images of which three are
// read later, then a chain of compute passes on the result.
GraphMaker frame_of_twenty_passes() {
  GraphMaker m;
  std::vector<std::uint32_t> pictures;
  for (int view = 0; view < 4; ++view) {
    const std::string prefix = "view " + std::to_string(view) + " ";
    const auto depth = m.image(prefix + "depth", VK_FORMAT_D32_SFLOAT);
    const auto normal = m.image(prefix + "normal"), albedo = m.image(prefix + "albedo"),
               label = m.image(prefix + "label"), hdr = m.image(prefix + "hdr"),
               color = m.image(prefix + "color");
    m.pass(prefix + "gbuffer",
           {use(depth, 0, Access::kDepthAttachment), use(normal, 0, Access::kColorAttachment),
            use(albedo, 0, Access::kColorAttachment), use(label, 0, Access::kColorAttachment)});
    m.pass(prefix + "shade",
           {use(depth, 1, Access::kSampledCompute), use(normal, 1, Access::kSampledCompute),
            use(albedo, 1, Access::kSampledCompute), use(hdr, 0, Access::kStorageWriteCompute)});
    m.pass(prefix + "forward",
           {use(hdr, 1, Access::kColorAttachment), use(depth, 1, Access::kDepthTest)});
    m.pass(prefix + "tonemap",
           {use(hdr, 2, Access::kSampledCompute), use(color, 0, Access::kStorageWriteCompute)});
    const auto host = m.imported_buffer(prefix + "readback");
    m.pass(prefix + "copy",
           {use(color, 1, Access::kTransferRead), use(host, 0, Access::kTransferWrite)});
    m.output(host, 1, Access::kHostRead);
  }
  return m;
}

TEST(Speed, TwentyPassesArePlannedInMicroseconds) {
  const GraphMaker m = frame_of_twenty_passes();
  ASSERT_EQ(m.graph.passes.size(), 20u);
  const std::vector<MemoryNeed> needs = m.needs(256);
  std::vector<double> times_us;
  for (int i = 0; i < 500; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const Result<Plan> plan = plan_with(m.graph, needs);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - start;
    ASSERT_TRUE(plan.ok());
    ASSERT_EQ(plan->order.size(), 20u);
    times_us.push_back(taken.count());
  }
  std::nth_element(times_us.begin(), times_us.begin() + 250, times_us.end());
  fmt::print("compile of 20 passes, {} resources: median {:.1f} us\n", m.graph.resources.size(),
             times_us[250]);
  EXPECT_LT(times_us[250], 2000.0);
}

}  // namespace
}  // namespace neritic::graph
