// Graphs that have no single meaning are refused, and the sentence names pass and resource. Drawn
// as: (a1) version 1 of a, [P] a pass.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "graph_maker.hpp"

namespace neritic::graph {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Access kWrite = Access::kStorageWriteCompute;
constexpr Access kRead = Access::kStorageReadCompute;

TEST(Validate, ChainIsValid) {
  // [make] -> (a1) -> [refine] -> (a2) -> [show] -> (b1) -> output
  GraphMaker m;
  const auto a = m.image("a"), b = m.imported_image("b", 0, 0, VK_IMAGE_LAYOUT_UNDEFINED);
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("refine", {use(a, 1, kWrite)});
  m.pass("show", {use(a, 2, kRead), use(b, 0, Access::kColorAttachment)});
  m.output(b, 1, Access::kPresent);
  EXPECT_THAT(m.error(), IsEmpty());
}

TEST(Validate, StaleHandleIsRefused) {
  // [make] -> (a1) -> [refine] -> (a2)
  //             \----------------------> [late]     a1 is gone when late runs
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("refine", {use(a, 1, kWrite)});
  m.pass("late", {use(a, 1, kRead)}, true);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("stale"), HasSubstr("\"late\""), HasSubstr("\"alga\""),
                               HasSubstr("\"refine\"")));
}

TEST(Compile, AsksWhatAValidGraphTakesOnceWithItsUsage) {
  int n_asked = 0;
  VkImageUsageFlags usage = 0;
  const NeedsOf needs_of = [&](const GraphDecl& graph) {
    ++n_asked;
    usage = graph.resources[0].image_usage;
    return std::vector<MemoryNeed>(graph.resources.size());
  };
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("reader", {use(a, 0, kRead)}, true);
  EXPECT_FALSE(compile(m.graph, needs_of).ok());
  EXPECT_EQ(n_asked, 0);
  m.graph.passes.clear();
  m.pass("writer", {use(a, 0, kWrite)}, true);
  EXPECT_TRUE(compile(m.graph, needs_of).ok());
  EXPECT_EQ(n_asked, 1);
  EXPECT_EQ(usage, VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT});
}

// A graph is declared by the program, so its user is not told of bad input (status 2).
TEST(Validate, RefusalsAreBugsOfOursNotBadInput) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("reader", {use(a, 0, kRead)}, true);
  const Status status = validate(m.graph);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kInternal);
  EXPECT_EQ(exit_status(status.error().code), 1);
}

TEST(Validate, StaleOutputIsRefused) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("refine", {use(a, 1, kWrite)});
  m.output(a, 1, Access::kTransferRead);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("stale"), HasSubstr("output"), HasSubstr("\"alga\"")));
}

TEST(Validate, ReadBeforeWriteOfTransientIsRefused) {
  // (a0) -> [reader]     nobody made a0
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("reader", {use(a, 0, kRead)}, true);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("before any pass has written it"), HasSubstr("\"reader\""),
                               HasSubstr("\"alga\"")));
}

TEST(Validate, ReadDeclaredBeforeItsWriterIsRefused) {
  // (a1) -> [reader]   then   [make] -> (a1)
  GraphMaker m;
  const auto a = m.buffer("alga");
  m.pass("reader", {use(a, 1, kRead)}, true);
  m.pass("make", {use(a, 0, kWrite)});
  EXPECT_THAT(m.error(), AllOf(HasSubstr("before any pass has written it"), HasSubstr("\"reader\""),
                               HasSubstr("\"alga\"")));
}

