// `neritic simulate latency`: the time from a suit's packet to the picture that shows it. A suit
// sends by loopback; its thread, the simulation's and the loop of pictures run as in a window,
// without the window: its screen adds its own delay.
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
#include "engine/core/thread_urgency.hpp"
#include "engine/gpu/device.hpp"
#include "engine/sim/run_clock.hpp"
#include "engine/xr/offscreen.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/sensors/session.hpp"
#include "testbed/view/dive_view.hpp"
#include "tools/neritic/flags.hpp"
#include "tools/neritic/simulate.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

constexpr double kLatencySeconds = 10.0;
constexpr std::chrono::microseconds kLook{200};  // whether the device is done
constexpr double kTaking_ms = 0.5;               // a packet on its way into a step
constexpr std::size_t kFirst = 5;                // pipelines are made, caches are cold

// When a packet came, and when a step took it.
struct SuitPacket {
  TimeNs arrived_ns = 0, taken_ns = 0;
};

// Packets by the step that used them; from the stepping thread to the pictures'.
class UsedPackets final : public StepSink {
 public:
  Status use(const Sample& sample) override {
    if (sample.kind() != PayloadKind::kBodyJoints) return {};
    const std::lock_guard lock(mutex_);
    used_.push_back({step_ + 1, {sample.header.arrived_ns, now_ns()}});
    return {};
  }
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample>) override {
    const std::lock_guard lock(mutex_);
    step_ = step.step;
    return {};
  }
  Status finish() override { return {}; }
  // Those that the state after that step shows, and no picture before.
  std::vector<SuitPacket> shown_by(std::uint64_t step) {
    const std::lock_guard lock(mutex_);
    std::vector<SuitPacket> out;
    for (; !used_.empty() && used_.front().step <= step; used_.pop_front())
      out.push_back(used_.front().packet);
    return out;
  }

 private:
  struct Used {
    std::uint64_t step = 0;
    SuitPacket packet;
  };
  std::mutex mutex_;
  std::uint64_t step_ = 0;
  std::deque<Used> used_;
};

struct TimedPicture {
  std::uint64_t submission = 0;
  TimeNs begun_ns = 0;              // when it took the state that it shows
  std::vector<SuitPacket> packets;  // that no picture before it showed
  TimeNs done_ns = 0;               // 0: not yet
};

// A view whose pictures are timed; a thread of its own looks when the device is done.
class TimedView final : public FrameView {
 public:
  TimedView(DiveView& view, const LivePhysics& physics, gpu::Frames& frames, UsedPackets& used,
            double rate_hz)
      : view_(view),
        physics_(physics),
        frames_(frames),
        used_(used),
        period_ns_(static_cast<TimeNs>(1e9 / rate_hz)),
        pacer_(rate_hz, 1, now_ns()),
        looking_([this] { look(); }) {}
  ~TimedView() override { stop(); }
  TimedView(const TimedView&) = delete;
  TimedView& operator=(const TimedView&) = delete;

  // As a window's: it waits for the device and for its time, and is seen a period later.
  Result<xr::FrameVerdict> begin_frame() override {
    NERITIC_TRY(const xr::FrameVerdict verdict, view_.begin_frame());
    while (pacer_.take(now_ns()) == 0) host_.wait_until(pacer_.next_ns());
    display_at_ns_ = now_ns() + period_ns_;
    return verdict;
  }
  std::optional<TimeNs> display_at_ns() const override { return display_at_ns_; }
  bool shown() const override { return view_.shown(); }
  bool in_frame() const override { return view_.in_frame(); }
  bool take_input() override { return view_.take_input(); }
  std::uint32_t ping_every() const override { return view_.ping_every(); }
  void add_views(FrameRequest& request) override {
    now_ = {.begun_ns = now_ns(), .packets = used_.shown_by(physics_.shown_snapshot().step)};
    view_.add_views(request);
  }
  Status declare(graph::FrameGraph& graph, const SensorFrame& frame, double time_s,
                 bool last) override {
    return view_.declare(graph, frame, time_s, last);
  }
  gpu::Frames::SubmitSync sync() const override { return view_.sync(); }
  Status end_frame(std::optional<std::uint64_t> value) override {
    if (value) {
      const std::lock_guard lock(mutex_);
      now_.submission = *value;
      pictures_.push_back(std::exchange(now_, {}));
    }
    return view_.end_frame(value);
  }
  Status finish() override { return view_.finish(); }

  // All that are done, from the first.
  std::vector<TimedPicture> stop() {
    stop_ = true;
    if (looking_.joinable()) looking_.join();
    std::erase_if(pictures_, [](const TimedPicture& picture) { return picture.done_ns == 0; });
    return {pictures_.begin(), pictures_.end()};
  }

