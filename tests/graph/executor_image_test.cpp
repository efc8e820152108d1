// Images through the executor: attachments, transfers, layouts, shared memory; planted mistakes.
#include "executor_fixture.hpp"

namespace neritic::graph {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct PictureData {
  ImageHandle image;
};
struct SumData {
  ImageHandle image;
  BufferHandle sums;
};

class ExecutorImageTest : public ExecutorTest {
 protected:
  // [clear NAME] -> (NAME 1) -> [sum NAME] -> sums + 1: the picture is cleared to red, then summed.
  // how: as a colour attachment, or by a transfer. (Debian 12's synchronization
  // validation, 1.3.239, does not look into dynamic rendering; hazards of attachments are the
  // simulator's to find.)
  BufferHandle add_picture(FrameGraph& graph, const std::string& name, Access how, float red,
                           BufferHandle sums, std::uint32_t factor) {
    const ImageHandle image =
        graph
            .add_pass<PictureData>(
                "clear " + name,
                [&](PassBuilder& builder, PictureData& data) {
                  data.image = builder.write(
                      builder.create_image(name, {VK_FORMAT_R8G8B8A8_UNORM, 33, 17, 2}), how);
                },
                [how, red](const PictureData& data, PassContext& context) {
                  const gpu::Image& target = context.image(data.image);
                  how == Access::kColorAttachment ? clear_by_rendering(context.cmd(), target, red)
                                                  : clear_by_transfer(context.cmd(), target, red);
                })
            .image;
    return graph
        .add_pass<SumData>(
            "sum " + name,
            [&](PassBuilder& builder, SumData& data) {
              data.image = image;
              builder.read(image, Access::kSampledCompute);
              data.sums = builder.write(sums, Access::kStorageWriteCompute);
            },
            [this, factor](const SumData& data, PassContext& context) {
              gpu::Commands& commands = context.commands;
              commands.bind_pipeline(sum_);
              commands.bind(sum_, {gpu::bound_texel_image(0, context.image(data.image).view()),
                                   gpu::bound_buffer(1, context.buffer(data.sums).handle())});
              commands.push(sum_, factor);
              commands.dispatch(5, 3, 2);
            })
        .sums;
  }

  static void clear_by_transfer(VkCommandBuffer cmd, const gpu::Image& image, float red) {
    const VkClearColorValue value{{red, 0.0f, 0.0f, 0.0f}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0,
                                      VK_REMAINING_ARRAY_LAYERS};
    vkCmdClearColorImage(cmd, image.handle(), access_info(Access::kTransferWrite).layout, &value, 1,
                         &all);
  }

  static void clear_by_rendering(VkCommandBuffer cmd, const gpu::Image& image, float red) {
    VkRenderingAttachmentInfo attachment{};
    attachment.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    attachment.imageView = image.view();
    attachment.imageLayout = access_info(Access::kColorAttachment).layout;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.clearValue.color.float32[0] = red;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = {image.desc().width, image.desc().height};
    info.layerCount = image.desc().layers;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &attachment;
    vkCmdBeginRendering(cmd, &info);
    vkCmdEndRendering(cmd);
  }

  // Two pictures, one after the other, in the same memory.
  FrameGraph pictures() {
    FrameGraph graph;
    BufferHandle sums = graph.import_buffer("answers", answers_);
    sums = graph
               .add_pass<SumData>(
                   "zero",
                   [&](PassBuilder& builder, SumData& data) {
                     data.sums = builder.write(sums, Access::kTransferWrite);
                   },
                   [](const SumData& data, PassContext& context) {
                     vkCmdFillBuffer(context.cmd(), context.buffer(data.sums).handle(), 0,
                                     VK_WHOLE_SIZE, 0);
                   })
               .sums;
    sums = add_picture(graph, "first", Access::kTransferWrite, 1.0f, sums, 1);
    sums = add_picture(graph, "second", Access::kColorAttachment, 0.2f, sums, 1000);
    graph.output(sums, Access::kHostRead);
    return graph;
  }
};

TEST_F(ExecutorImageTest, PicturesInSharedMemoryGiveTheRightSums) {
  const Plan* plan = run(pictures());
  EXPECT_EQ(plan->placement.offset[find_resource(*plan, "first")],
            plan->placement.offset[find_resource(*plan, "second")]);
  EXPECT_LT(plan->placement.bytes_with_aliasing, plan->placement.bytes_without);
  constexpr std::uint32_t kTexels = 33 * 17;
  EXPECT_EQ(answers()[0], kTexels * 255 + kTexels * 51 * 1000);
  EXPECT_EQ(answers()[1], answers()[0]);
}

TEST_F(ExecutorImageTest, PlantedLayoutMistakeIsCaught) {
  run(pictures());
  const auto messages = validation_after(drop_barriers("second", 4), pictures());
  EXPECT_THAT(messages, Not(IsEmpty()));
}

TEST_F(ExecutorImageTest, PlantedWeakerImageBarrierIsCaught) {
  run(pictures());
  const auto weaken = [](Plan& plan) {
    for (Barrier& barrier : plan.barriers.before[2])
      if (barrier.resource == find_resource(plan, "first"))
        barrier.src_stages = VK_PIPELINE_STAGE_2_NONE, barrier.src_access = VK_ACCESS_2_NONE;
  };
  EXPECT_THAT(validation_after(weaken, pictures()), testing::Contains(HasSubstr("SYNC-HAZARD")));
}

}  // namespace
}  // namespace neritic::graph
