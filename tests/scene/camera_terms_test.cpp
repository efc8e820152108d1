// Lenses against OpenCV's documented formulas computed elsewhere with 20 digits; what a scene says
// of a camera; schools of fish as functions of time.
#include "engine/scene/camera_terms.hpp"

#include <gtest/gtest.h>

#include "engine/scene/flock_motion.hpp"
#include "shared/lens.h"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

const Lens kBrown{LensModel::kBrownConrady, {-0.28, 0.07, 0.01}, {0.001, -0.0005}};
const Lens kFisheye{LensModel::kFisheye, {-0.03, 0.004, -0.002, 0.0003}};

TEST(CameraLens, BrownAndConradyIsOpenCvsFormula) {
  const glm::dvec2 image = through_lens(kBrown, {0.3, -0.2});
  EXPECT_NEAR(image.x, 0.289166491, 1e-12);
  EXPECT_NEAR(image.y, -0.192690994, 1e-12);
}

TEST(CameraLens, FisheyeIsOpenCvsFormula) {
  const glm::dvec2 image = through_lens(kFisheye, {1.1, -0.7});
  EXPECT_NEAR(image.x, 0.75513276002063322589, 1e-12);
  EXPECT_NEAR(image.y, -0.48053902910403932557, 1e-12);
}

TEST(CameraLens, TheInverseAndTheShadersLensAgreeWithIt) {
  for (const Lens& lens : {kBrown, kFisheye}) {
    const auto model =
        lens.model == LensModel::kFisheye ? shared::kLensFisheye : shared::kLensBrown;
    const shared::vec4 k(lens.k[0], lens.k[1], lens.k[2], lens.k[3]);
    const shared::vec2 p(lens.p[0], lens.p[1]);
    for (const glm::dvec2 plane : {glm::dvec2(0, 0), glm::dvec2(0.7, 0.4), glm::dvec2(-0.5, 0.6)}) {
      const glm::dvec2 image = through_lens(lens, plane);
      EXPECT_LT(glm::length(before_lens(lens, image) - plane), 1e-9);
      EXPECT_LT(
          glm::length(glm::dvec2(shared::lens_distort(model, glm::vec2(plane), k, p)) - image),
          1e-6);
      EXPECT_LT(
          glm::length(glm::dvec2(shared::lens_undistort(model, glm::vec2(image), k, p)) - plane),
          1e-5);
    }
  }
}

TEST(CameraLens, ThePinholeSeesWhatTheLensSees) {
  const auto view = lens_view(kFisheye, 640, 480, radians(84.0));
  ASSERT_TRUE(view.ok()) << view.error().message;
  // The middle of the upper edge looks half the field of view upwards.
  const glm::dvec2 up = before_lens(kFisheye, {0.0, -240.0 / view->lens.fy});
  EXPECT_NEAR(std::atan(-up.y), radians(42.0), 1e-9);
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(640, 480)}) {
    const glm::dvec2 plane = before_lens(kFisheye, (corner - glm::dvec2(320, 240)) / view->lens.fx);
    EXPECT_GT(plane.x, view->tangents.left);
    EXPECT_LT(plane.x, view->tangents.right);
    EXPECT_LT(-plane.y, view->tangents.top);
    EXPECT_GT(-plane.y, view->tangents.bottom);
  }
}

TEST(CameraLens, ALensThatFoldsOrSeesTooWideIsRefused) {
  EXPECT_FALSE(lens_view({LensModel::kBrownConrady, {-1.5}}, 640, 480, radians(90.0)).ok());
  EXPECT_FALSE(lens_view({LensModel::kFisheye}, 640, 480, radians(165.0)).ok());
  EXPECT_TRUE(lens_view({LensModel::kFisheye}, 640, 480, radians(90.0)).ok());
}

TEST(CameraPort, AFlatOneBendsBySnell) {
  const Lens lens{.port = {PortKind::kFlat}};
  // A ray at 45 degrees in water leaves at asin(1.333 sin 45) = 70.49 degrees in air.
  const glm::dvec2 image = through_lens(lens, {1.0, 0.0});
  EXPECT_NEAR(image.x, std::tan(std::asin(1.333 * std::sqrt(0.5))), 1e-9);
  EXPECT_NEAR(image.x, 2.823, 1e-3);
  // In the middle it magnifies by the index; beyond 48.6 degrees nothing comes in.
  EXPECT_NEAR(through_lens(lens, {1e-5, 0.0}).x / 1e-5, 1.333, 1e-6);
  EXPECT_FALSE(unfolded(lens, {std::tan(radians(49.0)), 0.0}));
  EXPECT_TRUE(unfolded(lens, {std::tan(radians(48.0)), 0.0}));
}

