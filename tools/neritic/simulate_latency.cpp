// `neritic simulate latency`: the time from a suit's packet to the first picture that shows it. A
// suit sends by loopback, its thread, the simulation's and the pictures run as in a window, without
// the window: its screen adds its own delay.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/json.hpp"
#include "engine/core/refusal.hpp"
#include "engine/gpu/device.hpp"
#include "engine/sim/run_clock.hpp"
#include "testbed/sensors/session.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/simulate.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kLatencySeconds = 10.0;

// Packets by the step that used them; from the stepping thread to the pictures'.
class UsedPackets {
 public:
  void use(const Sample& sample) {
    if (sample.kind() != PayloadKind::kBodyJoints) return;
    const std::lock_guard lock(mutex_);
    used_.push_back({step_ + 1, sample.header.arrived_ns});
  }
  void step(std::uint64_t step) {
    const std::lock_guard lock(mutex_);
    step_ = step;
  }
  // Arrivals that the state after that step shows, and no picture before.
  std::vector<TimeNs> shown_by(std::uint64_t step) {
    const std::lock_guard lock(mutex_);
    std::vector<TimeNs> out;
    for (; !used_.empty() && used_.front().step <= step; used_.pop_front())
      out.push_back(used_.front().arrived_ns);
    return out;
  }

 private:
  struct Used {
    std::uint64_t step = 0;
    TimeNs arrived_ns = 0;
  };
  std::mutex mutex_;
  std::uint64_t step_ = 0;
  std::deque<Used> used_;
};

struct Times {
  double median_ms = 0.0, p99_ms = 0.0, most_ms = 0.0;
};
Times times_of(std::vector<double> all) {
  if (all.empty()) return {};
  std::ranges::sort(all);
  return {all[all.size() / 2], all[(all.size() - 1) * 99 / 100], all.back()};
}
nlohmann::json times_json(const Times& t) {
  return {{"median", t.median_ms}, {"p99", t.p99_ms}, {"largest", t.most_ms}};
}

