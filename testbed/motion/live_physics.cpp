#include "testbed/motion/live_physics.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::testbed {
namespace {

std::unique_ptr<PhysicsSimulation> simulation_of(const PhysicsWorld& world,
                                                 const LivePhysics::Options& options) {
  auto simulation = world.simulation({.log = false}, options.threads);
  if (options.start) restore_state(*simulation, *options.start);
  return simulation;
}

}  // namespace

LivePhysics::LivePhysics(std::unique_ptr<const PhysicsWorld> world, const Options& options)
    : world_(std::move(world)),
      pace_(options.pace),
      clock_(options.clock ? options.clock : &host_),
      simulation_(simulation_of(*world_, options)),
      history_(moved_objects(*world_), world_->followed()),
      start_step_(simulation_->newest().step),
      shown_s_(simulation_->newest().time_s) {
  begin_history();
  if (pace_ == Pace::kClock) reader_ = simulation_->reader();
}

Result<std::unique_ptr<LivePhysics>> LivePhysics::create(const scene::Scene& scene, Pace pace) {
  NERITIC_TRY(auto world, PhysicsWorld::create(scene));
  return create(std::move(world), {.pace = pace});
}

std::unique_ptr<LivePhysics> LivePhysics::create(std::unique_ptr<const PhysicsWorld> world,
                                                 const Options& options) {
  return std::unique_ptr<LivePhysics>(new LivePhysics(std::move(world), options));
}

LivePhysics::~LivePhysics() {
  simulation_->stop();
}

void LivePhysics::observe(const Observer& each, const Used& used) {
  if (each) each(simulation_->newest());
  simulation_->observe(each, used);
}

void LivePhysics::end_after(double seconds) {
  constexpr double kSlack = 1e-9;  // steps are sums of rounded times
  simulation_->end_at(start_step_ +
                      static_cast<std::uint64_t>(std::ceil(seconds / world_->step_s() - kSlack)));
}

bool LivePhysics::ended() const {
  return shown_snapshot().step >= simulation_->last_step();
}

void LivePhysics::start() {
  if (pace_ == Pace::kClock) simulation_->start(*clock_);
}

void LivePhysics::between_steps(const std::function<void(PhysicsSimulation&)>& act) {
  const bool running = simulation_->running();
  simulation_->stop();
  act(*simulation_);
  if (running) simulation_->start(*clock_);
}

Status LivePhysics::go_to(const SavedState& saved) {
  NERITIC_TRY(const auto sources, open_sources(inbox(), saved));
  between_steps([&](PhysicsSimulation& simulation) {
    restore_state(simulation, saved, sources);
    begin_history();
    start_step_ = simulation.newest().step;
    shown_s_ = simulation.newest().time_s;
    if (simulation.observer()) simulation.observer()(simulation.newest());
  });
  if (reader_) reader_->update();
  ++restored_;
  return {};
}

// Whether all sources could be polled, until now.
bool LivePhysics::poll(double time_s) {
  for (SampleSource* source : sources_)
    if (listening_.ok()) listening_ = source->poll(inbox(), time_s);
  return listening_.ok();
}

void LivePhysics::begin_history() {
  history_.clear();
  history_.add(motion_of(*world_, simulation_->newest()));
  trace(simulation_->newest());
}

void LivePhysics::trace(const sim::Snapshot<PhysicsState>& snapshot) {
  if (history_.trace_due(snapshot.time_s))
    history_.trace(motion_of(*world_, snapshot),
                   [&](const Vec3& place_m) { return world_->wash_m_s(snapshot.state, place_m); });
}

void LivePhysics::advance() {
  if (!poll(simulation_->newest().time_s)) return;
  simulation_->advance(1);
  trace(simulation_->newest());
}

void LivePhysics::reach(double time_s, const Stop& stop) {
  // Half of the history: the other half holds what was kept for the time before.
  const double kept_s = (MotionHistory::kKept / 2 - 1) * world_->step_s();
  while (simulation_->newest().time_s < time_s &&
         simulation_->newest().step < simulation_->last_step()) {
    advance();
    if (!listening_.ok()) return;
    const auto& newest = simulation_->newest();
    if (newest.time_s > time_s - kept_s) history_.add(motion_of(*world_, newest));
    if (stop && stop()) return;
  }
}

double LivePhysics::follow(TimeNs display_ns, double time_s, const Stop& stop) {
  if (pace_ == Pace::kPicture) {
    reach(time_s, stop);
    shown_s_ = time_s;
  } else {
    shown_s_ = std::max(shown_s_, follow_thread(display_ns));
  }
  return shown_s_;
}

// A step that runs on the thread just now shows what came too: it is waited for.
void LivePhysics::hasten_step() {
  constexpr TimeNs kLook_ns = 50'000;
  if (!simulation_->running() || clock_->stands() || simulation_->hasten(kMostStep_ns)) return;
  const std::uint64_t step = reader_->newest().step;
  const TimeNs step_ns = std::llround(1e9 * world_->step_s());
  const TimeNs late_ns = clock_->now() - reader_->newest().due_ns - step_ns;
  // One that is not due does not run; one that is late by more comes when it comes.
  if (late_ns < 0 || late_ns > step_ns) return;
  const TimeNs end_ns = now_ns() + kMostStep_ns;
  for (reader_->update(); reader_->newest().step == step && now_ns() < end_ns; reader_->update())
    host_.wait_until(now_ns() + kLook_ns);
}

double LivePhysics::follow_thread(TimeNs display_ns) {
  reader_->update();
  if (hastens_) hasten_step();
  reader_->update();
  const auto& newest = reader_->newest();
  (void)poll(newest.time_s);  // listening() tells of a failure
  if (newest.step == start_step_) return shown_s_;
  history_.add(motion_of(*world_, reader_->previous()));
  history_.add(motion_of(*world_, newest));
  trace(newest);
  // After the last step a display may lag behind by so much; one whose time stands would never
  // show the end.
  constexpr TimeNs kMostLag_ns = 1'000'000'000;
  if (ended() && clock_->now() - newest.due_ns > kMostLag_ns) return newest.time_s;
  return newest.time_s + 1e-9 * static_cast<double>(display_ns - newest.due_ns);
}

Pose LivePhysics::pose(std::size_t vehicle) const {
  return history_.at(world_->vehicles()[vehicle].object, shown_s_)->motion.pose;
}

}  // namespace neritic::testbed