TEST(Validate, ReadOfImportIsValidWhereItHasContents) {
  GraphMaker m;
  const auto filled = m.imported_image("filled", 0, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  const auto buffer = m.imported_buffer("mesh");
  m.pass("reader", {use(filled, 0, Access::kSampledCompute), use(buffer, 0, kRead)}, true);
  EXPECT_THAT(m.error(), IsEmpty());
}

TEST(Validate, ReadOfImportWithUndefinedLayoutIsRefused) {
  GraphMaker m;
  const auto empty = m.imported_image("swapchain", 0, 0, VK_IMAGE_LAYOUT_UNDEFINED);
  m.pass("reader", {use(empty, 0, Access::kSampledCompute)}, true);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("\"reader\""), HasSubstr("\"swapchain\"")));
}

TEST(Validate, TwoWritersOfOneVersionAreRefused) {
  //            /-> [left]  -> (a2)
  // [make] -> (a1)
  //            \-> [right] -> (a2)     which a2?
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("make", {use(a, 0, kWrite)});
  m.pass("left", {use(a, 1, kWrite)});
  m.pass("right", {use(a, 1, kWrite)});
  EXPECT_THAT(m.error(), AllOf(HasSubstr("two writers"), HasSubstr("\"left\""),
                               HasSubstr("\"right\""), HasSubstr("\"alga\"")));
}

TEST(Validate, WriteOverAVersionNobodyMadeIsRefused) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("make", {use(a, 3, kWrite)});
  EXPECT_THAT(m.error(), AllOf(HasSubstr("\"make\""), HasSubstr("\"alga\"")));
}

TEST(Validate, OnePassCannotWriteTwice) {
  GraphMaker same, next;
  const auto a = same.image("alga"), b = next.buffer("bed");
  same.pass("P", {use(a, 0, kWrite), use(a, 0, kWrite)});
  next.pass("P", {use(b, 0, Access::kTransferWrite), use(b, 1, kWrite)});
  EXPECT_THAT(same.error(), AllOf(HasSubstr("two writers"), HasSubstr("\"P\""), HasSubstr("alga")));
  EXPECT_THAT(next.error(), AllOf(HasSubstr("twice"), HasSubstr("\"P\""), HasSubstr("\"bed\"")));
}

TEST(Validate, OnePassCannotReadWhatItWrites) {
  // (a0) -> [P] -> (a1) -> [P]
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("P", {use(a, 0, kWrite), use(a, 1, kRead)});
  EXPECT_THAT(m.error(),
              AllOf(HasSubstr("which it writes"), HasSubstr("\"P\""), HasSubstr("alga")));
}

TEST(Validate, TwoLayoutsInOnePassAreRefused) {
  GraphMaker m;
  const auto a = m.imported_image("alga", 0, 0, VK_IMAGE_LAYOUT_GENERAL);
  m.pass("P", {use(a, 0, Access::kSampledCompute), use(a, 0, kRead)}, true);
  EXPECT_THAT(m.error(),
              AllOf(HasSubstr("two layouts"), HasSubstr("\"P\""), HasSubstr("\"alga\"")));
}

TEST(Validate, OneLayoutAtTwoStagesIsValid) {
  GraphMaker m;
  const auto a = m.imported_image("alga", 0, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  m.pass("P", {use(a, 0, Access::kSampledCompute), use(a, 0, Access::kSampledFragment)}, true);
  EXPECT_THAT(m.error(), IsEmpty());
}

TEST(Validate, FeedbackLoopIsRefused) {
  // (a1) -sampled-> [P] -color-> (a2): the same texels at the same time
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("make", {use(a, 0, Access::kColorAttachment)});
  m.pass("P", {use(a, 1, Access::kSampledFragment), use(a, 1, Access::kColorAttachment)}, true);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("both read"), HasSubstr("\"P\""), HasSubstr("\"alga\"")));
}

TEST(Validate, ReadThatTheWriteIncludesIsValid) {
  GraphMaker m;
  const auto a = m.image("a"), d = m.image("d", VK_FORMAT_D32_SFLOAT);
  m.pass("make", {use(a, 0, kWrite), use(d, 0, Access::kDepthAttachment)});
  m.pass("P",
         {use(a, 1, kRead), use(a, 1, kWrite), use(d, 1, Access::kDepthTest),
          use(d, 1, Access::kDepthAttachment)},
         true);
  EXPECT_THAT(m.error(), IsEmpty());
}

