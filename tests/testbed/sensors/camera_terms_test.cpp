// Cameras' terms by numbers: lens, vignette, noise, raw counts; flow and
// depth that lead each pixel to where its point is next; boxes of what is seen.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/flock_motion.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/output/label_files.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

const scene::Lens kBrown{scene::LensModel::kBrownConrady, {-0.22, 0.05, 0.0}, {0.002, -0.001}};
const scene::Lens kFisheye{scene::LensModel::kFisheye, {-0.02, 0.003, 0.0, 0.0}};
// The colour of a picture of nothing (Lighting::background).
const Vec3f kBackground(0.06f, 0.075f, 0.10f);

scene::Scene scene_with(const scene::CameraTerms& terms, std::uint32_t side = 96) {
  scene::Scene scene;
  scene.path = "test";
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = side;
  camera.terms = terms;
  scene.cameras.push_back(camera);
  return scene;
}

class CameraTermsTest : public test::GpuTest {
 protected:
  Result<ViewImages> picture(scene::Scene scene, const FrameRequest& more = {}) {
    FrameRequest request = more;
    request.cameras = {0};
    NERITIC_TRY(const auto session, Session::create(device(), std::move(scene)));
    session->keep_plan_dump(true);
    NERITIC_TRY(FrameResult result, session->render(request));
    plan_ = session->plan_text();
    return std::move(result.cameras[0].eyes[0]);
  }
  std::string plan_;
};

TEST_F(CameraTermsTest, WhatACameraDoesNotNameIsNotDeclared) {
  NERITIC_ASSERT_OK(const ViewImages plain, picture(scene_with({})));
  for (const char* pass : {"camera hdr", "focus", "shutter"})
    EXPECT_EQ(plan_.find(pass), std::string::npos) << pass;
  EXPECT_TRUE(plain.linear.empty() && plain.raw.empty());
  NERITIC_ASSERT_OK(const ViewImages shaded, picture(scene_with({.vignette = 1.0})));
  EXPECT_NE(plan_.find("camera hdr"), std::string::npos);
  NERITIC_ASSERT_OK(const ViewImages exposed,
                    picture(scene_with({.focus = scene::Focus{}, .shutter = scene::Shutter{}})));
  for (const char* pass : {"focus", "shutter"}) EXPECT_NE(plan_.find(pass), std::string::npos);
  EXPECT_EQ(plan_.find("camera hdr"), std::string::npos);
}

TEST_F(CameraTermsTest, NoiseHasTheMeanAndVarianceOfPhotonsAndReading) {
  scene::CameraTerms terms{.linear = true};
  terms.sensor = scene::ImageSensor{
      .gain_db = 6.0, .full_well_e = 4000, .read_noise_e = 6, .saturation_ev = 0, .bits = 16};
  NERITIC_ASSERT_OK(const ViewImages eye, picture(scene_with(terms, 256)));
  const double per_unit = terms.sensor->electrons_per_unit();
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = c; i < eye.linear.data.size(); i += 3) {
      sum += eye.linear.data[i];
      squares += double(eye.linear.data[i]) * eye.linear.data[i];
    }
    const double n = double(eye.linear.data.size()) / 3.0, mean = sum / n;
    const double variance = squares / n - mean * mean;
    const double electrons = kBackground[int(c)] * per_unit;
    const double expected = (electrons + 36.0) / (per_unit * per_unit);
    EXPECT_NEAR(mean, kBackground[int(c)], 4.0 * std::sqrt(expected / n) + 2e-4);
    EXPECT_NEAR(variance / expected, 1.0, 0.03);  // 5 standard deviations of 65 536 draws
  }
}