// A suit that kicks, in real time.
void send_suit(const net::UdpSender& sender, const std::atomic<bool>& stop) {
  const auto suit = simulated_device("mxtp", {});
  PersonActs acts;
  while (!stop) {
    const TimeNs now = now_ns();
    const double kick = 0.4 * std::sin(2.0 * kPi * 1e-9 * static_cast<double>(now % kSecond_ns));
    acts.joints[diver::joint_of(diver::kLeftUpperLeg)] = glm::angleAxis(kick, Vec3(0, 1, 0));
    acts.joints[diver::joint_of(diver::kRightUpperLeg)] = glm::angleAxis(-kick, Vec3(0, 1, 0));
    suit->run(acts, now, [&](std::vector<std::byte> bytes, TimeNs) { (void)sender.send(bytes); });
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

Status simulate_latency(const SimulateFlags& flags, scene::Scene scene,
                        const Interrupt& interrupt) {
  if (scene.cameras.empty())
    return refusal(flags.scene, "a scene without a camera", "one with one");
  const auto suit = std::ranges::find_if(scene.sources, [](const scene::DeviceSource& s) {
    return s.device == "mxtp" && s.by == "udp";
  });
  if (suit == scene.sources.end())
    return refusal(flags.scene, "no suit by udp among its [sources]", "suit = \"mxtp udp 9763\"");
  std::pair<std::uint32_t, std::uint32_t> size{320, 180};
  if (!flags.size.empty()) {
    NERITIC_TRY(size, parse_size("--size", flags.size));
  }
  scene.cameras[0].width = size.first, scene.cameras[0].height = size.second;
  const double rate_hz = flags.picture_hz > 0.0 ? flags.picture_hz : scene.cameras[0].rate_hz;
  Address to = suit->address;
  to.ipv4 = Address().ipv4;
  NERITIC_TRY(const net::UdpSender sender, net::UdpSender::create(to));
  NERITIC_TRY(auto made, PhysicsWorld::create(scene));
  sim::HostClock host;
  sim::RunClock run(host);
  UsedPackets used;
  const auto physics =
      LivePhysics::create(std::move(made), {.pace = LivePhysics::Pace::kClock, .clock = &run});
  physics->await_steps(LivePhysics::kPictureWait);
  physics->observe([&](const sim::Snapshot<PhysicsState>& step) { used.step(step.step); },
                   [&](const Sample& sample) { used.use(sample); });
  gpu::DeviceOptions device_options;
  device_options.device = flags.device;
  device_options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(device_options));
  const scene::Scene read = scene;
  NERITIC_TRY(const auto session, Session::create(*device, std::move(scene)));
  NERITIC_TRY(const auto devices,
              Devices::open(read, physics->world(), physics->inbox(), DeviceSource::Pace::kThread));
  std::atomic<bool> stop{false};
  std::thread sending([&] { send_suit(sender, stop); });
  physics->start();
  const auto period_ns = static_cast<TimeNs>(1e9 / rate_hz);
  const double seconds = flags.seconds.value_or(kLatencySeconds);
  std::vector<double> newest_ms, all_ms, drawn_ms, frame_ms;
  TimeNs last_ns = 0;  // the frame before began
  Status status;
  TimeNs due_ns = now_ns();
  const TimeNs end_ns = due_ns + static_cast<TimeNs>(1e9 * seconds);
  for (std::uint32_t frame = 0; now_ns() < end_ns && !interrupt.requested() && status.ok();
       ++frame) {
    due_ns = std::max(due_ns + period_ns, now_ns() - period_ns);
    if (const TimeNs wait_ns = due_ns - now_ns(); wait_ns > 0)
      std::this_thread::sleep_for(std::chrono::nanoseconds(wait_ns));
    const TimeNs frame_ns = now_ns();
    FrameRequest request;
    request.time_s = physics->follow(run.now(), 0.0);
    const TimeNs begun_ns = now_ns();
    request.next_time_s = request.time_s + 1.0 / rate_hz;
    request.frame = frame;
    request.cameras = {0};
    request.capture = Capture{.motion = false}.without_geometry();
    request.simulated = &physics->motion();
    const std::uint64_t step = physics->shown_snapshot().step;
    const auto rendered = session->render(request);
    if (!rendered.ok()) status = rendered.error();
    const TimeNs done_ns = now_ns();
    const std::vector<TimeNs> arrived = used.shown_by(step);
    const TimeNs between_ns = frame_ns - std::exchange(last_ns, frame_ns);
    if (frame < 5 || arrived.empty()) continue;  // pipelines are made, caches are cold
    frame_ms.push_back(to_ms(between_ns));
    drawn_ms.push_back(to_ms(done_ns - begun_ns));
    newest_ms.push_back(to_ms(done_ns - arrived.back()));
    for (const TimeNs at_ns : arrived) all_ms.push_back(to_ms(done_ns - at_ns));
  }
  stop = true;
  sending.join();
  physics->stop();
  physics->observe({});
  NERITIC_TRY_STATUS(status);
  if (newest_ms.empty()) return failure(ErrorCode::kUnsupported, "no picture showed a packet");
  const Times newest = times_of(newest_ms), all = times_of(all_ms), drawn = times_of(drawn_ms);
  const double period_ms = times_of(frame_ms).median_ms, step_ms = 1e3 * physics->world().step_s();
  if (flags.json) {
    fmt::print("{}\n", json_text({{"device", device->info().name},
                                  {"pictures", newest_ms.size()},
                                  {"frame_ms", period_ms},
                                  {"step_ms", step_ms},
                                  {"drawing_ms", times_json(drawn)},
                                  {"newest_packet_to_picture_ms", times_json(newest)},
                                  {"packet_to_first_picture_ms", times_json(all)},
                                  {"steps_dropped", physics->counts().dropped}}));
    return {};
  }
  fmt::print(
      "{} x {} on {}, a frame {:.1f} ms (drawing {:.1f}), a step {:.1f} ms\n"
      "newest packet to its picture: median {:.1f} ms, 99 % {:.1f}, largest {:.1f}; a frame and a "
      "step are {:.1f}\n"
      "any packet to the first picture that shows it: median {:.1f} ms, 99 % {:.1f}, largest "
      "{:.1f}\n",
      size.first, size.second, device->info().name, period_ms, drawn.median_ms, step_ms,
      newest.median_ms, newest.p99_ms, newest.most_ms, period_ms + step_ms, all.median_ms,
      all.p99_ms, all.most_ms);
  return {};
}

}  // namespace neritic::tools