TEST(Validate, BufferReadAtAStageThatTheWriteLacksIsRefused) {
  // [P] fills its own indirect arguments: needs a barrier inside the pass
  GraphMaker m;
  const auto a = m.imported_buffer("arguments");
  m.pass("P", {use(a, 0, Access::kIndirectBuffer), use(a, 0, kWrite)}, true);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("\"P\""), HasSubstr("\"arguments\"")));
}

TEST(Validate, UnknownResourceIsRefused) {
  GraphMaker m;
  m.pass("P", {use(~0u, 0, kWrite)});
  EXPECT_THAT(m.error(), AllOf(HasSubstr("\"P\""), HasSubstr("no resource")));
  GraphMaker out;
  out.output(2, 0, kRead);
  EXPECT_THAT(out.error(), AllOf(HasSubstr("output"), HasSubstr("no resource")));
}

TEST(Validate, AccessThatTheKindCannotHaveIsRefused) {
  GraphMaker m, n;
  const auto a = m.image("alga"), b = n.buffer("bed");
  m.pass("P", {use(a, 0, Access::kVertexBuffer)});
  n.pass("P", {use(b, 0, Access::kColorAttachment)});
  EXPECT_THAT(m.error(), AllOf(HasSubstr("vertex buffer"), HasSubstr("\"P\""), HasSubstr("alga")));
  EXPECT_THAT(n.error(),
              AllOf(HasSubstr("color attachment"), HasSubstr("\"P\""), HasSubstr("bed")));
}

TEST(Validate, ImportUsedForWhatItWasNotMadeForIsRefused) {
  GraphMaker m;
  const auto a = m.imported_image("texture", 0, 0, VK_IMAGE_LAYOUT_GENERAL);
  m.graph.resources[a].image_usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  m.pass("P", {use(a, 0, kWrite)});
  EXPECT_THAT(m.error(),
              AllOf(HasSubstr("not made for"), HasSubstr("\"P\""), HasSubstr("texture")));
}

TEST(Validate, HostReadAndPresentAreOnlyForOutputs) {
  GraphMaker m;
  const auto a = m.imported_buffer("answers");
  m.pass("P", {use(a, 0, Access::kHostRead)}, true);
  EXPECT_THAT(m.error(),
              AllOf(HasSubstr("only an output"), HasSubstr("\"P\""), HasSubstr("answers")));
}

TEST(Validate, OnlyAnImportCanBePresented) {
  GraphMaker m;
  const auto a = m.image("alga");
  m.pass("P", {use(a, 0, kWrite)});
  m.output(a, 1, Access::kPresent);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("presents"), HasSubstr("\"alga\"")));
}

TEST(Validate, OutputInTwoLayoutsIsRefused) {
  GraphMaker m;
  const auto a = m.imported_image("alga", 0, 0, VK_IMAGE_LAYOUT_UNDEFINED);
  m.pass("P", {use(a, 0, kWrite)});
  m.output(a, 1, Access::kPresent);
  m.output(a, 1, Access::kTransferRead);
  EXPECT_THAT(m.error(), AllOf(HasSubstr("output"), HasSubstr("\"alga\"")));
}

TEST(Validate, ImageWithoutFormatOrSizeIsRefused) {
  GraphMaker m, n;
  m.image("alga", VK_FORMAT_UNDEFINED);
  n.graph.resources[n.image("bed")].width = 0;
  EXPECT_THAT(m.error(), AllOf(HasSubstr("format"), HasSubstr("\"alga\"")));
  EXPECT_THAT(n.error(), AllOf(HasSubstr("0x32"), HasSubstr("\"bed\"")));
}

}  // namespace
}  // namespace neritic::graph