TEST_F(CameraTermsTest, NoiseFollowsFromSeedAndFrameAlone) {
  scene::CameraTerms terms{.linear = true};
  terms.sensor = scene::ImageSensor{};
  const auto at = [&](std::uint32_t frame, std::uint64_t seed) {
    auto eye = picture(scene_with(terms), {.frame = frame, .seed = seed});
    EXPECT_TRUE(eye.ok());
    return eye.ok() ? eye->linear.data : std::vector<float>();
  };
  const auto first = at(0, 1);
  EXPECT_EQ(at(0, 1), first);
  EXPECT_NE(at(1, 1), first);
  EXPECT_NE(at(0, 2), first);
}

TEST_F(CameraTermsTest, RawCountsStandBehindTheirFilters) {
  scene::CameraTerms terms;
  terms.sensor = scene::ImageSensor{.full_well_e = 1e7,
                                    .read_noise_e = 0,
                                    .saturation_ev = 0,
                                    .bits = 12,
                                    .bayer = scene::Bayer::kGrbg};
  terms.white_balance = scene::WhiteBalance{false, {3, 1, 0.5}};
  NERITIC_ASSERT_OK(const ViewImages eye, picture(scene_with(terms, 16)));
  ASSERT_FALSE(eye.raw.empty());
  EXPECT_TRUE(eye.linear.empty());
  const int colors[] = {1, 0, 2, 1};
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x)
      EXPECT_NEAR(eye.raw.at(x, y), 4095 * kBackground[colors[2 * (y % 2) + x % 2]], 2.0);
}

TEST(PictureMap, PointsFarBesideALensStayOutsideOfItsPicture) {
  const PictureMap map{.intrinsics = {100.0, 100.0, 50.0, 50.0},
                       .lens = scene::Lens{.k = {-0.3, 0.0, 0.0, 0.0}},
                       .width = 100,
                       .height = 100};
  double before = 0.0;
  for (double degree = 0.0; degree < 85.0; degree += 1.0) {
    const double x = map.pixel_of({std::tan(radians(degree)), 0.0, -1.0}).x;
    EXPECT_GT(x, before) << degree;
    before = x;
  }
}

TEST_F(CameraTermsTest, VignetteFallsAsTheFourthPowerOfTheCosine) {
  NERITIC_ASSERT_OK(const ViewImages eye,
                    picture(scene_with({.vignette = 1.0, .linear = true}, 97)));
  for (const std::uint32_t x : {0u, 20u, 48u}) {
    const double right = (x + 0.5 - 48.5) / eye.intrinsics.fx, up = 48.0 / eye.intrinsics.fy;
    const double cosine = 1.0 / std::sqrt(1.0 + right * right + up * up);
    EXPECT_NEAR(eye.linear.at(x, 0, 1) / kBackground.y, std::pow(cosine, 4), 2e-3);
  }
}

scene::Object box_at(const Vec3& at, std::uint16_t label) {
  scene::Object object;
  object.name = fmt::format("box_{}", label);
  object.model = 0;
  object.class_id = object.instance = label;
  object.mount.pose.position_m = at;
  return object;
}

// A tilted wall, a box that crosses before it, a school, and a camera that moves and turns.
scene::Scene moving_scene(const scene::CameraTerms& terms) {
  scene::Scene scene = scene_with(terms, 128);
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({1.0, 1.0, 1.0})));
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({60.0, 60.0, 1.0})));
  scene::Object wall = box_at({0, -5, -9}, 1);
  wall.model = 1;
  wall.mount.pose.rotation = glm::angleAxis(0.4, Vec3(0, 1, 0));
  scene::Object box = box_at({-1, -5, -4}, 2);
  box.mount.track =
      scene::Track{{{0.0, {-1, -5, -4}}, {1.0, {1, -4.6, -3.4}}}, {scene::Track::Attitude{}}};
  scene::Object school = box_at({0.5, -5.6, -4}, 3);
  school.flock = scene::Flock{.count = 12, .radius_m = {1, 0.5, 1}, .scale = 0.2};
  school.copies.assign(12, Mat4(1.0));
  scene.objects = {wall, box, school};
  scene.cameras[0].mount.pose.position_m = {0, -5, 0};
  scene.cameras[0].mount.track =
      scene::Track{{{0.0, {0, -5, 0}}, {1.0, {0.6, -4.8, -0.5}}}, {scene::Track::Attitude{}}};
  return scene;
}

