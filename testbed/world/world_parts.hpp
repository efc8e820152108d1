// The inside of a World: the parts that its loop turns. Private to testbed/world.
#pragma once

#include <deque>
#include <map>

#include "engine/gpu/device.hpp"
#include "testbed/devices/devices.hpp"
#include "testbed/instruments/wrist_displays.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/record/recording_switch.hpp"
#include "testbed/world/world.hpp"

namespace neritic::testbed {

// Takes what leaves the simulation, lets it arrive in its time, and feeds the recording.
class Receiver final : public StepSink {
 public:
  // Borrows the world.
  Receiver(const PhysicsWorld& world, std::uint64_t seed, std::size_t streams);

  std::vector<StreamId> streams() const override { return outputs_; }
  Status use(const Sample& sample) override { return recording.use(sample); }
  Status accept(const sim::Snapshot<PhysicsState>& step, std::span<const Sample> outputs) override;
  // shift_ns: to be added to their times for the scene's.
  void receive(std::span<const Sample> outputs, TimeNs shift_ns = 0);
  // A loop's end is not the recording's: a world has one loop after another.
  Status finish() override { return {}; }

  // take: between two ticks; deliver: at the end of each step and of a tick.
  void take(WorldImage image);
  void deliver(TimeNs now_ns);
  // What arrived or is on its way. seen: the step whose readings do not come again.
  void forget(std::optional<std::uint64_t> seen = {});

  RecordingSwitch recording;
  std::vector<LinkOptions> links;  // by stream; images after the others
  std::vector<Reading> newest;     // by stream of the table, by the time of measurement
  std::vector<char> kept;          // by stream
  std::deque<Reading> arrived;
  std::deque<std::unique_ptr<WorldImage>> images;
  std::uint64_t dropped = 0;

 private:
  void arrive(const Reading& reading);
  void arrive(std::unique_ptr<WorldImage> image);

  std::vector<StreamId> outputs_;
  std::uint64_t seed_ = 0;
  std::optional<std::uint64_t> last_step_;
  std::vector<std::optional<TimeNs>> newest_image_ns_;  // by stream: that arrived
  OnTheWay<Reading> readings_;
  OnTheWay<std::unique_ptr<WorldImage>> images_;
};

// The images that someone wants, as a World gives them. alone: nobody else of its loop wants any,
// so that it takes their pixels without a copy.
class ImageReceiver final : public ImageSink {
 public:
  ImageReceiver(Receiver& receiver, std::uint32_t first, bool alone)
      : receiver_(receiver), first_(first), alone_(alone) {}
  bool takes() const override { return alone_; }
  Status accept(const ImageSample& image) override;
  Status take(const ImageSample& image, ImagePixels pixels) override;

 private:
  Receiver& receiver_;
  std::uint32_t first_ = 0;  // stream of images
  bool alone_ = true;
};

// A command before it is known to make sense: where it is refused, its numbers, who gives it.
struct GivenCommand {
  std::string where;
  std::span<const double> values;
  const std::string& from;
};
// A command's numbers as those of a payload's fields, and the kind of that.
struct WantedPayload {
  PayloadKind kind = PayloadKind::kEvent;
  std::vector<double> values;
};
// An agent as the owner of streams.
struct AgentOwner {
  OwnerSort sort = OwnerSort::kVehicle;
  std::uint32_t number = 0;
};

struct World::Parts {
  WorldOptions options;
  std::string path;
  scene::Scene scene;
  const scene::Scene* motions = &scene;  // whose tracks move objects; another one's if attached
  std::unique_ptr<LivePhysics> owned_physics;  // absent: attached
  LivePhysics* physics = nullptr;
  std::uint64_t restored = 0;  // of an attached physics, as it was last seen
  std::vector<AgentInfo> agents;
  std::vector<StreamInfo> streams;
  std::size_t first_image = 0;  // into streams
  std::unique_ptr<Receiver> receiver;
  std::unique_ptr<Devices> owned_devices;  // of the scene, in real time; threads of their own
  const Devices* devices = nullptr;        // absent: none, or in lock-step
  // Images. In the order of creation: each uses those before it.
  std::unique_ptr<gpu::Device> device;
  std::unique_ptr<WristDisplays> displays;
  std::unique_ptr<Session> session;
  std::unique_ptr<ImageReceiver> image_receiver;
  std::map<std::uint32_t, double> wished;  // rates by stream
  std::optional<ImageConsumer> consumer;
  std::optional<Loop> loop;
  // For commands: the source of a name, the next sequence by source and stream, and who has the
  // authority over a group by a command, of this world or in the state that it goes on from.
  struct Holder {
    SourceId source = 0;
    double hold_s = 0.0;
  };
  std::map<std::string, SourceId> sources;
  std::map<std::pair<SourceId, StreamId>, std::uint64_t> sequences;
  std::map<std::pair<StreamId, std::uint64_t>, Holder> holders;  // by event stream and group
  std::map<StreamId, ModemQueue> messages;                       // that wait for a modem

  bool attached() const { return !owned_physics; }
  const PhysicsWorld& world() const { return physics->world(); }
  const sim::Snapshot<PhysicsState>& newest() const { return physics->shown_snapshot(); }
  void begin_loop();
  void end_loop();
  void find_holders();
  Status make_session();
  Status renew_consumer();
  Result<SourceId> source(const std::string& name);
  Status push(SourceId source, StreamId stream, const Payload& payload, TimeNs captured_ns);
  AgentOwner owner_of(std::size_t agent) const;
  TimeNs now_ns() const;  // simulated
  Status push_alone(const AgentOwner& owner, const Payload& payload, const std::string& from);
  Status send(std::size_t agent, const GivenCommand& command);
  Status grip(std::size_t agent, const GivenCommand& command);
  Status regulator(std::size_t agent, const GivenCommand& command);
  Result<WantedPayload> wanted(const AgentOwner& owner, const std::string& kind,
                               const GivenCommand& command) const;
  // With the authority over its group, which it takes.
  Status steer(std::size_t agent, const std::string& kind, const GivenCommand& command,
               double hold_s);
  Status hand_over(StreamId events, std::uint64_t group, Authority authority, SourceId source,
                   double hold_s);
};

// kBadInput: where, the name that was found and the nearest that there is.
Error unknown_name(std::string_view where, std::string_view name,
                   const std::vector<std::string>& names);

}  // namespace neritic::testbed
