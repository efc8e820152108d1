// Images leave a run as samples: each consumer at rates of its own, and nothing for nobody.
#include "testbed/sensors/image_consumer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "testbed/loop/loop.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/wall_flight.hpp"

namespace neritic::testbed {
namespace {

class Images final : public ImageSink {
 public:
  struct Kept {
    std::string stream, encoding, frame_id;
    SampleHeader header;
    std::uint32_t width = 0, height = 0;
    std::vector<std::byte> data;
    Pose pose;
    bool others = false;  // other images of the view are there
    double sound_speed_m_s = 0.0;
  };
  bool ready(const ImageStream&) override { return ++asked % every == 0; }
  Status accept(const ImageSample& image) override {
    const ImageType& type = type_of(image.stream->kind);
    EXPECT_EQ(image.data.size(), std::size_t{type.pixel_bytes} * image.width * image.height);
    kept.push_back({image.stream->name,
                    type.encoding,
                    image.stream->frame_id,
                    image.header,
                    image.width,
                    image.height,
                    {image.data.begin(), image.data.end()},
                    image.world_from_frame,
                    image.view && (!image.view->normals.empty() || !image.view->labels.empty()),
                    image.sonar ? image.sonar->sound_speed_m_s : 0.0});
    return {};
  }
  Status finish() override {
    ++finished;
    return {};
  }
  std::vector<const Kept*> of(const std::string& stream) const {
    std::vector<const Kept*> out;
    for (const Kept& one : kept)
      if (one.stream == stream) out.push_back(&one);
    return out;
  }
  std::vector<Kept> kept;
  int asked = 0, every = 1, finished = 0;
};

class Results final : public FrameSink {
 public:
  Status accept(const FrameResult& frame) override {
    if (!frame.sonars.empty()) frames.push_back(frame);
    return {};
  }
  Status finish() override { return {}; }
  std::vector<FrameResult> frames;
};

// The camera runs at 30 Hz and the sonar at 4; frames come at 60.
class ImageConsumers : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    scene_ = scene_of_flight();
    NERITIC_ASSERT_OK(session_, Session::create(device(), scene_));
    physics_ = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
  }
  ImageConsumer consumer(const std::vector<ImageConsumer::Wish>& wishes, ImageSink& sink) {
    return ImageConsumer::create(scene_, wishes, sink).value();
  }
  void run(std::vector<ImageConsumer*> consumers, FrameSink* sink = nullptr) {
    LoopSensors sensors{.session = session_.get(), .consumers = std::move(consumers)};
    sensors.own_rates = true;
    sensors.capture = Capture{.color = false, .motion = false}.without_geometry();
    if (sink) sensors.sonars = {0};
    Loop loop({.clock = Clock::simulated(0.0, 1.0 / 60.0),
               .physics = physics_.get(),
               .sensors = sensors,
               .frame_sinks = sink ? std::vector<FrameSink*>{sink} : std::vector<FrameSink*>{},
               .stop = {.frames = 61}});
    const Status status = loop.run();
    EXPECT_TRUE(status.ok()) << status.error().message;
  }

  scene::Scene scene_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<LivePhysics> physics_;
};

TEST_F(ImageConsumers, EachTakesItsStreamsAtItsOwnRate) {
  Images slow, fast;
  ImageConsumer a = consumer({{"rov_eye/color", 5.0}}, slow);
  ImageConsumer b =
      consumer({{"rov_eye/depth"}, {"rov_sonar/echoes"}, {"rov_sonar/echo_labels", 2.0}}, fast);
  run({&a, &b});
  ASSERT_EQ(slow.kept.size(), 6u);  // 1 s, both ends
  ASSERT_EQ(fast.of("rov_eye/depth").size(), 31u);
  ASSERT_EQ(fast.of("rov_sonar/echoes").size(), 5u);
  ASSERT_EQ(fast.of("rov_sonar/echo_labels").size(), 3u);
  EXPECT_EQ(slow.finished + fast.finished, 2);
  for (std::size_t i = 0; i < 6; ++i) {
    const Images::Kept& color = slow.kept[i];
    EXPECT_EQ(color.encoding, "rgb8");
    EXPECT_EQ(color.frame_id, "rov_eye");
    EXPECT_EQ(color.width, 64u);
    EXPECT_EQ(color.header.sequence, 6 * i);  // the sensor's beats
    EXPECT_NEAR(static_cast<double>(color.header.captured_ns), 2e8 * static_cast<double>(i), 2.0);
    EXPECT_FALSE(color.others);
    // Both see the same instant.
    const Images::Kept& depth = *fast.of("rov_eye/depth")[6 * i];
    EXPECT_EQ(depth.header.captured_ns, color.header.captured_ns);
    EXPECT_EQ(depth.pose.position_m, color.pose.position_m);
    EXPECT_FALSE(depth.others);
  }
  EXPECT_LT(fast.of("rov_eye/depth")[30]->pose.position_m.z, -0.3);  // the vehicle flies
  const Images::Kept& echoes = *fast.of("rov_sonar/echoes")[2];
  EXPECT_EQ(echoes.width, 64u);
  EXPECT_EQ(echoes.height, 400u);
  EXPECT_EQ(echoes.header.sequence, 2u);
  EXPECT_EQ(echoes.header.captured_ns, 500'000'000);
  // Mackenzie (1981) at 10 C, 35 psu and the vehicle's 10 to 11 m: 1489.8 m/s and 0.016 a metre.
  EXPECT_NEAR(echoes.sound_speed_m_s, 1489.97, 0.05);
  EXPECT_EQ(a.counts()[0].given, 6u);
  EXPECT_EQ(b.counts()[1].given, 5u);
}