// Where a point on an instance is at another time: with its object, or its copy.
Vec3 carried(const scene::MotionSource& motion, std::uint16_t instance, const Vec3& world,
             double from_s, double to_s) {
  const auto place = [&](double t) {
    const std::size_t object = instance == 1 ? 0 : instance == 2 ? 1 : 2;
    Mat4 m = to_matrix(motion.world_from_object(object, t));
    if (object == 2) m = m * scene::flock_copies(motion, 2, t)[instance - 3u];
    return m;
  };
  return Vec3(place(to_s) * glm::inverse(place(from_s)) * Vec4(world, 1.0));
}

TEST_F(CameraTermsTest, DepthAndFlowLeadEachPixelToItsPointInTheNextPicture) {
  for (const auto& lens :
       {std::optional<scene::Lens>(), std::optional(kBrown), std::optional(kFisheye)}) {
    const scene::Scene scene = moving_scene({.lens = lens});
    const scene::MotionSource motion(scene);
    FrameRequest request{.time_s = 0.4, .next_time_s = 0.45};
    NERITIC_ASSERT_OK(const ViewImages eye, picture(scene, request));
    const PictureMap map{eye.intrinsics, eye.lens, eye.near_m, eye.width, eye.height};
    const Pose next = motion.world_from(scene.cameras[0].mount, request.next_time_s);
    std::size_t judged = 0, off = 0, edges = 0;
    for (std::uint32_t y = 1; y + 1 < eye.height; ++y)
      for (std::uint32_t x = 1; x + 1 < eye.width; ++x) {
        const float depth = eye.depth.at(x, y);
        if (!std::isfinite(depth)) continue;
        glm::dvec2 plane((x + 0.5 - eye.intrinsics.cx) / eye.intrinsics.fx,
                         (y + 0.5 - eye.intrinsics.cy) / eye.intrinsics.fy);
        if (eye.lens) plane = scene::before_lens(*eye.lens, plane);
        const Vec3 world = eye.world_from_view * (Vec3(plane.x, -plane.y, -1.0) * double(depth));
        const std::uint16_t instance = eye.instances.at(x, y);
        const Vec3 then = carried(motion, instance, world, request.time_s, request.next_time_s);
        const glm::dvec2 at = map.pixel_of(inverse(next) * then);
        const double error = glm::length(
            at - glm::dvec2(x + 0.5 + eye.motion.at(x, y, 0), y + 0.5 + eye.motion.at(x, y, 1)));
        ++judged;
        // Through a lens a pixel at an outline or a crease has its nearest texel's depth.
        bool edge = false;
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
          edge |= eye.instances.at(x + dx, y + dy) != instance ||
                  std::abs(eye.depth.at(x + dx, y + dy) - depth) > 0.03f * depth;
        edges += edge;
        off += error > 0.1 && !(lens && edge);
      }
    EXPECT_GT(judged, 10000u);
    EXPECT_LT(edges, judged / 4);
    EXPECT_EQ(off, 0u) << (lens ? int(lens->model) : -1);
  }
}