TEST(CameraPort, ADomeAboutThePupilBendsNothingAndOneBesideItDoes) {
  const Lens centred{.port = {PortKind::kDome, 0.0}};
  EXPECT_NEAR(through_lens(centred, {0.7, -0.4}).x, 0.7, 1e-9);
  // The pupil a fifth of the radius before the centre: by hand at 40 degrees in air.
  const Lens ahead{.port = {PortKind::kDome, 0.2}};
  const double sine = 0.2 * std::sin(radians(40.0));
  const double water = radians(40.0) - std::asin(sine) + std::asin(sine / 1.333);
  EXPECT_NEAR(before_lens(ahead, {std::tan(radians(40.0)), 0.0}).x, std::tan(water), 1e-12);
}

TEST(CameraPort, PicturesAndArraysUseOneMap) {
  for (const Lens& lens :
       {Lens{.k = {-0.1, 0.01}, .port = {PortKind::kFlat}}, Lens{.port = {PortKind::kDome, 0.3}},
        Lens{.port = {PortKind::kDome, -0.4}}})
    for (double x = -0.7; x <= 0.7; x += 0.1) {
      const glm::dvec2 plane(x, 0.3), image = through_lens(lens, plane);
      EXPECT_LT(glm::length(before_lens(lens, image) - plane), 1e-8);
      const glm::vec2 air = shared::lens_undistort(
          shared::kLensBrown, glm::vec2(image),
          glm::vec4(lens.k[0], lens.k[1], lens.k[2], lens.k[3]), glm::vec2(0.0f));
      const glm::dvec2 shader(shared::through_port(static_cast<std::uint32_t>(lens.port.kind),
                                                   static_cast<float>(lens.port.offset), air));
      EXPECT_LT(glm::length(shader - plane), 2e-5) << x;
    }
}

TEST(CameraScene, NamesPortFocusAndShutter) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
[[cameras]]
port = { kind = "flat" }
focus = { distance_m = 1.5, f_number = 4, focal_length_mm = 35 }
shutter = { exposure_s = 0.01, readout_s = 0.02 }
)");
  const CameraTerms& terms = scene.cameras.at(0).terms;
  ASSERT_TRUE(terms.lens && terms.focus && terms.shutter);
  EXPECT_EQ(terms.lens->port.kind, PortKind::kFlat);
  EXPECT_NEAR(terms.focus->focal_length_m, 0.035, 1e-12);
  EXPECT_EQ(terms.shutter->readout_s, 0.02);
  for (const char* bad : {"port = {}", "port = { kind = \"flat\", offset = 0.1 }",
                          "focus = { distance_m = 0 }", "shutter = { samples = 1 }"}) {
    ASSERT_TRUE(write_text(scratch / "bad.toml", std::string("[[cameras]]\n") + bad + "\n").ok());
    EXPECT_FALSE(load_scene(scratch / "bad.toml").ok()) << bad;
  }
}

TEST(CameraScene, NamesLensSensorAndWhiteBalance) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
[[cameras]]
lens = { model = "brown_conrady", k = [-0.2, 0.05], p = [0.001, 0] }
sensor = { gain_db = 12, bayer = "grbg", bits = 10 }
white_balance = [2, 1, 1.5]
vignette = 1
linear = true
[[cameras]]
name = "plain"
)");
  const CameraTerms& terms = scene.cameras.at(0).terms;
  ASSERT_TRUE(terms.lens && terms.sensor && terms.white_balance);
  EXPECT_EQ(terms.lens->k[1], 0.05);
  EXPECT_EQ(terms.sensor->bayer, Bayer::kGrbg);
  EXPECT_NEAR(terms.sensor->electrons_per_unit(), 10000.0 / std::pow(10.0, 0.6) / 4.0, 1e-6);
  EXPECT_EQ(terms.white_balance->gains, Vec3(2, 1, 1.5));
  EXPECT_TRUE(terms.linear);
  EXPECT_FALSE(scene.cameras.at(1).terms.changes_picture());
}

TEST(CameraScene, RefusesAFoldingLensByLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "s.toml",
                         "[[cameras]]\nlens = { model = \"brown_conrady\", k = [-9] }\n")
                  .ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_FALSE(scene.ok());
  EXPECT_NE(scene.error().message.find("s.toml:2: cameras[0].lens: found"), std::string::npos)
      << scene.error().message;
}

