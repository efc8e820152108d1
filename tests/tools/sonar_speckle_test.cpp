// Speckle keeps the mean power where pattern, pulse and leaning rows are named together: the
// sensors of the trade study in its harbour, over many draws of the world's scatterers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tools/tradeoff/flatten.hpp"
#include "tools/tradeoff/kind_bench.hpp"
#include "tools/tradeoff/kind_sweep.hpp"

namespace neritic::tools {
namespace {

// Mean over draws, and its standard error.
class Draws {
 public:
  void add(double x) {
    n_ += 1.0;
    sum_ += x;
    square_ += x * x;
  }
  double mean() const { return sum_ / n_; }
  double error() const {
    return std::sqrt(std::max(0.0, square_ / n_ - mean() * mean()) / (n_ - 1.0));
  }

 private:
  double n_ = 0.0, sum_ = 0.0, square_ = 0.0;
};

struct SpeckleCase {
  scene::SonarKind kind;
  int draws;    // where the test is thorough; otherwise a quarter, and 8 at least
  double most;  // the mean's standard error by all of them, so that four of it are a sharp bound
};
void PrintTo(const SpeckleCase& c, std::ostream* out) {
  *out << scene::name_of(c.kind);
}

class SpecklePower : public test::GpuTest, public ::testing::WithParamInterface<SpeckleCase> {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    NERITIC_ASSERT_OK(scene_, scene::load_scene(test::source_dir() / "assets/scenes/harbour.toml"));
    const Vec3 origin_m = place_of(scene_).position_m;
    NERITIC_ASSERT_OK(const auto world,
                      make_triangle_world(flatten(scene_, 0.0, Pose{-origin_m, Quat(1, 0, 0, 0)})));
    for (KindSetting& kind : kind_settings(scene_, world->cast(Vec3(0, -1, 0)).t))
      if (kind.base.kind == GetParam().kind) kind_ = std::move(kind);
    // A third of an imaging sonar's beams are bins enough: an error of 0.0037 over all of them by 8
    // draws is one of 0.0064 over these.
    if (kind_.base.kind == scene::SonarKind::kImaging && !test::is_thorough()) {
      kind_.base.azimuth_rad /= 3.0;
      kind_.base.bins_azimuth /= 3;
    }
  }
  // Cells alike, the faint as the bright ones; and all power, which the bright ones have.
  void hold(KindBench& bench, scene::Sonar sonar, const char* what) {
    NERITIC_ASSERT_OK(const auto smooth, bench.render(sonar, 0));
    sonar.terms.speckle = scene::SonarSpeckle{};
    const float least = 1e-3f * *std::ranges::max_element(smooth.image);
    Draws cells, all;
    const int draws = test::is_thorough() ? GetParam().draws : std::max(8, GetParam().draws / 4);
    const double most = GetParam().most * std::sqrt(double(GetParam().draws) / draws);
    for (int draw = 1; draw <= draws; ++draw) {
      const std::uint64_t seed = static_cast<std::uint64_t>(draw) * 0x9e3779b97f4a7c15u;
      NERITIC_ASSERT_OK(const auto found, bench.render(sonar, 0, seed - scene_.seed));
      double ratio = 0.0, n = 0.0, heard = 0.0, wanted = 0.0;
      for (std::size_t i = 0; i < smooth.image.size(); ++i) {
        heard += found.image[i];
        wanted += smooth.image[i];
        if (!(smooth.image[i] > least)) continue;
        ratio += found.image[i] / smooth.image[i];
        n += 1.0;
      }
      cells.add(ratio / n);
      all.add(heard / wanted);
    }
    fmt::print("{}, {}: cells {:.4f} +- {:.4f}, all {:.4f} +- {:.4f}\n", scene::name_of(sonar.kind),
               what, cells.mean(), cells.error(), all.mean(), all.error());
    EXPECT_LT(cells.error(), most) << what;
    EXPECT_NEAR(cells.mean(), 1.0, 4.0 * cells.error()) << what;
    // A few bright cells have most of all power, so that its error is not sharply known.
    EXPECT_NEAR(all.mean(), 1.0, 5.0 * all.error()) << what;
  }

  scene::Scene scene_;
  KindSetting kind_;
};

TEST_P(SpecklePower, IsThatWithoutSpeckle) {
  ASSERT_FALSE(kind_.shots.empty());
  KindBench bench(kind_);
  NERITIC_ASSERT_STATUS(bench.open(device(), scene_));
  scene::Sonar sonar = with_knobs(kind_.base, kind_.middle);
  // With all terms, of which the others have parts: these where it is cheap, or thorough.
  const bool parts = test::is_thorough() || sonar.kind == scene::SonarKind::kEchoSounder;
  if (parts) hold(bench, sonar, "pattern and pulse");
  sonar.terms.ghosts = scene::SonarGhosts{.surface = true};
  sonar.terms.profile = scene::SonarProfile{{{0.0, 1520.0}, {20.0, 1490.0}}, false};
  sonar.terms.motion = scene::SonarMotion{.within_ping = true, .doppler = true};
  hold(bench, sonar, "ghosts, profile and motion too");
  if (!parts) return;
  sonar = with_knobs(kind_.base, kind_.middle);
  sonar.terms.beam.azimuth.reset();
  sonar.terms.range_spread.reset();
  hold(bench, sonar, "neither");
}

INSTANTIATE_TEST_SUITE_P(Sonar, SpecklePower,
                         ::testing::Values(SpeckleCase{scene::SonarKind::kImaging, 8, 0.01},
                                           SpeckleCase{scene::SonarKind::kProfiling, 40, 0.018},
                                           SpeckleCase{scene::SonarKind::kEchoSounder, 40, 0.025},
                                           SpeckleCase{scene::SonarKind::kSideScan, 30, 0.006},
                                           SpeckleCase{scene::SonarKind::kMechanical, 40, 0.006}),
                         [](const auto& info) {
                           return std::string(scene::name_of(info.param.kind));
                         });

}  // namespace
}  // namespace neritic::tools
