// Headsets of other kinds, losses on demand, and layers locked to the head, a hand and the world.
#include <gmock/gmock.h>

#include <cmath>

#include "engine/scene/image_file.hpp"
#include "tests/fakes/client.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class HeadsetKinds : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }
  static std::vector<XrView> views(Client& client, const void* next = nullptr) {
    const XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, next, client.configuration,
                                client.state.predictedDisplayTime, client.space};
    XrViewState state{XR_TYPE_VIEW_STATE};
    std::vector<XrView> found(4, {XR_TYPE_VIEW});
    std::uint32_t count = 0;
    EXPECT_EQ(xrLocateViews(client.session, &info, &state, 4, &count, found.data()), XR_SUCCESS);
    found.resize(count);
    return found;
  }
};

TEST_F(HeadsetKinds, OneViewOfOnePixel) {
  FakeHeadset headset("views 1\nsize 1 1\n");
  Client client;
  client.start();
  client.frame();
  EXPECT_EQ(client.configuration, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO);
  EXPECT_EQ(client.color.width, 1u);
  EXPECT_EQ(views(client).size(), 1u);
}

TEST_F(HeadsetKinds, FourViewsWhoseInnerOnesFollowTheGaze) {
  FakeHeadset headset("views 4\nfocus_deg 10\nhead 0 0 1.6 0\ngaze 0 -20 5\n");
  Client client;
  client.start({XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_VARJO_FOVEATED_RENDERING_EXTENSION_NAME});
  client.frame();
  const auto still = views(client);
  ASSERT_EQ(still.size(), 4u);
  EXPECT_NEAR(still[2].fov.angleLeft, -still[2].fov.angleRight, 1e-6);
  const XrViewLocateFoveatedRenderingVARJO about_gaze{XR_TYPE_VIEW_LOCATE_FOVEATED_RENDERING_VARJO,
                                                      nullptr, XR_TRUE};
  const auto gazed = views(client, &about_gaze);
  const double to_degrees = 180 / M_PI;
  EXPECT_NEAR(gazed[3].fov.angleLeft * to_degrees, 10, 1e-3);  // 20 to the right, less 10
  EXPECT_NEAR(gazed[3].fov.angleRight * to_degrees, 30, 1e-3);
  EXPECT_EQ(gazed[0].fov.angleLeft, still[0].fov.angleLeft);
}

TEST_F(HeadsetKinds, TheEyesFrustaAreAsymmetricAndMirrored) {
  FakeHeadset headset("fov -50 40 45 -47\neye_distance 0.06\nhead 0 1 1.6 0\n");
  Client client;
  client.start();
  client.make_space(XR_REFERENCE_SPACE_TYPE_STAGE);
  const auto found = views(client);
  EXPECT_FLOAT_EQ(found[0].fov.angleLeft, -found[1].fov.angleRight);
  EXPECT_FLOAT_EQ(found[0].fov.angleRight, -found[1].fov.angleLeft);
  EXPECT_NEAR(found[0].pose.position.x, 0.97, 1e-6);
  EXPECT_NEAR(found[1].pose.position.x, 1.03, 1e-6);
}

TEST_F(HeadsetKinds, AVisibilityMaskHidesTheCornersAndItsTwoHalvesFillTheView) {
  FakeHeadset headset("fov -45 45 45 -45\n");
  Client client;
  client.start({XR_KHR_VISIBILITY_MASK_EXTENSION_NAME});
  const auto get = client.function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
  double area = 0;
  for (const auto kind : {XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR,
                          XR_VISIBILITY_MASK_TYPE_VISIBLE_TRIANGLE_MESH_KHR}) {
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    ASSERT_EQ(get(client.session, client.configuration, 0, kind, &mask), XR_SUCCESS);
    std::vector<XrVector2f> points(mask.vertexCountOutput);
    std::vector<std::uint32_t> indices(mask.indexCountOutput);
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.indexCapacityInput = mask.indexCountOutput;
    mask.vertices = points.data();
    mask.indices = indices.data();
    ASSERT_EQ(get(client.session, client.configuration, 0, kind, &mask), XR_SUCCESS);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const XrVector2f &a = points[indices[i]], &b = points[indices[i + 1]],
                       &c = points[indices[i + 2]];
      const double twice = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
      EXPECT_GT(twice, 0) << "the triangle is not counter-clockwise";
      area += twice / 2;
    }
  }
  EXPECT_NEAR(area, 4, 1e-5);
}

TEST_F(HeadsetKinds, ARefreshRateCanBeChosenAndPacesTheFrames) {
  FakeHeadset headset("refresh_rates 60 90\n");
  Client client;
  client.start({XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME});
  EXPECT_EQ(client.function<PFN_xrRequestDisplayRefreshRateFB>("xrRequestDisplayRefreshRateFB")(
                client.session, 60),
            XR_SUCCESS);
  client.frame();
  EXPECT_EQ(client.state.predictedDisplayPeriod, 16'666'667);
}