TEST_F(CameraTermsTest, ALensPutsThingsWhereItsFormulaSays) {
  for (const scene::Lens& lens : {kBrown, kFisheye}) {
    scene::Scene scene = scene_with({.lens = lens}, 200);
    scene.models.push_back(std::make_shared<scene::Model>(scene::make_sphere(0.05, 32)));
    std::vector<Vec3> places;
    for (int i = 0; i < 5; ++i) {
      places.push_back(Vec3(-0.9 + 0.45 * i, -0.8 + 0.4 * i, -2.0));
      scene.objects.push_back(box_at(places.back(), static_cast<std::uint16_t>(i + 1)));
    }
    NERITIC_ASSERT_OK(const ViewImages eye, picture(scene));
    for (std::size_t i = 0; i < places.size(); ++i) {
      glm::dvec2 sum(0.0);
      double n = 0.0;
      for (std::uint32_t y = 0; y < eye.height; ++y)
        for (std::uint32_t x = 0; x < eye.width; ++x)
          if (eye.labels.at(x, y) == i + 1) {
            sum += glm::dvec2(x + 0.5, y + 0.5);
            n += 1.0;
          }
      ASSERT_GT(n, 20.0);
      const glm::dvec2 image = scene::through_lens(lens, {places[i].x / 2.0, -places[i].y / 2.0});
      const glm::dvec2 expected = image * eye.intrinsics.fx + glm::dvec2(100.0);
      EXPECT_LT(glm::length(sum / n - expected), 0.5)
          << i;  // a disc of some 30 texels; without the lens 4 to 20
    }
  }
}

// Each box has eight corners. A half of one is hidden, then nearly all, then next to nothing.
TEST_F(CameraTermsTest, OcclusionIsTheHiddenShareOfWhatAThingCovers) {
  scene::Scene scene = scene_with({}, 256);
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({1.0, 1.0, 0.1})));
  // At twice the distance a thing of twice the size is as large.
  for (const double shown : {0.5, 0.05, 0.95}) {
    scene::Object back = box_at({0, 0, -6.05}, 4), front = box_at({shown, 0, -3.05}, 5);
    back.scale = Vec3(2.0, 2.0, 1.0);
    scene.objects = {back, front};
    scene.class_names = {{4, "diver"}, {5, "rov"}};
    FrameRequest request;
    request.capture.boxes = true;
    NERITIC_ASSERT_OK(const ViewImages eye, picture(scene, request));
    ASSERT_EQ(eye.boxes.size(), 2u);
    EXPECT_NEAR(eye.boxes[0].occluded, 1.0 - shown, 0.04) << shown;
    EXPECT_EQ(eye.boxes[1].occluded, 0.0);
  }
}

TEST_F(CameraTermsTest, TheWholeBoxOfWhatPassesTheCameraGoesOnBeyondThePicture) {
  scene::Scene scene = scene_with({}, 128);
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({0.2, 0.4, 20.0})));
  scene.objects = {box_at({0.6, -0.3, 0.0}, 4)};
  scene.class_names = {{4, "structure"}};
  FrameRequest request;
  request.capture.boxes = true;
  NERITIC_ASSERT_OK(const ViewImages eye, picture(scene, request));
  ASSERT_EQ(eye.boxes.size(), 1u);
  const InstanceBox& box = eye.boxes[0];
  EXPECT_LE(box.whole.left, box.seen.left + 1.0);
  EXPECT_LE(box.whole.top, box.seen.top + 1.0);
  EXPECT_GT(box.whole.right, eye.width);
  EXPECT_GT(box.whole.bottom, eye.height);
  EXPECT_GT(box.truncated, 0.5);
  EXPECT_EQ(box.occluded, 0.0);
}

