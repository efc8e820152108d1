#include "testbed/loop/loop.hpp"

#include "engine/core/clock.hpp"

namespace neritic::testbed {
namespace {

PingSchedule schedule_of(const LoopSensors& sensors) {
  const scene::Scene& scene = sensors.session->scene();
  std::vector<double> rates_hz;
  for (const std::size_t i : sensors.cameras) rates_hz.push_back(scene.cameras[i].rate_hz);
  for (const std::size_t i : sensors.sonars) rates_hz.push_back(scene.sonars[i].rate_hz);
  return PingSchedule(rates_hz);
}

}  // namespace

Loop::Loop(LoopParts parts) : parts_(std::move(parts)) {
  if (parts_.physics && !parts_.step_sinks.empty())
    steps_.emplace(parts_.physics->world(), parts_.step_sinks);
  if (parts_.sensors && parts_.sensors->own_rates) schedule_ = schedule_of(*parts_.sensors);
}

Status Loop::run() {
  const TimeNs begun_ns = now_ns();
  if (parts_.physics) {
    if (steps_) parts_.physics->observe([this](const auto& step) { steps_->accept(step); });
    parts_.physics->listen(parts_.sources);
    parts_.physics->start();
  }
  const Status status = run_frames();
  if (parts_.physics) parts_.physics->stop();
  wall_s_ = to_ms(now_ns() - begun_ns) * 1e-3;
  return finish(status);
}

Status Loop::run_frames() {
  while (parts_.stop.frames == 0 || frames_ < parts_.stop.frames) {
    if (stopped()) return {};
    NERITIC_TRY_STATUS(frame());
  }
  return {};
}

bool Loop::stopped() {
  interrupted_ = interrupted_ || (parts_.stop.interrupted && parts_.stop.interrupted());
  return interrupted_ || (steps_ && steps_->failed()) ||
         (parts_.physics && !parts_.physics->listening().ok());
}

Status Loop::frame() {
  const FrameTime at = parts_.clock.next(std::nullopt);
  if (!parts_.sensors) {
    parts_.physics->advance();
    if (parts_.physics->listening().ok()) ++frames_;
    return {};
  }
  return sense(at);
}

Status Loop::sense(const FrameTime& at) {
  const LoopSensors& sensors = *parts_.sensors;
  FrameRequest request;
  request.time_s = at.time_s;
  request.next_time_s = at.next_time_s;
  request.frame = static_cast<std::uint32_t>(frames_);
  request.cameras = sensors.cameras;
  request.sonars = sensors.sonars;
  request.capture = sensors.capture;
  if (schedule_) take_due(request);
  if (LivePhysics* physics = parts_.physics) {
    const auto stop = [this] { return stopped(); };
    physics->follow(at.host_ns, request.time_s, stop);
    // The pixels of a motion image lead to the next frame.
    if (request.capture.motion && !request.cameras.empty())
      physics->reach(request.next_time_s, stop);
    if (stopped()) return {};
    request.simulated = &physics->motion();
  }
  NERITIC_TRY(const FrameResult result, sensors.session->render(request));
  ++frames_;
  for (FrameSink* sink : parts_.frame_sinks) NERITIC_TRY_STATUS(sink->accept(result));
  return {};
}

void Loop::take_due(FrameRequest& request) {
  const LoopSensors& sensors = *parts_.sensors;
  request.cameras.clear();
  request.sonars.clear();
  for (const PingSchedule::Due& due : schedule_->due(request.time_s)) {
    if (due.sensor < sensors.cameras.size()) {
      request.cameras.push_back(sensors.cameras[due.sensor]);
    } else {
      request.sonars.push_back(sensors.sonars[due.sensor - sensors.cameras.size()]);
      request.pings.push_back(due.number);
    }
  }
}

Status Loop::finish(const Status& status) {
  Status first = status;
  const auto keep = [&](const Status& next) {
    if (first.ok()) first = next;
  };
  if (parts_.physics) keep(parts_.physics->listening());
  if (steps_) keep(steps_->finish());
  if (!status.ok() || frames_ == 0) return first;
  for (FrameSink* sink : parts_.frame_sinks) keep(sink->finish());
  return first;
}

}  // namespace neritic::testbed
