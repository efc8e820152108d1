#include "testbed/loop/loop.hpp"

#include <algorithm>

#include "engine/core/clock.hpp"

namespace neritic::testbed {
namespace {

constexpr double kSlack_s = 1e-6;  // sums of frames' periods are rounded

PingSchedule schedule_of(const LoopSensors& sensors) {
  const scene::Scene& scene = sensors.session->scene();
  std::vector<double> rates_hz;
  for (const std::size_t i : sensors.cameras) rates_hz.push_back(scene.cameras[i].rate_hz);
  for (const std::size_t i : sensors.sonars) rates_hz.push_back(scene.sonars[i].rate_hz);
  return PingSchedule(rates_hz);
}

void take_due(PingSchedule& schedule, const LoopSensors& sensors, std::uint32_t ping_every,
              FrameRequest& request) {
  for (const PingSchedule::Due& due : schedule.due(request.time_s)) {
    if (due.sensor < sensors.cameras.size()) {
      request.cameras.push_back(sensors.cameras[due.sensor]);
    } else if (due.number % ping_every == 0) {
      request.sonars.push_back(sensors.sonars[due.sensor - sensors.cameras.size()]);
      request.pings.push_back(due.number);
    }
  }
}

// Leaves what the frame sinks asked for; images that others asked for go.
void keep(const scene::Scene& scene, const std::vector<std::size_t>& cameras,
          const std::vector<std::size_t>& sonars, const Capture& capture, FrameResult& result) {
  const auto strip = [&](ViewImages& view) {
    if (!capture.color) view.color = {};
    if (!capture.depth) view.depth = {};
    if (!capture.normals) view.normals = {};
    if (!capture.labels) view.labels = {};
    if (!capture.instances) view.instances = {};
    if (!capture.motion) view.motion = {};
  };
  std::erase_if(result.cameras, [&](const CameraFrame& frame) {
    return std::ranges::none_of(cameras,
                                [&](std::size_t i) { return scene.cameras[i].name == frame.name; });
  });
  std::erase_if(result.sonars, [&](const SonarFrame& frame) {
    return std::ranges::none_of(sonars,
                                [&](std::size_t i) { return scene.sonars[i].name == frame.name; });
  });
  for (CameraFrame& camera : result.cameras) std::ranges::for_each(camera.eyes, strip);
  for (SonarFrame& sonar : result.sonars) {
    if (!capture.echoes) sonar.image = {};
    if (!capture.geometry()) sonar.sectors.clear();
    std::ranges::for_each(sonar.sectors, strip);
  }
}

}  // namespace

Loop::Loop(LoopParts parts) : parts_(std::move(parts)) {
  NERITIC_CHECK(parts_.sensors || (parts_.physics && !parts_.view), "nothing to run");
  if (parts_.sensors)
    for (const ImageConsumer* consumer : parts_.sensors->consumers)
      NERITIC_CHECK(!consumer->takes() ||
                        (parts_.sensors->consumers.size() == 1 && parts_.frame_sinks.empty()),
                    "one takes pixels that others want");
  if (parts_.physics && !parts_.step_sinks.empty())
    steps_.emplace(parts_.physics->world(), parts_.step_sinks);
  if (parts_.sensors && parts_.sensors->own_rates) schedule_ = schedule_of(*parts_.sensors);
}

Status Loop::run() {
  begin();
  return end(run_frames());
}

void Loop::begin() {
  begun_ns_ = now_ns();
  restart_images();
  if (parts_.physics) {
    if (steps_)
      parts_.physics->observe([this](const auto& step) { steps_->accept(step); },
                              [this](const Sample& sample) { steps_->use(sample); });
    parts_.physics->listen(parts_.sources);
  }
}

// The images' beats begin where the simulation is now.
void Loop::restart_images() {
  if (parts_.physics) restored_ = parts_.physics->restored();
  if (!parts_.sensors) return;
  for (ImageConsumer* consumer : parts_.sensors->consumers) consumer->restart();
}

Status Loop::end(const Status& status) {
  if (parts_.physics) {
    parts_.physics->stop();
    // The physics may outlive the loop and its parts.
    parts_.physics->observe({});
    parts_.physics->listen({});
  }
  wall_s_ = to_ms(now_ns() - begun_ns_) * 1e-3;
  return finish(status);
}

Status Loop::run_frames() {
  while (!last_ && !quit_ && !stopped()) NERITIC_TRY_STATUS(frame());
  NERITIC_TRY_STATUS(give_done(true));
  return parts_.view ? parts_.view->finish() : Status();
}

bool Loop::stopped() {
  interrupted_ = interrupted_ || (parts_.stop.interrupted && parts_.stop.interrupted());
  return interrupted_ || (steps_ && steps_->failed()) ||
         (parts_.physics && !parts_.physics->listening().ok());
}

Status Loop::frame() {
  FrameView* view = parts_.view;
  std::optional<TimeNs> display_at_ns;
  if (view) {
    NERITIC_TRY(const xr::FrameVerdict verdict, view->begin_frame());
    if (verdict == xr::FrameVerdict::kQuit) {
      quit_ = true;
      return {};
    }
    display_at_ns = view->display_at_ns();
  }
  const Status status = frame_at(display_at_ns);
  if (!view || !view->in_frame()) return status;
  // A stop or an error cut the frame short, or nothing was drawn: it is ended all the same.
  const Status ended = view->end_frame(std::nullopt);
  return status.ok() ? ended : status;
}

Status Loop::frame_at(std::optional<TimeNs> display_at_ns) {
  FrameView* view = parts_.view;
  const FrameTime at = parts_.clock.next(display_at_ns);
  if (!std::exchange(started_, true)) {
    if (parts_.stop.seconds > 0.0) {
      end_s_ = at.time_s + parts_.stop.seconds;
      if (parts_.physics) parts_.physics->end_after(parts_.stop.seconds);
    }
    if (parts_.physics) parts_.physics->start();
  }
  if (view && view->take_input()) quit_ = true;  // after this frame
  const double time_s = advance(at);
  if (stopped()) return {};
  last_ = is_last(time_s);
  if (!parts_.sensors) {
    ++frames_;
    return {};
  }
  Wanted wanted = wanted_at(at, time_s);
  if (parts_.physics && wanted.request.wants_motion()) {
    // The pixels of a motion image lead to the next frame.
    parts_.physics->reach(wanted.request.next_time_s, [this] { return stopped(); });
    if (stopped()) return {};
  }
  return view ? show(std::move(wanted)) : sense(std::move(wanted));
}

// The simulation, up to the frame; gives the frame's scene time.
double Loop::advance(const FrameTime& at) {
  LivePhysics* physics = parts_.physics;
  const double time_s = std::min(at.time_s, end_s_);
  if (!physics) return time_s;
  if (parts_.clock.is_real() && physics->pace() == LivePhysics::Pace::kPicture)
    physics->keep_pace(
        parts_.sensors ? at.time_s : physics->newest().time_s + physics->world().step_s(),
        at.host_ns);
  if (parts_.sensors)
    return std::min(physics->follow(at.run_ns, time_s, [this] { return stopped(); }), end_s_);
  physics->advance();
  return physics->newest().time_s;
}

// Whether the frame at that time ends the run. One that is hidden is none of stop.frames.
bool Loop::is_last(double time_s) const {
  const bool counts = !parts_.view || parts_.view->shown();
  return (parts_.stop.frames > 0 && counts && frames_ + 1 >= parts_.stop.frames) ||
         (time_s >= end_s_ - kSlack_s && (!parts_.physics || parts_.physics->ended()));
}

Loop::Wanted Loop::wanted_at(const FrameTime& at, double time_s) {
  const LoopSensors& sensors = *parts_.sensors;
  Wanted wanted;
  FrameRequest& request = wanted.request;
  request.time_s = time_s;
  // When the next frame of a thread's simulation is, only its clock will say.
  request.next_time_s = time_s == at.time_s ? at.next_time_s : time_s;
  request.frame = static_cast<std::uint32_t>(sensed_);
  request.capture = sensors.capture;
  if (parts_.physics) request.simulated = &parts_.physics->motion();
  // Before the physics reaches on for motion: they show the frame's own time.
  if (parts_.pictures) parts_.pictures->follow();
  request.pictures = parts_.pictures;
  if (schedule_) {
    take_due(*schedule_, sensors, parts_.view ? parts_.view->ping_every() : 1, request);
  } else {
    request.cameras = sensors.cameras;
    request.sonars = sensors.sonars;
  }
  if (sensors.consumers.empty()) return wanted;
  if (parts_.physics && parts_.physics->restored() != restored_) restart_images();
  wanted.cameras = request.cameras;
  wanted.sonars = request.sonars;
  request.camera_captures.assign(request.cameras.size(), request.capture);
  request.sonar_captures.assign(request.sonars.size(), request.capture);
  request.pings.resize(request.sonars.size(), request.frame);
  for (ImageConsumer* consumer : sensors.consumers)
    wanted.of_consumers.push_back(consumer->ask(request));
  return wanted;
}

// A frame that nobody looks at.
Status Loop::sense(Wanted wanted) {
  const LoopSensors& sensors = *parts_.sensors;
  const FrameRequest& request = wanted.request;
  ++frames_;
  wanted.for_sinks =
      !sensors.cameras.empty() || !sensors.sonars.empty() || sensors.consumers.empty();
  // Consumers alone, none of which is due.
  if (!wanted.for_sinks && request.cameras.empty() && request.sonars.empty()) return {};
  NERITIC_TRY(FrameResult result, sensors.session->render(request));
  if (wanted.for_sinks) ++sensed_;
  return give(wanted, std::move(result));
}

// A frame of the view, and of the sensors that are due, whether it is seen or hidden.
Status Loop::show(Wanted wanted) {
  FrameView& view = *parts_.view;
  Session& session = *parts_.sensors->session;
  FrameRequest& request = wanted.request;
  const bool senses = !request.cameras.empty() || !request.sonars.empty();
  const bool sinks_due = parts_.sensors->consumers.empty()
                             ? senses
                             : !wanted.cameras.empty() || !wanted.sonars.empty();
  if (view.shown()) view.add_views(request);
  if (!senses && !view.shown()) return {};
  graph::FrameGraph graph;
  NERITIC_TRY(auto frame, session.declare(graph, request));
  NERITIC_TRY_STATUS(view.declare(graph, *frame, request.time_s, last_));
  NERITIC_TRY(gpu::Commands * commands, session.frames().begin());
  NERITIC_TRY(const graph::Plan* plan, session.executor().run(graph, *commands));
  (void)plan;
  NERITIC_TRY(const std::uint64_t value, session.frames().submit(view.sync()));
  frame->submitted(value);
  NERITIC_TRY_STATUS(view.end_frame(value));
  frames_ += view.shown() ? 1 : 0;
  const bool asked =
      std::ranges::any_of(wanted.of_consumers, [](const auto& list) { return !list.empty(); });
  wanted.for_sinks = sinks_due && request.capture.to_host;
  // Frames in flight have their numbers already.
  if (wanted.for_sinks) ++sensed_;
  if (wanted.for_sinks || asked) pending_.push_back({std::move(frame), std::move(wanted)});
  return give_done(false);
}

// Gives the frame sinks what the GPU has finished; wait: all of it.
Status Loop::give_done(bool wait) {
  for (; !pending_.empty(); pending_.pop_front()) {
    Session& session = *parts_.sensors->session;
    const SensorFrame& frame = *pending_.front().frame;
    if (wait) NERITIC_TRY_STATUS(session.frames().wait(frame.done_at()));
    NERITIC_TRY(const bool done, session.is_done(frame));
    if (!done) break;
    NERITIC_TRY(FrameResult result, session.read(frame));
    NERITIC_TRY_STATUS(give(pending_.front().wanted, std::move(result)));
  }
  return {};
}

// The consumers get what they asked for, the frame sinks the rest of the sensors.
Status Loop::give(const Wanted& wanted, FrameResult result) {
  const LoopSensors& sensors = *parts_.sensors;
  const scene::Scene& scene = sensors.session->scene();
  for (std::size_t i = 0; i < wanted.of_consumers.size(); ++i)
    NERITIC_TRY_STATUS(sensors.consumers[i]->give(scene, wanted.of_consumers[i], result));
  if (!wanted.for_sinks) return {};
  if (!sensors.consumers.empty())
    keep(scene, wanted.cameras, wanted.sonars, sensors.capture, result);
  for (FrameSink* sink : parts_.frame_sinks) NERITIC_TRY_STATUS(sink->accept(result));
  return {};
}

Status Loop::finish(const Status& status) {
  Status first = status;
  const auto keep_first = [&](const Status& next) {
    if (first.ok()) first = next;
  };
  if (parts_.physics) keep_first(parts_.physics->listening());
  if (steps_) keep_first(steps_->finish());
  if (parts_.sensors)
    for (ImageConsumer* consumer : parts_.sensors->consumers) keep_first(consumer->finish());
  if (!status.ok() || sensed_ == 0) return first;
  for (FrameSink* sink : parts_.frame_sinks) keep_first(sink->finish());
  return first;
}

}  // namespace neritic::testbed
