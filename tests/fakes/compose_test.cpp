// The fake runtime's compositor shows known layers at the pixels and in the colours that geometry
// and blending in linear light predict.
#include <gmock/gmock.h>

#include <cmath>

#include "engine/scene/image_file.hpp"
#include "tests/fakes/client.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::fakes {
namespace {

using ::testing::ElementsAre;

// 90 degrees over 100 pixels: a point x metres aside at 1 m lies at pixel 50 + 50 x.
constexpr const char* kSquareViews =
    "size 100 100\nfov -45 45 45 -45\neye_distance 0.12\nhead 0 0 1.6 0\n";

class Compositor : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }
  void start(const std::string& script = "", std::vector<const char*> extensions = {}) {
    headset_.write(kSquareViews + script + "\nout " + out_.path().string());
    client_.start(std::move(extensions));
    images_ = client_.make_images(VK_FORMAT_R8G8B8A8_SRGB, 2, 2);
    quad_.space = client_.space;
    quad_.subImage = {images_.swapchain, {{0, 0}, {2, 2}}, 0};
    quad_.pose = {{0, 0, 0, 1}, {0, 0, -1}};
    quad_.size = {1, 1};
  }
  // The pictures of both views of a frame with these layers.
  void show(const std::vector<const void*>& layers, const std::vector<glm::u8vec4>& texels) {
    client_.begin_frame();
    client_.paint(images_, texels);
    client_.end_frame(layers);
    for (int view = 0; view < 2; ++view) {
      auto read = scene::read_image8(out_ / fmt::format("frame_0001_view_{}.png", view));
      ASSERT_TRUE(read.ok()) << read.error().message;
      views_[view] = std::move(read).value();
    }
  }
  std::array<int, 3> pixel(int view, std::uint32_t x, std::uint32_t y) const {
    const ImageU8& image = views_[view];
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
  }

  test::ScratchFolder out_;
  FakeHeadset headset_;
  Client client_;
  ClientImages images_;
  XrCompositionLayerQuad quad_{XR_TYPE_COMPOSITION_LAYER_QUAD};
  ImageU8 views_[2];
};

constexpr glm::u8vec4 kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255},
    kWhite{255, 255, 255, 255};

TEST_F(Compositor, AQuadIsUprightUnmirroredAndAsFarApartInTheEyesAsTheyAre) {
  start();
  show({&quad_}, {kRed, kGreen, kBlue, kWhite});
  // The left eye, 0.06 m to the left, sees it 3 pixels further to the right.
  for (int view = 0; view < 2; ++view) {
    const std::uint32_t left = view == 0 ? 28 : 22;  // its first column of pixels
    EXPECT_THAT(pixel(view, left - 1, 40), ElementsAre(0, 0, 0)) << view;
    EXPECT_THAT(pixel(view, left, 30), ElementsAre(255, 0, 0)) << view;
    EXPECT_THAT(pixel(view, left + 49, 30), ElementsAre(0, 255, 0)) << view;
    EXPECT_THAT(pixel(view, left, 70), ElementsAre(0, 0, 255)) << view;
    EXPECT_THAT(pixel(view, left + 49, 70), ElementsAre(255, 255, 255)) << view;
    EXPECT_THAT(pixel(view, left + 51, 70), ElementsAre(0, 0, 0)) << view;
  }
}

TEST_F(Compositor, AQuadIsNotSeenFromBehindNorByTheOtherEye) {
  start();
  quad_.eyeVisibility = XR_EYE_VISIBILITY_RIGHT;
  XrCompositionLayerQuad behind = quad_;
  behind.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  behind.pose.orientation = {0, 1, 0, 0};  // half a turn about Y
  show({&quad_, &behind}, {kRed});
  EXPECT_THAT(pixel(0, 50, 50), ElementsAre(0, 0, 0));
  EXPECT_THAT(pixel(1, 50, 50), ElementsAre(255, 0, 0));
}

TEST_F(Compositor, AlphaBlendsInLinearLightPremultipliedOrStraightOrNotAtAll) {
  start("background 1 1 1");
  // Half transparent black; straight alpha halves the white, and so does premultiplied.
  const glm::u8vec4 half{0, 0, 0, 128};
  XrCompositionLayerQuad straight = quad_, opaque = quad_;
  quad_.size = straight.size = opaque.size = {0.4f, 0.4f};
  quad_.pose.position.x = -0.6f;
  opaque.pose.position.x = 0.6f;
  quad_.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  straight.layerFlags = quad_.layerFlags | XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;
  show({&quad_, &straight, &opaque}, {half});
  const int grey = 187;  // sRGB of 1 - 128 / 255 = 0.498
  EXPECT_THAT(pixel(0, 22, 50), ElementsAre(grey, grey, grey));
  EXPECT_THAT(pixel(0, 52, 50), ElementsAre(grey, grey, grey));
  EXPECT_THAT(pixel(0, 82, 50), ElementsAre(0, 0, 0));
}

