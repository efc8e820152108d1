#include "testbed/view/quality_governor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace neritic::testbed {
namespace {

// A machine whose frame costs fixed_ms and full_ms at full resolution, with noise of 5 %.
struct Machine {
  double fixed_ms, full_ms, period_ms = 0.0;
  double light_saves = 0.0;  // the share of full_ms that each level of light takes off
  std::mt19937 random{7};

  double mean_ms(const Quality& quality) const {
    return fixed_ms +
           full_ms * quality.view_scale * quality.view_scale * (1.0 - light_saves * quality.light);
  }

  void run(QualityGovernor& governor, int frames) {
    std::normal_distribution<double> noise(1.0, 0.05);
    for (int i = 0; i < frames; ++i) {
      const double work_ms = mean_ms(governor.quality()) * noise(random);
      governor.add(std::max(work_ms, period_ms), work_ms);
    }
  }
};

TEST(QualityGovernor, ASlowMachineComesDownUntilItHoldsTheBudget) {
  QualityGovernor governor(50.0);
  Machine machine{12.0, 300.0};
  machine.run(governor, 60);
  const double scale = governor.quality().view_scale;
  EXPECT_LE(12.0 + 300.0 * scale * scale, 1.08 * 50.0);
  EXPECT_GE(scale, 0.25);  // and not farther than it must
}

TEST(QualityGovernor, AFastMachineKeepsFullQuality) {
  QualityGovernor governor(16.7);
  Machine machine{1.0, 8.0, 16.7};
  machine.run(governor, 500);
  EXPECT_EQ(governor.rung(), 0u);
}

TEST(QualityGovernor, AMachineBetweenTwoRungsDoesNotSwing) {
  for (double full_ms = 40.0; full_ms < 400.0; full_ms *= 1.03) {
    QualityGovernor governor(50.0);
    Machine machine{10.0, full_ms};
    machine.run(governor, 200);
    int changes = 0;
    for (int i = 0; i < 1200; ++i) {
      const std::size_t before = governor.rung();
      machine.run(governor, 1);
      changes += governor.rung() != before;
    }
    EXPECT_LE(changes, 6) << full_ms;  // in a minute
  }
}

TEST(QualityGovernor, QualityComesBackWhenTheLoadEnds) {
  QualityGovernor governor(50.0);
  Machine{12.0, 300.0}.run(governor, 60);
  EXPECT_GT(governor.rung(), 3u);
  Machine{5.0, 20.0, 16.7}.run(governor, 1200);
  EXPECT_EQ(governor.rung(), 0u);
}

// A load that goes leaves the machine with room for some rungs, not for all. Resolution climbs to
// the best one that fits but for the room that is kept, overshoots by a try at most, and stays.
TEST(QualityGovernor, AfterALoadItClimbsAsFarAsThereIsRoomAndDoesNotSwing) {
  constexpr double kBudget_ms = 50.0, kFixed_ms = 8.0;
  for (double full_ms = 50.0; full_ms < 200.0; full_ms *= 1.15) {
    QualityGovernor governor(kBudget_ms);
    Machine{kFixed_ms, 600.0}.run(governor, 200);
    const std::size_t loaded = governor.rung();
    Machine machine{kFixed_ms, full_ms, 16.7, 0.15};
    const auto work_ms = [&](std::size_t rung) { return machine.mean_ms(quality_rungs()[rung]); };
    const auto changes_of = [&](int frames) {
      int changes = 0;
      for (int i = 0; i < frames; ++i) {
        const std::size_t before = governor.rung();
        machine.run(governor, 1);
        changes += governor.rung() != before;
      }
      return changes;
    };
    // Half a minute and more to climb: a change a rung, and a try of the next one down again.
    EXPECT_LE(changes_of(2000), static_cast<int>(loaded) + 6) << full_ms;
    const std::size_t settled = governor.rung();
    ASSERT_LT(settled, loaded) << full_ms;
    EXPECT_LE(work_ms(settled), 1.08 * kBudget_ms) << full_ms;
    // The rung above it would leave less than a quarter of the budget.
    EXPECT_TRUE(settled == 0 || work_ms(settled - 1) > 0.75 * kBudget_ms)
        << full_ms << ": rung " << settled << " of " << loaded;
    EXPECT_LE(changes_of(1200), 6) << full_ms;
    EXPECT_LE(std::abs(static_cast<int>(governor.rung()) - static_cast<int>(settled)), 1)
        << full_ms;
  }
}

TEST(QualityGovernor, AMachineThatCannotHoldItEndsAtTheLastRung) {
  QualityGovernor governor(50.0);
  Machine{80.0, 300.0}.run(governor, 300);
  EXPECT_EQ(governor.rung(), quality_rungs().size() - 1);
}

TEST(QualityGovernor, OneSlowFrameChangesNothing) {
  QualityGovernor governor(50.0);
  Machine machine{5.0, 30.0};
  for (int i = 0; i < 20; ++i) {
    machine.run(governor, 10);
    governor.add(900.0, 900.0);
  }
  EXPECT_EQ(governor.rung(), 0u);
}

TEST(QualityGovernor, TimesThatAreNoneAreLeftOut) {
  QualityGovernor governor(50.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100; ++i) {
    for (const double bad : {nan, infinite, 0.0, -1.0}) governor.add(bad, 10.0);
    governor.add(900.0, nan);
    governor.add(1e-300, 1e-300);
  }
  EXPECT_EQ(governor.rung(), 0u);
}

// A level of light is never finer than the camera nor than the level before it.
TEST(QualityGovernor, LightComesDownKnobByKnob) {
  scene::PictureDetail before;
  before.waves = 10, before.cascades = 1;
  const scene::PictureDetail camera = before;
  for (std::uint32_t light = 0; light < kLightLevels; ++light) {
    const scene::PictureDetail now = detail_at(camera, light);
    EXPECT_LE(now.shadow_size, before.shadow_size);
    EXPECT_LE(now.cascades, before.cascades);
    EXPECT_LE(now.shadow_samples, before.shadow_samples);
    EXPECT_GE(now.visibility_step, before.visibility_step);
    EXPECT_GE(now.mesh_error, before.mesh_error);
    EXPECT_LE(now.occlusion_samples, before.occlusion_samples);
    EXPECT_LE(now.inscatter_samples, before.inscatter_samples);
    EXPECT_LE(now.waves, before.waves);
    EXPECT_LE(now.scatter_levels, before.scatter_levels);
    EXPECT_LE(now.shaft_samples, before.shaft_samples);
    EXPECT_LE(now.particles, before.particles);
    EXPECT_EQ(now == camera, light == 0);
    before = now;
  }
}

// Seconds of a slide show would pass on the way down from the whole picture.
TEST(QualityGovernor, ACpuBeginsWithAsManyPixelsAsTwoCoresDraw) {
  const Quality window = quality_rungs()[first_rung_on_cpu(1280.0 * 720.0)];
  EXPECT_LE(1280.0 * 720.0 * window.view_scale * window.view_scale, 1.3e5);
  EXPECT_EQ(window.light, kLightLevels - 1);
  EXPECT_EQ(first_rung_on_cpu(160.0 * 120.0), 0u);
  EXPECT_EQ(first_rung_on_cpu(1e12), quality_rungs().size() - 1);
  std::size_t before = 0;
  for (double pixels = 1.0; pixels < 1e9; pixels *= 1.5) {
    EXPECT_GE(first_rung_on_cpu(pixels), before);
    before = first_rung_on_cpu(pixels);
  }
}

TEST(QualityGovernor, AFastMachineThatBeganLowIsAtFullQualityWithinTwoSeconds) {
  QualityGovernor governor(50.0, first_rung_on_cpu(1280.0 * 720.0));
  Machine{2.0, 8.0, 16.7}.run(governor, 120);
  EXPECT_EQ(governor.rung(), 0u);
}

TEST(QualityGovernor, ASlowMachineThatBeganLowStaysNearWhereItBegan) {
  const std::size_t first = first_rung_on_cpu(1280.0 * 720.0);
  QualityGovernor governor(50.0, first);
  Machine{12.0, 300.0}.run(governor, 200);
  EXPECT_NEAR(double(governor.rung()), double(first), 2.0);
}

// Nine of ten frames are in time; their mean is not.
TEST(QualityGovernor, PingsCountByTheirShareOfAllFrames) {
  const auto rung_after = [](double ping_ms) {
    QualityGovernor governor(50.0);
    for (int i = 0; i < 200 && governor.rung() == 0; ++i)
      governor.add(i % 10 == 0 ? 40.0 + ping_ms : 40.0, 40.0, i % 10 == 0);
    return governor.rung();
  };
  EXPECT_EQ(rung_after(50.0), 0u);
  EXPECT_GT(rung_after(250.0), 0u);
}

TEST(QualityGovernor, PingsInEveryFrameAreNoReasonToWait) {
  QualityGovernor governor(16.7);
  for (int i = 0; i < 300; ++i) governor.add(16.7, 10.0);
  for (int i = 0; i < 500; ++i) governor.add(120.0, 120.0, true);
  EXPECT_EQ(governor.rung(), quality_rungs().size() - 1);
}

TEST(QualityGovernor, PingsThatEndAreForgotten) {
  QualityGovernor governor(46.0);
  for (int i = 0; i < 1000; ++i) governor.add(i % 10 == 9 ? 280.0 : 30.0, 30.0, i % 10 == 9);
  EXPECT_GT(governor.rung(), 0u);
  for (int i = 0; i < 4000; ++i) governor.add(30.0, 10.0);
  EXPECT_EQ(governor.rung(), 0u);
}

TEST(QualityGovernor, SaysAllThatItGaveUp) {
  EXPECT_TRUE(given_up(Quality{}).empty());
  const auto words = given_up({.view_scale = 0.36, .ping_every = 8, .light = kLightLevels - 1});
  EXPECT_THAT(words, testing::ElementsAre("drawn at 36 %   1 ping of 8",
                                          "light 4 of 4 lower, no forward scatter"));
  EXPECT_THAT(given_up({.view_scale = 0.9}), testing::ElementsAre("drawn at 90 %"));
  EXPECT_TRUE(given_up({.ping_every = 8}, false).empty());
  EXPECT_THAT(given_up({.view_scale = 0.9, .ping_every = 8}, false),
              testing::ElementsAre("drawn at 90 %"));
  for (const Quality& quality : quality_rungs().subspan(1)) EXPECT_FALSE(given_up(quality).empty());
}

// Each rung costs no more than the one before it, or it would not help.
TEST(QualityGovernor, RungsComeDownInOrder) {
  const auto rungs = quality_rungs();
  EXPECT_EQ(rungs.front(), Quality{});
  for (std::size_t i = 1; i < rungs.size(); ++i) {
    EXPECT_LE(rungs[i].view_scale, rungs[i - 1].view_scale);
    EXPECT_GE(rungs[i].ping_every, rungs[i - 1].ping_every);
    EXPECT_GE(rungs[i].light, rungs[i - 1].light);
    EXPECT_LT(rungs[i].light, kLightLevels);
    EXPECT_NE(rungs[i], rungs[i - 1]);
  }
}

}  // namespace
}  // namespace neritic::testbed