// The same bits as a frame of that sensor alone, also beside a frame sink, which gets its own
// sensors only.
TEST_F(ImageConsumers, AreNoConcernOfOthers) {
  Images images;
  ImageConsumer one =
      consumer({{"rov_eye/color"}, {"rov_sonar/echoes"}, {"rov_sonar/depth"}}, images);
  Results results;
  run({&one}, &results);
  ASSERT_EQ(results.frames.size(), 5u);
  const auto echoes = images.of("rov_sonar/echoes");
  ASSERT_EQ(echoes.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const FrameResult& frame = results.frames[i];
    EXPECT_TRUE(frame.cameras.empty());
    ASSERT_EQ(frame.sonars.size(), 1u);
    EXPECT_TRUE(frame.sonars[0].sectors.empty());
    const auto& intensity = frame.sonars[0].image.intensity;
    ASSERT_EQ(echoes[i]->data.size(), 4 * intensity.size());
    EXPECT_EQ(std::memcmp(echoes[i]->data.data(), intensity.data(), echoes[i]->data.size()), 0);
  }
  physics_ = LivePhysics::create(scene_, LivePhysics::Pace::kPicture).value();
  Results alone;
  run({}, &alone);
  ASSERT_EQ(alone.frames.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(alone.frames[i].sonars[0].image.intensity,
              results.frames[i].sonars[0].image.intensity);
}

TEST_F(ImageConsumers, WhoIsNotReadyLosesItsOwnImagesAndTheyAreCounted) {
  Images busy, other;
  busy.every = 3;
  ImageConsumer a = consumer({{"rov_eye/labels", 15.0}}, busy),
                b = consumer({{"rov_eye/labels"}}, other);
  run({&a, &b});
  EXPECT_EQ(a.counts()[0].given, 5u);
  EXPECT_EQ(a.counts()[0].dropped, 11u);
  EXPECT_EQ(b.counts()[0].given, 31u);
  EXPECT_EQ(b.counts()[0].dropped, 0u);
  EXPECT_EQ(busy.kept[0].header.sequence, 4u);  // gaps show
  EXPECT_EQ(busy.kept[1].header.sequence, 10u);
}

TEST_F(ImageConsumers, AStreamThatIsNotThereIsRefusedInOneLine) {
  Images images;
  const auto made = ImageConsumer::create(scene_, {{"rov_eye/colour"}}, images);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(exit_status(made.error().code), 2);
  EXPECT_EQ(
      made.error().message,
      "images: found rov_eye/colour; accepted: rov_eye/color, rov_eye/depth, rov_eye/normals, "
      "rov_eye/labels, rov_eye/instances, rov_eye/motion, rov_sonar/echoes, "
      "rov_sonar/echo_labels, rov_sonar/depth, rov_sonar/normals, rov_sonar/labels, "
      "rov_sonar/instances");
}

TEST_F(ImageConsumers, ARateAboveTheSensorsIsRefused) {
  Images images;
  for (const double rate_hz : {4.01, 1e6, -1.0, std::nan(""), HUGE_VAL}) {
    const auto made = ImageConsumer::create(scene_, {{"rov_sonar/echoes", rate_hz}}, images);
    ASSERT_FALSE(made.ok()) << rate_hz;
    EXPECT_EQ(exit_status(made.error().code), 2);
    EXPECT_EQ(made.error().message,
              fmt::format("images of rov_sonar/echoes: found {} Hz; accepted: 0 (the sensor's own "
                          "rate) to 4 Hz, which is that rate",
                          rate_hz));
  }
  EXPECT_TRUE(ImageConsumer::create(scene_, {{"rov_sonar/echoes", 4.0}}, images).ok());
}

TEST_F(ImageConsumers, WishesMayChangeWhileAFrameIsOnItsWay) {
  Images images;
  ImageConsumer c = consumer({}, images);
  FrameRequest none, first, then;
  EXPECT_TRUE(c.ask(none).empty());
  EXPECT_TRUE(none.cameras.empty() && none.sonars.empty());
  EXPECT_TRUE(c.wish({{"rov_eye/depth"}}).ok());
  const auto on_their_way = c.ask(first);
  ASSERT_EQ(on_their_way.size(), 1u);
  NERITIC_ASSERT_OK(FrameResult result, session_->render(first));
  EXPECT_TRUE(c.wish({{"rov_sonar/echoes"}}).ok());
  EXPECT_TRUE(c.give(scene_, on_their_way, result).ok());
  EXPECT_TRUE(images.kept.empty());
  EXPECT_FALSE(c.wish({{"rov_eye/colour"}}).ok());  // which leaves the wishes
  EXPECT_FALSE(c.wish({{"rov_eye/depth"}, {"rov_eye/depth"}}).ok());
  then.time_s = 1.0;
  EXPECT_EQ(c.ask(then).size(), 1u);
  EXPECT_EQ(then.sonars, std::vector<std::size_t>{0});
  EXPECT_TRUE(then.cameras.empty());
  // Another's wish does not make the sonar ping sooner.
  EXPECT_TRUE(c.wish({{"rov_eye/depth"}, {"rov_sonar/echoes"}}).ok());
  FrameRequest soon;
  soon.time_s = 1.0 + 2.0 / 30.0;
  EXPECT_EQ(c.ask(soon).size(), 1u);
  EXPECT_TRUE(soon.sonars.empty());
}

}  // namespace
}  // namespace neritic::testbed