TEST_F(HeadsetKinds, HostTimeAndXrTimeConvertBothWaysAndAreNotTheSame) {
  FakeHeadset headset;
  Client client;
  client.start({XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME});
  const auto to_host =
      client.function<PFN_xrConvertTimeToTimespecTimeKHR>("xrConvertTimeToTimespecTimeKHR");
  const auto to_xr =
      client.function<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
  timespec host{};
  ASSERT_EQ(to_host(client.instance, 12'500'000'000, &host), XR_SUCCESS);
  EXPECT_EQ(host.tv_sec, 2);
  EXPECT_EQ(host.tv_nsec, 500'000'000);
  XrTime back = 0;
  ASSERT_EQ(to_xr(client.instance, &host, &back), XR_SUCCESS);
  EXPECT_EQ(back, 12'500'000'000);
}

TEST_F(HeadsetKinds, ALostSessionAndALostInstanceRefuseAllButTheirEnd) {
  FakeHeadset headset("frame 2 session_lost\n");
  Client client;
  client.start();
  client.frame();
  XrFrameState state{XR_TYPE_FRAME_STATE};
  EXPECT_EQ(xrWaitFrame(client.session, nullptr, &state), XR_ERROR_SESSION_LOST);
  EXPECT_EQ(xrBeginFrame(client.session, nullptr), XR_ERROR_SESSION_LOST);
  EXPECT_EQ(xrDestroySession(client.session), XR_SUCCESS);
  client.session = XR_NULL_HANDLE;
  headset.happen("instance_lost");
  EXPECT_EQ(xrGetSystem(client.instance, nullptr, &client.system), XR_ERROR_INSTANCE_LOST);
}

TEST_F(HeadsetKinds, RecentringMovesTheLocalSpaceAndTellsByHowMuch) {
  FakeHeadset headset("local 0 1.6 0\nhead 0 0.5 1.6 0\n");
  Client client;
  client.start();
  headset.happen("recenter 0.5 -0.2 90");
  XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
  ASSERT_EQ(xrPollEvent(client.instance, &event), XR_SUCCESS);
  ASSERT_EQ(event.type, XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING);
  const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
  EXPECT_NEAR(change.poseInPreviousSpace.position.x, 0.5, 1e-6);
  EXPECT_NEAR(change.poseInPreviousSpace.orientation.y, std::sin(M_PI / 4), 1e-6);
  // The new -Z looks along the old -X, so that the head lies to the left of the new origin.
  client.begin_frame();
  const auto found = views(client);
  client.end_frame();
  EXPECT_NEAR((found[0].pose.position.x + found[1].pose.position.x) / 2, -0.2, 1e-6);
}

TEST_F(HeadsetKinds, AnOverlayIsAskedForByItsExtensionAndHearsOfTheMainProgram) {
  test::ScratchFolder out;
  FakeHeadset headset("size 20 20\nbackground 0 0 1\nout " + out.path().string());
  Client client;
  client.make_instance({XR_EXTX_OVERLAY_EXTENSION_NAME});
  client.get_system();
  client.make_device();
  const XrSessionCreateInfoOverlayEXTX overlay{XR_TYPE_SESSION_CREATE_INFO_OVERLAY_EXTX, nullptr, 0,
                                               1};
  client.make_session(&overlay);
  XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
  ASSERT_EQ(xrPollEvent(client.instance, &event), XR_SUCCESS);
  EXPECT_EQ(event.type, XR_TYPE_EVENT_DATA_MAIN_SESSION_VISIBILITY_CHANGED_EXTX);
  client.make_space(XR_REFERENCE_SPACE_TYPE_VIEW);
  client.begin_session();
  client.make_swapchain();
  client.begin_frame();
  ClientImages images = client.make_images(VK_FORMAT_R8G8B8A8_SRGB, 1, 1);
  client.paint(images, {{128, 0, 0, 128}});  // premultiplied
  XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
  quad.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  quad.space = client.space;
  quad.subImage = {images.swapchain, {{0, 0}, {1, 1}}, 0};
  quad.pose = {{0, 0, 0, 1}, {0, 0, -1}};
  quad.size = {0.5f, 0.5f};
  client.end_frame({&quad});
  const auto seen = scene::read_image8(out / "overlay_frame_0000_view_0.png");
  ASSERT_TRUE(seen.ok()) << seen.error().message;
  EXPECT_EQ(seen->at(0, 0, 2), 255);  // the main program
  EXPECT_EQ(seen->at(10, 10, 0), 128);
  EXPECT_EQ(seen->at(10, 10, 2), 187);  // half of it through the panel
}

// Where the middle of the lit pixels of a picture lies.
glm::dvec2 middle(const ImageU8& image) {
  glm::dvec2 sum(0);
  double weight = 0;
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      if (image.at(x, y, 0) < 128) continue;
      sum += glm::dvec2(x + 0.5, y + 0.5);
      weight += 1;
    }
  }
  return weight > 0 ? sum / weight : glm::dvec2(-1);
}

TEST_F(HeadsetKinds, QuadsStayWithTheHeadTheWorldAndTheWrist) {
  test::ScratchFolder out;
  // Between the two pictures the head turns 20 degrees to the left and the wrist rises by 0.1 m.
  FakeHeadset headset(
      "size 200 200\nfov -45 45 45 -45\neye_distance 0\nperiod 0.1\nlead 0\nlocal 0 1.6 0\n"
      "head 0.2 0 1.6 0\nhead 0.3 0 1.6 0 20\n"
      "hand right 0.2 0 1.6 -1\nhand right 0.3 0 1.7 -1\nout " +
      out.path().string());
  Client client;
  client.start({XR_EXT_HAND_TRACKING_EXTENSION_NAME});
  const XrSpace world = client.space;
  client.make_space(XR_REFERENCE_SPACE_TYPE_VIEW);
  const XrSpace head = client.space;
  const XrHandTrackerCreateInfoEXT info{XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT, nullptr,
                                        XR_HAND_RIGHT_EXT, XR_HAND_JOINT_SET_DEFAULT_EXT};
  XrHandTrackerEXT tracker = XR_NULL_HANDLE;
  ASSERT_EQ(client.function<PFN_xrCreateHandTrackerEXT>("xrCreateHandTrackerEXT")(client.session,
                                                                                  &info, &tracker),
            XR_SUCCESS);
  ClientImages images = client.make_images(VK_FORMAT_R8G8B8A8_SRGB, 1, 1);
  std::vector<glm::dvec2> at_head, at_world, at_wrist;
  std::uint64_t frame = 1;
  const auto show = [&](XrSpace space, const XrPosef& pose) {
    XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
    quad.space = space;
    quad.subImage = {images.swapchain, {{0, 0}, {1, 1}}, 0};
    quad.pose = pose;
    quad.size = {0.1f, 0.1f};
    client.paint(images, {{255, 255, 255, 255}});
    client.end_frame({&quad});
    const auto seen = scene::read_image8(out / fmt::format("frame_{:04}_view_0.png", frame++));
    EXPECT_TRUE(seen.ok());
    return seen.ok() ? middle(*seen) : glm::dvec2(-1);
  };
  const XrPosef ahead{{0, 0, 0, 1}, {0, 0, -1}};
  const auto wrist = [&](XrTime time) {
    std::vector<XrHandJointLocationEXT> joints(XR_HAND_JOINT_COUNT_EXT);
    XrHandJointLocationsEXT locations{XR_TYPE_HAND_JOINT_LOCATIONS_EXT};
    locations.jointCount = XR_HAND_JOINT_COUNT_EXT;
    locations.jointLocations = joints.data();
    const XrHandJointsLocateInfoEXT where{XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT, nullptr, world,
                                          time};
    EXPECT_EQ(client.function<PFN_xrLocateHandJointsEXT>("xrLocateHandJointsEXT")(tracker, &where,
                                                                                  &locations),
              XR_SUCCESS);
    return joints[XR_HAND_JOINT_WRIST_EXT].pose;
  };
  for (const XrSpace space : {head, world}) {
    auto& to = space == head ? at_head : at_world;
    headset.write("head 0 0 1.6 0\nhead 9 0 1.6 0\nhead 0.2 0 1.6 0\nhead 0.3 0 1.6 0\n");
    client.begin_frame();
    to.push_back(show(space, ahead));
    headset.write(
        "head 0 0 1.6 0 20\nhead 9 0 1.6 0 20\nhead 0.2 0 1.6 0 20\nhead 0.3 0 1.6 0 20\n");
    client.begin_frame();
    to.push_back(show(space, ahead));
  }
  headset.write("head 0 0 1.6 0\nhead 9 0 1.6 0\nhead 0.2 0 1.6 0\nhead 0.3 0 1.6 0\n");
  client.begin_frame();
  at_wrist.push_back(show(world, wrist(10'200'000'000)));
  client.begin_frame();
  at_wrist.push_back(show(world, wrist(10'300'000'000)));
  const auto near = [](const glm::dvec2& a, double x, double y) {
    EXPECT_NEAR(a.x, x, 0.6);
    EXPECT_NEAR(a.y, y, 0.6);
  };
  near(at_head[0], 100, 100);
  near(at_head[1], 100, 100);
  near(at_world[0], 100, 100);
  near(at_world[1], 100 + 100 * std::tan(20 * M_PI / 180), 100);  // the head turned left
  near(at_wrist[0], 100, 100);
  near(at_wrist[1], 100, 90);
}

TEST_F(HeadsetKinds, TheLogSaysHowFarTheShownViewsAreFromTheEyes) {
  FakeHeadset headset("period 0.01\nlead 2\nhead 0 0 1.6 0\nhead 1 1 1.6 0\n");
  Client client;
  client.start();
  client.frame();
  EXPECT_THAT(headset.log(), HasSubstr("frame 1 display 10040000000 projection 0.00 mm 0.00 deg"));
  client.begin_frame();
  client.paint(client.color, {{0, 0, 0, 255}});
  client.state.predictedDisplayTime -= 10'000'000;  // poses of the frame before
  const auto& late = client.projection();
  client.state.predictedDisplayTime += 10'000'000;
  client.end_frame({&late});
  EXPECT_THAT(headset.log(), HasSubstr("frame 2 display 10050000000 projection 10.00 mm 0.00 deg"));
}

}  // namespace
}  // namespace neritic::fakes