TEST_F(CameraTermsTest, BoxesHaveTheSizesPlacesAndOcclusionOfThings) {
  scene::Scene scene = scene_with({}, 128);
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({1.0, 0.6, 2.0})));
  scene::Object turned = box_at({0.5, 0.2, -6}, 4);
  turned.mount.pose.rotation = glm::angleAxis(0.5, Vec3(0, 1, 0));
  scene::Object front = box_at({0.1, 0.2, -3.2}, 5);
  front.scale = Vec3(0.35, 1.0, 0.1);
  scene.objects = {turned, front, box_at({0, 0, 5}, 6)};  // the last is behind the camera
  scene.class_names = {{4, "diver"}, {5, "rov"}, {6, "fish"}};
  FrameRequest request;
  request.capture.boxes = true;
  NERITIC_ASSERT_OK(const ViewImages eye, picture(scene, request));
  ASSERT_EQ(eye.boxes.size(), 2u);
  const InstanceBox& box = eye.boxes[0];
  EXPECT_EQ(box.instance, 4);
  EXPECT_LT(glm::length(box.size_m - Vec3(1.0, 0.6, 2.0)), 1e-6);
  EXPECT_LT(glm::length(box.world_from_box.position_m - Vec3(0.5, 0.2, -6)), 1e-6);
  EXPECT_NEAR(box.upright_yaw_rad, 0.5, 1e-9);
  EXPECT_LT(glm::length(box.upright_size_m - Vec3(1.0, 0.6, 2.0)), 1e-6);
  EXPECT_GT(box.occluded, 0.05);
  EXPECT_LT(box.occluded, 0.8);
  EXPECT_EQ(eye.boxes[1].occluded, 0.0);
  EXPECT_NEAR(eye.boxes[1].seen.left, eye.boxes[1].whole.left, 1.0);
  EXPECT_NEAR(eye.boxes[1].seen.bottom, eye.boxes[1].whole.bottom, 1.0);

  const test::ScratchFolder scratch;
  KittiFiles kitti(scratch.path(), scene.class_names);
  ASSERT_TRUE(kitti.add("eye", eye, 3).ok());
  const auto& k = eye.intrinsics;
  const auto calibration = [&](const std::string& p3) {
    const std::string p2 =
        fmt::format("{:.9g} 0 {:.9g} 0 0 {:.9g} {:.9g} 0 0 0 1 0", k.fx, k.cx, k.fy, k.cy);
    constexpr const char* same = "1 0 0 0 0 1 0 0 0 0 1 0";
    return fmt::format(
        "P0: {0}\nP1: {1}\nP2: {0}\nP3: {1}\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: {2}\n"
        "Tr_imu_to_velo: {2}\n",
        p2, p3.empty() ? p2 : p3, same);
  };
  EXPECT_EQ(read_text(scratch / "kitti/eye/calib/000003.txt").value(), calibration(""));
  // A point at x, z of the left eye is at fx (x - b) / z + cx of the right one.
  ViewImages right = eye;
  right.world_from_view.position_m += eye.world_from_view.rotation * Vec3(0.25, 0.0, 0.0);
  ASSERT_TRUE(kitti.add("eyes_left", eye, 3, &right).ok());
  EXPECT_EQ(read_text(scratch / "kitti/eyes_left/calib/000003.txt").value(),
            calibration(fmt::format("{:.9g} 0 {:.9g} {:.9g} 0 {:.9g} {:.9g} 0 0 0 1 0", k.fx, k.cx,
                                    -0.25 * k.fx, k.fy, k.cy)));
  NERITIC_ASSERT_OK(const std::string text, read_text(scratch / "kitti/eye/label_2/000003.txt"));
  std::istringstream line(text);
  std::string type;
  double v[14];
  line >> type;
  for (double& x : v) line >> x;
  EXPECT_EQ(type, "diver");
  EXPECT_NEAR(v[7], 0.6, 1e-3);   // height
  EXPECT_NEAR(v[8], 1.0, 1e-3);   // width
  EXPECT_NEAR(v[9], 2.0, 1e-3);   // length
  EXPECT_NEAR(v[10], 0.5, 1e-3);  // x, y down of the underside, z ahead
  EXPECT_NEAR(v[11], -0.2 + 0.3, 1e-3);
  EXPECT_NEAR(v[12], 6.0, 1e-3);
  // It looks along -z turned by 0.5 about y: in KITTI's axes (-sin, cos), so that
  // (cos r, -sin r) = (-sin 0.5, cos 0.5).
  EXPECT_NEAR(std::cos(v[13]), -std::sin(0.5), 1e-3);
  EXPECT_NEAR(-std::sin(v[13]), std::cos(0.5), 1e-3);
}

}  // namespace
}  // namespace neritic::testbed