TEST_F(Compositor, PremultipliedColourIsNotMultipliedTwice) {
  start();
  quad_.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  show({&quad_}, {{100, 100, 100, 64}});
  EXPECT_THAT(pixel(0, 52, 50), ElementsAre(100, 100, 100));
}

TEST_F(Compositor, ACylinderShowsTheMiddleOfItsPictureAheadAndItsEdgesAtHalfItsAngle) {
  start("eye_distance 0", {XR_KHR_COMPOSITION_LAYER_CYLINDER_EXTENSION_NAME});
  XrCompositionLayerCylinderKHR cylinder{XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR};
  cylinder.space = client_.space;
  cylinder.subImage = quad_.subImage;
  cylinder.pose = {{0, 0, 0, 1}, {0, 0, 0}};
  cylinder.radius = 2;
  cylinder.centralAngle = static_cast<float>(60 * M_PI / 180);
  cylinder.aspectRatio = 2;
  show({&cylinder}, {kRed, kGreen, kBlue, kWhite});
  // tan 30 degrees: 28.9 pixels from the middle; height 2 * 1.047 / 2, 13.1 pixels each way.
  EXPECT_THAT(pixel(0, 20, 50), ElementsAre(0, 0, 0));
  EXPECT_THAT(pixel(0, 22, 38), ElementsAre(255, 0, 0));
  EXPECT_THAT(pixel(0, 77, 62), ElementsAre(255, 255, 255));
  EXPECT_THAT(pixel(0, 80, 50), ElementsAre(0, 0, 0));
  EXPECT_THAT(pixel(0, 51, 35), ElementsAre(0, 0, 0));
  EXPECT_THAT(pixel(0, 70, 38), ElementsAre(0, 255, 0));
}

TEST_F(Compositor, AProjectionLayerFromTheEyesOwnPoseIsShownTexelForTexel) {
  start();
  std::vector<glm::u8vec4> texels;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) texels.emplace_back(x * 2, y * 2, (x * 7 + y * 3) % 256, 255);
  client_.begin_frame();
  client_.paint(client_.color, texels);
  client_.end_frame({&client_.projection()});
  const auto read = scene::read_image8(out_ / "frame_0001_view_1.png");
  ASSERT_TRUE(read.ok()) << read.error().message;
  int worst = 0;
  for (std::uint32_t y = 0; y < 100; ++y) {
    for (std::uint32_t x = 0; x < 100; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(read->at(x, y, c) - texels[y * 100 + x][c]));
      }
    }
  }
  EXPECT_LE(worst, 1);
}

TEST_F(Compositor, AFrustumTurnedUpsideDownFlipsItsView) {
  start();
  client_.begin_frame();
  std::vector<glm::u8vec4> texels(100 * 100, kRed);
  std::fill(texels.begin(), texels.begin() + 100, kGreen);  // the top row
  client_.paint(client_.color, texels);
  auto layer = client_.projection();
  std::vector<XrCompositionLayerProjectionView> views(layer.views, layer.views + layer.viewCount);
  for (auto& view : views) std::swap(view.fov.angleUp, view.fov.angleDown);
  layer.views = views.data();
  client_.end_frame({&layer});
  const auto read = scene::read_image8(out_ / "frame_0001_view_0.png");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->at(50, 0, 0), 255);
  EXPECT_EQ(read->at(50, 99, 1), 255);
}

TEST_F(Compositor, AViewDrawnBeforeTheHeadTurnedIsTurnedBack) {
  start("head 0.5 0 1.6 0\nhead 0.6 0 1.6 0 -10\n");  // to the right
  client_.begin_frame();
  std::vector<glm::u8vec4> texels(100 * 100, glm::u8vec4(0, 0, 0, 255));
  for (int y = 0; y < 100; ++y) texels[y * 100 + 50] = texels[y * 100 + 49] = kWhite;
  client_.paint(client_.color, texels);
  const auto layer = client_.projection();  // of the head straight ahead
  headset_.write("head 0 0 1.6 0 -10\nhead 0.5 0 1.6 0 -10\n");
  client_.end_frame({&layer});
  const auto read = scene::read_image8(out_ / "frame_0001_view_0.png");
  ASSERT_TRUE(read.ok()) << read.error().message;
  // The thing that lay ahead lies 10 degrees to the left: 50 - 50 tan 10 = 41.2.
  double weight = 0, sum = 0;
  for (std::uint32_t x = 0; x < 100; ++x) {
    const double linear = std::pow(read->at(x, 50, 0) / 255.0, 2.2);
    weight += linear;
    sum += linear * (x + 0.5);
  }
  EXPECT_NEAR(sum / weight, 50 - 50 * std::tan(10 * M_PI / 180), 0.1);
}

}  // namespace
}  // namespace neritic::fakes
