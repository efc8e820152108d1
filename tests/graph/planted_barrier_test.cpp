// A planted wrong barrier is caught: the same graph that runs silently gives a synchronization
// hazard as soon as one of its barriers is dropped or waits for the wrong stage.
#include "executor_fixture.hpp"

namespace neritic::graph {
namespace {

using testing::HasSubstr;

TEST_F(ExecutorTest, PlantedMissingBarrierIsCaught) {
  run(chain());
  for (const auto& [name, position] :
       {std::pair{"of one", 1}, std::pair{"of two", 2}, std::pair{"of three", 3}}) {
    const auto messages =
        validation_after(drop_barriers(name, static_cast<std::size_t>(position)), chain());
    EXPECT_THAT(messages, testing::Contains(HasSubstr("SYNC-HAZARD-READ-AFTER-WRITE"))) << name;
  }
  // The hook is off again, and nothing stuck.
  run(chain());
  EXPECT_EQ(answers(), chain_result());
}

TEST_F(ExecutorTest, PlantedBarrierFromTheWrongStageIsCaught) {
  run(chain());
  const auto wrong_stage = [](Plan& plan) {
    for (Barrier& barrier : plan.barriers.before[1]) {
      barrier.src_stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
      barrier.src_access = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    }
  };
  EXPECT_THAT(validation_after(wrong_stage, chain()),
              testing::Contains(HasSubstr("SYNC-HAZARD-READ-AFTER-WRITE")));
}

TEST_F(ExecutorTest, PlantedMissingTakeoverIsCaught) {
  // "of three" takes the memory of "of one" over, which "two" may still be reading.
  run(chain());
  const auto messages = validation_after(drop_barriers("of three", 2), chain());
  EXPECT_THAT(messages, testing::Contains(HasSubstr("SYNC-HAZARD-WRITE-AFTER-READ")));
}

}  // namespace
}  // namespace neritic::graph