constexpr const char* kSchool = R"(
[[objects]]
name = "shark"
shape = "sphere"
radius_m = 0.1
position_m = [2, -5, 0]
[[objects]]
name = "school"
shape = "sphere"
radius_m = 0.01
position_m = [0, -5, 0]
flock = { count = 400, radius_m = [3, 1, 3], speed_m_s = 0.5, avoid = "shark", avoid_m = 1 }
)";

TEST(Flock, KeepsClearOfWhatItAvoidsAndSwimsOn) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, kSchool);
  const MotionSource motion(scene);
  double fastest = 0.0, mean = 0.0;
  for (const double t : {0.0, 7.3, 100.0}) {
    const std::vector<Mat4> now = flock_copies(motion, 1, t),
                            then = flock_copies(motion, 1, t + 0.02);
    ASSERT_EQ(now.size(), 400u);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Vec3 at(now[i][3]);
      EXPECT_GE(glm::length(at - Vec3(2, 0, 0)), 1.0 - 1e-9);
      const Vec3 step = Vec3(then[i][3]) - at;
      fastest = std::max(fastest, glm::length(step) / 0.02);
      mean += glm::length(step) / 0.02 / 1200.0;
      // It looks where it swims, as far as fish pitch.
      const Vec3 ahead = -glm::normalize(Vec3(now[i][2]));
      if (glm::length(step) > 1e-3) {
        EXPECT_GT(ahead.x * step.x + ahead.z * step.z, 0.0) << i << " at " << t;
      }
    }
  }
  EXPECT_NEAR(mean, 0.5, 0.15);
  EXPECT_LT(fastest, 2.5);
}

TEST(Flock, NeighboursHeadApartPitchAndBank) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, kSchool);
  const std::vector<Mat4> fish = flock_copies(MotionSource(scene), 1, 5.0);
  double turns = 0.0, pitches = 0.0, banks = 0.0, most_deg = 0.0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < fish.size(); ++i) {
    std::size_t next = i;  // the nearest other fish
    for (std::size_t k = 0; k < fish.size(); ++k)
      if (k != i && (next == i || glm::length(Vec3(fish[k][3] - fish[i][3])) <
                                      glm::length(Vec3(fish[next][3] - fish[i][3]))))
        next = k;
    const Vec3 ahead = -glm::normalize(Vec3(fish[i][2])),
               other = -glm::normalize(Vec3(fish[next][2]));
    const double turn_deg = std::abs(degrees(
        std::atan2(ahead.x * other.z - ahead.z * other.x, ahead.x * other.x + ahead.z * other.z)));
    turns += turn_deg;
    most_deg = std::max(most_deg, turn_deg);
    pitches += std::abs(degrees(std::asin(ahead.y)));
    banks += std::abs(degrees(std::asin(glm::normalize(Vec3(fish[i][0])).y)));
    ++pairs;
  }
  const double count = static_cast<double>(pairs);
  EXPECT_GT(turns / count, 12.0);
  EXPECT_LT(turns / count, 45.0);  // still a school
  EXPECT_GT(most_deg, 60.0);       // and some turn off
  EXPECT_GT(pitches / count, 6.0);
  EXPECT_GT(banks / count, 4.0);
}

TEST(Flock, IsAFunctionOfTimeAlone) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, kSchool);
  const MotionSource motion(scene);
  const auto first = flock_copies(motion, 1, 3.0);
  flock_copies(motion, 1, 9.0);
  EXPECT_EQ(flock_copies(motion, 1, 3.0), first);
  EXPECT_EQ(scene.objects[1].copies, flock_copies(motion, 1, 0.0));
}

// Cores share the fish of a large school among them; those of a small one swim alike.
TEST(Flock, AFishSwimsAlikeHoweverManyThereAre) {
  const test::ScratchFolder scratch;
  Scene scene = scene_of(scratch, kSchool);
  const std::vector<Mat4> few = flock_copies(MotionSource(scene), 1, 3.0);
  scene.objects[1].flock->count = 7001;
  std::vector<Mat4> many = flock_copies(MotionSource(scene), 1, 3.0);
  const std::vector<Mat4> last(many.end() - 3, many.end());
  ASSERT_EQ(many.size(), 7001u);
  many.resize(few.size());
  EXPECT_EQ(many, few);
  for (const Mat4& fish : last) EXPECT_EQ(fish[3][3], 1.0);  // Mat4() has another
}

}  // namespace
}  // namespace neritic::scene