 private:
  void look() {
    for (std::size_t next = 0; !stop_;) {
      std::this_thread::sleep_for(kLook);
      const auto completed = frames_.completed();
      if (!completed.ok()) return;
      const std::lock_guard lock(mutex_);
      for (; next < pictures_.size() && pictures_[next].submission <= *completed; ++next)
        pictures_[next].done_ns = now_ns();
    }
  }

  DiveView& view_;
  const LivePhysics& physics_;
  gpu::Frames& frames_;
  UsedPackets& used_;
  TimeNs period_ns_, display_at_ns_ = 0;
  sim::HostClock host_;
  sim::StepPacer pacer_;
  TimedPicture now_;
  std::mutex mutex_;
  std::deque<TimedPicture> pictures_;
  std::atomic<bool> stop_{false};
  std::thread looking_;  // last: it uses what is above
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
std::string times_words(const Times& t) {
  return fmt::format("median {:.1f} ms, 99 % {:.1f}, largest {:.1f}", t.median_ms, t.p99_ms,
                     t.most_ms);
}

// Times of each picture; a frame is from the end of the picture before to its own.
struct Latencies {
  std::vector<double> frame_ms, drawing_ms;
  std::vector<double> newest_ms;  // from its newest packet to its end
  std::vector<double> taken_ms;   // of that: until a step took it
  std::vector<double> waited_ms;  // and until the picture began
  std::vector<double> beyond_ms;  // of that: beyond its own frame
  std::vector<double> any_ms;     // from each packet to the end of the first picture that shows it
  // Pictures beyond their frame and a step: the next packet was there before the picture began, but
  // its device's thread or a step had not run yet; or it came more than a step after the newest,
  // since its sender was late.
  std::size_t late_thread = 0, late_sender = 0, late_else = 0;
};
Latencies latencies_of(const std::vector<TimedPicture>& pictures, double step_ms) {
  Latencies out;
  for (std::size_t i = kFirst; i < pictures.size(); ++i) {
    const TimedPicture& picture = pictures[i];
    const double frame_ms = to_ms(picture.done_ns - pictures[i - 1].done_ns);
    out.frame_ms.push_back(frame_ms);
    out.drawing_ms.push_back(to_ms(picture.done_ns - picture.begun_ns));
    for (const SuitPacket& packet : picture.packets)
      out.any_ms.push_back(to_ms(picture.done_ns - packet.arrived_ns));
    if (picture.packets.empty()) continue;
    const SuitPacket& newest = picture.packets.back();
    out.newest_ms.push_back(to_ms(picture.done_ns - newest.arrived_ns));
    out.taken_ms.push_back(to_ms(newest.taken_ns - newest.arrived_ns));
    out.waited_ms.push_back(to_ms(picture.begun_ns - newest.arrived_ns));
    out.beyond_ms.push_back(out.newest_ms.back() - frame_ms);
    if (out.beyond_ms.back() < step_ms) continue;
    const auto next =
        std::find_if(pictures.begin() + static_cast<std::ptrdiff_t>(i) + 1, pictures.end(),
                     [](const auto& p) { return !p.packets.empty(); });
    const TimeNs next_ns = next == pictures.end() ? 0 : next->packets.front().arrived_ns;
    const bool known = next != pictures.end();
    if (known && to_ms(picture.begun_ns - next_ns) > kTaking_ms)
      ++out.late_thread;
    else if (known && to_ms(next_ns - newest.arrived_ns) > step_ms)
      ++out.late_sender;
    else
      ++out.late_else;
  }
  return out;
}

void tell(const Latencies& all, bool json, const std::string& device, const xr::ViewGroup& size,
          double step_ms, std::uint64_t dropped) {
  const Times frame = times_of(all.frame_ms), drawing = times_of(all.drawing_ms),
              newest = times_of(all.newest_ms), taken = times_of(all.taken_ms),
              waited = times_of(all.waited_ms), beyond = times_of(all.beyond_ms),
              any = times_of(all.any_ms);
  const auto within = static_cast<std::size_t>(
      std::ranges::count_if(all.beyond_ms, [&](double ms) { return ms < step_ms; }));
  const double share = static_cast<double>(within) / static_cast<double>(all.beyond_ms.size());
  if (json) {
    fmt::print("{}\n",
               json_text({{"device", device},
                          {"pictures", all.newest_ms.size()},
                          {"frame_ms", times_json(frame)},
                          {"step_ms", step_ms},
                          {"drawing_ms", times_json(drawing)},
                          {"newest_packet_to_picture_ms", times_json(newest)},
                          {"newest_packet_to_its_step_ms", times_json(taken)},
                          {"newest_packet_to_begin_ms", times_json(waited)},
                          {"newest_packet_to_picture_beyond_its_frame_ms", times_json(beyond)},
                          {"within_its_frame_and_a_step", share},
                          {"beyond_by_a_late_thread", all.late_thread},
                          {"beyond_by_a_late_sender", all.late_sender},
                          {"beyond_else", all.late_else},
                          {"packet_to_first_picture_ms", times_json(any)},
                          {"steps_dropped", dropped}}));
    return;
  }
  fmt::print(
      "{} x {} on {}, {} pictures, a step {:.1f} ms, {} steps dropped\n"
      "a frame: {}\n  of it from the state to the end of drawing: {}\n"
      "newest packet to its picture: {}\n  of it until a step took it: {}\n"
      "  and until the picture began: {}\n"
      "  beyond the picture's own frame: {}; within that frame and a step: {:.1f} %\n"
      "  {} pictures later: {} by a thread that woke late, {} by a packet that came late\n"
      "any packet to the first picture that shows it: {}\n",
      size.width, size.height, device, all.newest_ms.size(), step_ms, dropped, times_words(frame),
      times_words(drawing), times_words(newest), times_words(taken), times_words(waited),
      times_words(beyond), 100.0 * share, all.beyond_ms.size() - within, all.late_thread,
      all.late_sender, times_words(any));
}

// A suit that kicks, in real time.
void send_suit(const net::UdpSender& sender, const std::atomic<bool>& stop) {
  constexpr double kSuit_hz = 240.0;
  set_urgency(ThreadUrgency::kSoon);  // it stands for a machine of its own
  const auto suit = simulated_device("mxtp", {.rate_hz = kSuit_hz});
  PersonActs acts;
  sim::HostClock host;
  sim::StepPacer pacer(kSuit_hz, 1, now_ns());
  while (!stop) {
    if (pacer.take(now_ns()) == 0) {
      host.wait_until(pacer.next_ns());
      continue;
    }
    const TimeNs now = pacer.taken_ns(1, 0);
    const double kick = 0.4 * std::sin(2.0 * kPi * 1e-9 * static_cast<double>(now % kSecond_ns));
    acts.joints[diver::joint_of(diver::kLeftUpperLeg)] = glm::angleAxis(kick, Vec3(0, 1, 0));
    acts.joints[diver::joint_of(diver::kRightUpperLeg)] = glm::angleAxis(-kick, Vec3(0, 1, 0));
    suit->run(acts, now, [&](std::vector<std::byte> bytes, TimeNs) { (void)sender.send(bytes); });
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
  const scene::Camera camera = scene.cameras[0];
  const double rate_hz = flags.picture_hz > 0.0 ? flags.picture_hz : camera.rate_hz;
  Address to = suit->address;
  to.ipv4 = Address().ipv4;
  NERITIC_TRY(const net::UdpSender sender, net::UdpSender::create(to));
  NERITIC_TRY(auto made, PhysicsWorld::create(scene));
  sim::HostClock host;
  sim::RunClock run(host);
  UsedPackets used;
  const auto physics =
      LivePhysics::create(std::move(made), {.pace = LivePhysics::Pace::kClock, .clock = &run});
  physics->hasten_steps(true);
  gpu::DeviceOptions device_options;
  device_options.device = flags.device;
  device_options.cache_folder = gpu::default_cache_folder();
  NERITIC_TRY(const auto device, gpu::Device::create(device_options));
  const scene::Scene read = scene;
  NERITIC_TRY(const auto session, Session::create(*device, std::move(scene)));
  const xr::ViewGroup group = xr::one_view(size.first, size.second, camera.vertical_fov_rad);
  NERITIC_TRY(const auto display, xr::OffscreenDisplay::create(*device, {.groups = {group}}));
  NERITIC_TRY(const auto devices,
              Devices::open(read, physics->world(), physics->inbox(), DeviceSource::Pace::kThread));
  NERITIC_TRY(const auto view, DiveView::create(*session, *display, nullptr, physics.get(),
                                                {.may_fly = false, .clock = &run}));
  TimedView timed(*view, *physics, session->frames(), used, rate_hz);
  Loop loop(
      {.clock = Clock::real(0.0, 1.0 / rate_hz, Clock::Frames::kPictures, &run),
       .physics = physics.get(),
       .sensors = LoopSensors{.session = session.get(), .capture = kColorOnGpu, .own_rates = true},
       .view = &timed,
       .step_sinks = {&used},
       .stop = {.seconds = flags.seconds.value_or(kLatencySeconds),
                .interrupted = [&] { return interrupt.requested(); }}});
  std::atomic<bool> stop{false};
  std::thread sending([&] { send_suit(sender, stop); });
  const Status status = loop.run();
  stop = true;
  sending.join();
  const Latencies all = latencies_of(timed.stop(), 1e3 * physics->world().step_s());
  NERITIC_TRY_STATUS(status);
  if (all.newest_ms.empty()) return failure(ErrorCode::kUnsupported, "no picture showed a packet");
  tell(all, flags.json, device->info().name, group, 1e3 * physics->world().step_s(),
       physics->counts().dropped);
  return {};
}

}  // namespace neritic::tools
