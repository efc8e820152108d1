// A scene's physics beside what shows, hears and records it: on a thread of its own at a clock's
// pace, or in lock-step with the times asked for. Keeps the history that says where everything is.
// The thread that runs the loop owns this and calls all of it.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "testbed/motion/motion_history.hpp"
#include "testbed/samples/source.hpp"
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

class LivePhysics {
 public:
  enum class Pace { kClock, kPicture };
  struct Options {
    Pace pace = Pace::kPicture;
    unsigned threads = 0;             // of a step (PhysicsWorld::simulation)
    std::optional<SavedState> start;  // goes on from here; else from the scene's start
    sim::StepClock* clock = nullptr;  // paces the thread and outlives this; nullptr: the host's
  };
  // Errors as PhysicsWorld::create. Precondition: PhysicsWorld::needed(scene).
  static Result<std::unique_ptr<LivePhysics>> create(const scene::Scene& scene, Pace pace);
  // A saved state must fit the world (read_state).
  static std::unique_ptr<LivePhysics> create(std::unique_ptr<const PhysicsWorld> world,
                                             const Options& options);
  ~LivePhysics();

  // each sees every state in turn, the start first, and used each sample that the next step uses:
  // on the thread that steps, which is the caller's in lock-step and where follow() hastens steps.
  // Empty: nobody does from now on. Before start() or after stop().
  using Observer = std::function<void(const sim::Snapshot<PhysicsState>&)>;
  using Used = std::function<void(const Sample&)>;
  void observe(const Observer& each, const Used& used = {});
  // Polls the sources before each step of a lock-step, and in each follow() beside a thread. After
  // the first failure it polls no more, and a lock-step takes no more steps. Before start()
  // or after stop(); borrows them.
  void listen(std::vector<SampleSource*> sources) { sources_ = std::move(sources); }
  // The first failure of a source.
  const Status& listening() const { return listening_; }
  // Ends with the first step that lies so long after the start, at any pace: follow(), reach() and
  // advance() go no farther. Before start().
  void end_after(double seconds);
  // Whether the newest state that follow() found is that step's.
  bool ended() const;
  // The time of the state that it starts from is now.
  void start();
  // Calls act between two steps, with the thread at rest meanwhile: it may save, restore and change
  // who observes.
  void between_steps(const std::function<void(PhysicsSimulation&)>& act);
  // Goes on from a saved state of this world at once, also an earlier one or another run's; samples
  // that no step used yet are dropped. kBadInput, and the state stays, if the inbox has no room for
  // its sources. Lock-step: the loop's clock has to begin anew there.
  Status go_to(const SavedState& saved);
  std::uint64_t restored() const { return restored_; }  // how often it went so
  // Beside a thread: follow() takes the next step at once, up to a whole step before its time, so
  // that a picture shows all that came until it begins. It costs the picture that step; one that
  // takes longer than kMostStep_ns is left to the thread. Off by default.
  void hasten_steps(bool hasten) { hastens_ = hasten; }
  static constexpr TimeNs kMostStep_ns = 1'000'000;
  // After the last step; newest() and simulation() may be asked then, at any pace.
  void stop() { simulation_->stop(); }

  // Asked after each step of a lock-step; true ends it at once.
  using Stop = std::function<bool()>;
  // Takes what is known up to the time of a picture: in lock-step it steps to time_s and returns
  // it. Else it asks the thread what is new, ignores time_s and returns the scene time of the
  // picture, which stands still while the thread drops steps and never falls.
  double follow(TimeNs display_ns, double time_s, const Stop& stop = {});
  // Lock-step: steps until the state of time_s is known, and keeps the states of a short while
  // before it; what was kept for the last such time stays.
  void reach(double time_s, const Stop& stop = {});
  // Lock-step: one step. Of the history only its followed points go on.
  void advance();
  // Lock-step at the host's pace: from the next step on, when the scene's time was time_s.
  void keep_pace(double time_s, TimeNs host_ns) {
    simulation_->set_host_zero(host_ns - std::llround(time_s * 1e9));
  }
  // Where samples enter; any thread. They count from the next step on.
  SampleInbox& inbox() { return simulation_->inbox(); }

  Pace pace() const { return pace_; }
  const PhysicsWorld& world() const { return *world_; }
  const MotionHistory& motion() const { return history_; }
  // The newest state that follow() found, and a vehicle's pose at the time that it returned.
  const PhysicsState& shown() const { return shown_snapshot().state; }
  const sim::Snapshot<PhysicsState>& shown_snapshot() const {
    return reader_ ? reader_->newest() : simulation_->newest();
  }
  Pose pose(std::size_t vehicle) const;
  sim::StepPacer::Counts counts() const { return simulation_->pace(); }
  // Lock-step, or after stop().
  const sim::Snapshot<PhysicsState>& newest() const { return simulation_->newest(); }
  const PhysicsSimulation& simulation() const { return *simulation_; }

 private:
  LivePhysics(std::unique_ptr<const PhysicsWorld> world, const Options& options);
  double follow_thread(TimeNs display_ns);
  void hasten_step();
  bool poll(double time_s);
  void begin_history();
  void trace(const sim::Snapshot<PhysicsState>& snapshot);

  std::unique_ptr<const PhysicsWorld> world_;
  Pace pace_;
  sim::HostClock host_;
  sim::StepClock* clock_;  // that paces the thread
  bool hastens_ = false;
  std::unique_ptr<PhysicsSimulation> simulation_;
  std::optional<sim::SnapshotReader<PhysicsState>> reader_;  // of the thread's states
  MotionHistory history_;
  std::vector<SampleSource*> sources_;
  Status listening_;
  std::uint64_t start_step_ = 0, restored_ = 0;
  double shown_s_ = 0.0;
};

}  // namespace neritic::testbed
