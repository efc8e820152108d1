#include "testbed/world/world.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/growing_file.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/ros_frames.hpp"
#include "engine/core/text.hpp"
#include "testbed/instruments/instrument_data.hpp"
#include "testbed/instruments/instrument_numbers.hpp"
#include "testbed/record/step_sink.hpp"
#include "testbed/sensors/validation.hpp"
#include "testbed/world/ros_samples.hpp"
#include "testbed/world/world_parts.hpp"

namespace neritic::testbed {
namespace {

std::vector<AgentInfo> agents_of(const PhysicsWorld& world) {
  std::vector<AgentInfo> out;
  for (const PhysicsVehicle& vehicle : world.vehicles()) {
    AgentInfo info{.name = vehicle.name,
                   .kind = "vehicle",
                   .takes_pwm = vehicle.file.curve.has_value(),
                   .has_mission = vehicle.mission.has_value()};
    for (std::size_t i = 0; i < vehicle.vehicle.thruster_count; ++i)
      info.thruster_n.push_back(rov::thruster_limits_n(vehicle.file, i));
    out.push_back(std::move(info));
  }
  for (const PhysicsHuman& human : world.humans())
    out.push_back({.name = human.name, .kind = "diver"});
  for (const PhysicsObject& object : world.objects())
    out.push_back({.name = object.name, .kind = "object"});
  const std::size_t first[] = {world.vehicles().size(), 0,
                               world.vehicles().size() + world.humans().size()};
  for (std::size_t i = 0; i < world.modems().all().size(); ++i) {
    const PhysicsModem& modem = world.modems().all()[i];
    out[first[static_cast<std::size_t>(modem.sort)] + modem.owner].modem = i + 1;
  }
  return out;
}

// 15 rotations, x y z w, as in samples of joints.
std::vector<double> joint_values(const diver::JointRotations& joints) {
  std::vector<double> values(ros::value_count(PayloadKind::kBodyJoints));
  ros::write_values(BodyJoints{joints}, values);
  values.resize(4 * joints.size());
  return values;
}

// The streams of samples with the ids of the table, then those of images.
std::vector<StreamInfo> streams_of(const PhysicsWorld& world, const scene::Scene& scene) {
  std::vector<StreamInfo> out;
  for (const Stream& stream : world.streams().streams()) {
    const std::string owner = stream.name.substr(0, stream.name.rfind('/'));
    StreamInfo info{
        .name = stream.name,
        .owner = owner,
        .kind = std::string(name_of(stream.kind)),
        .frame = ros::frame_of(stream.kind, owner),
        .sort = enters(stream.kind) ? StreamInfo::Sort::kInput : StreamInfo::Sort::kReading};
    for (ros::Field& field : ros::fields_of(stream.kind))
      info.fields.push_back({std::move(field.name), field.count});
    out.push_back(std::move(info));
  }
  for (const ImageStream& stream : image_streams(scene))
    out.push_back({.name = stream.name,
                   .owner = stream.frame_id,
                   .kind = type_of(stream.kind).name,
                   .frame = stream.frame_id,
                   .sort = StreamInfo::Sort::kImage,
                   .rate_hz = stream.rate_hz,
                   .encoding = type_of(stream.kind).encoding});
  return out;
}

}  // namespace

Error unknown_name(std::string_view where, std::string_view name,
                   const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string_view near = nearest(name, views);
  const std::string accepted = names.empty() ? "none: the scene has none" : join(views);
  return refusal(where, fmt::format("'{}'", printable(name)),
                 near.empty() || !is_slip(name, near)
                     ? accepted
                     : fmt::format("{} (nearest: {})", accepted, near));
}

World::World() = default;

World::~World() {
  if (!parts_) return;
  // A failure to write cannot be told any more: stop_recording() tells it.
  if (parts_->receiver && recording()) (void)stop_recording();
  if (parts_->loop) parts_->end_loop();
}

Result<std::unique_ptr<World>> World::open(const std::filesystem::path& path,
                                           const WorldOptions& options) {
  if (options.threads > sim::kMostThreads)
    return refusal("threads", fmt::format("{}", options.threads),
                   fmt::format("0 (by the scene's size) to {}", sim::kMostThreads));
  NERITIC_TRY(scene::Scene scene, scene::load_scene(path));
  if (options.seed) scene.seed = *options.seed;
  if (!PhysicsWorld::needed(scene))
    return refusal(path.string(), "a scene in which nothing moves by physics",
                   "a scene with [physics] and a vehicle, a diver or an object with inputs");
  NERITIC_TRY(auto physics, PhysicsWorld::create(scene));
  std::unique_ptr<World> world(new World);
  world->parts_ = std::make_unique<Parts>();
  Parts& parts = *world->parts_;
  parts.options = options;
  parts.path = path.string();
  parts.owned_physics = LivePhysics::create(
      std::move(physics), {.pace = LivePhysics::Pace::kPicture, .threads = options.threads});
  parts.physics = parts.owned_physics.get();
  parts.scene = std::move(scene);
  parts.agents = agents_of(parts.world());
  parts.streams = streams_of(parts.world(), parts.scene);
  parts.first_image = parts.world().streams().size();
  parts.receiver =
      std::make_unique<Receiver>(parts.world(), parts.scene.seed, parts.streams.size());
  // Devices send by the clock on the wall.
  if (options.real_time) {
    NERITIC_TRY(parts.owned_devices,
                Devices::open(parts.scene, parts.world(), parts.physics->inbox(),
                              DeviceSource::Pace::kThread));
    parts.devices = parts.owned_devices.get();
  }
  parts.begin_loop();
  return world;
}

Result<std::unique_ptr<World>> World::attach(LivePhysics& physics, const scene::Scene& scene,
                                             const std::string& path, const Devices* devices) {
  std::unique_ptr<World> world(new World);
  world->parts_ = std::make_unique<Parts>();
  Parts& parts = *world->parts_;
  parts.options.real_time = true;
  parts.path = path;
  parts.physics = &physics;
  parts.devices = devices;
  parts.scene.title = scene.title, parts.scene.seed = scene.seed;
  parts.motions = &scene;
  parts.agents = agents_of(parts.world());
  parts.streams = streams_of(parts.world(), scene);
  parts.first_image = parts.world().streams().size();
  parts.receiver = std::make_unique<Receiver>(parts.world(), scene.seed, parts.streams.size());
  parts.image_receiver = std::make_unique<ImageReceiver>(
      *parts.receiver, static_cast<std::uint32_t>(parts.first_image), false);
  NERITIC_TRY(parts.consumer, ImageConsumer::create(scene, {}, *parts.image_receiver));
  parts.find_holders();
  return world;
}

const std::string& World::title() const {
  return parts_->scene.title;
}
bool World::leaves_devices() const {
  return !parts_->options.real_time && !parts_->scene.sources.empty();
}
const std::string& World::path() const {
  return parts_->path;
}
std::uint64_t World::seed() const {
  return parts_->scene.seed;
}
double World::step_s() const {
  return parts_->world().step_s();
}
std::uint64_t World::step() const {
  return parts_->newest().step;
}
double World::time_s() const {
  return parts_->newest().time_s;
}
TimeNs World::time_ns() const {
  return std::llround(time_s() * 1e9);
}
std::uint64_t World::hash() const {
  return parts_->newest().hash;
}
const std::vector<AgentInfo>& World::agents() const {
  return parts_->agents;
}
const std::vector<StreamInfo>& World::streams() const {
  return parts_->streams;
}
std::vector<std::string> World::objects() const {
  return parts_->world().object_names();
}

Result<std::uint32_t> World::stream(const std::string& name) const {
  const auto found = std::ranges::find(parts_->streams, name, &StreamInfo::name);
  if (found != parts_->streams.end())
    return static_cast<std::uint32_t>(found - parts_->streams.begin());
  std::vector<std::string> names;
  for (const StreamInfo& stream : parts_->streams) names.push_back(stream.name);
  return unknown_name("stream", name, names);
}

Result<std::size_t> World::agent(const std::string& name) const {
  const auto found = std::ranges::find(parts_->agents, name, &AgentInfo::name);
  if (found != parts_->agents.end())
    return static_cast<std::size_t>(found - parts_->agents.begin());
  std::vector<std::string> names;
  for (const AgentInfo& agent : parts_->agents) names.push_back(agent.name);
  return unknown_name("agent", name, names);
}

void World::receive(std::span<const Sample> outputs, std::uint64_t missed) {
  Parts& parts = *parts_;
  parts.receiver->dropped += missed;
  if (parts.restored != parts.physics->restored()) {
    // By the display's keys: all that is on its way belongs to another time.
    parts.restored = parts.physics->restored();
    parts.receiver->forget();
    parts.find_holders();
    parts.messages.clear();
  } else {
    parts.receiver->receive(outputs);
  }
  parts.receiver->deliver(time_ns());
}

Result<Instruments> World::instruments(const std::string& name) const {
  const auto& humans = parts_->world().humans();
  const auto found = std::ranges::find(humans, name, &PhysicsHuman::name);
  if (found == humans.end()) {
    std::vector<std::string> names;
    for (const PhysicsHuman& human : humans) names.push_back(human.name);
    return unknown_name("diver", name, names);
  }
  const auto diver = static_cast<std::size_t>(found - humans.begin());
  const auto& newest = parts_->newest();
  const hud::DiveData data = instrument_data(parts_->world(), diver, newest);
  Instruments out{.time_s = newest.time_s,
                  .numbers = numbers_of(data),
                  .streams = {},
                  .message = std::string(data.message.view()),
                  .message_from = std::string(data.message_from.view())};
  for (const hud::StreamHealth& stream :
       stream_health(newest.state.humans()[diver], parts_->physics->inbox().source_names()))
    out.streams.push_back({std::string(stream.name.view()), std::string(stream.note.view()),
                           stream.health == hud::Health::kGood      ? "good"
                           : stream.health == hud::Health::kWaiting ? "waiting"
                                                                    : "lost"});
  return out;
}

Status World::tick(std::uint64_t steps, const std::function<bool()>& stop) {
  Parts& parts = *parts_;
  NERITIC_CHECK(parts.loop, "an attached world goes on by itself");
  for (std::uint64_t i = 0; i < steps; ++i) {
    NERITIC_TRY_STATUS(parts.loop->turn());
    if (parts.loop->stopped()) return parts.loop->end({});
    if (stop && stop()) break;
  }
  parts.receiver->deliver(time_ns());
  return parts.device ? check_validation(*parts.device) : Status();
}

std::span<const Reading> World::newest() const {
  return parts_->receiver->newest;
}

Status World::keep(std::uint32_t stream, bool on) {
  NERITIC_CHECK(stream < parts_->streams.size(), "stream {}", stream);
  if (parts_->streams[stream].sort == StreamInfo::Sort::kInput)
    return refusal(parts_->streams[stream].name, "a stream of inputs", "one of readings or images");
  parts_->receiver->kept[stream] = on ? 1 : 0;
  return {};
}

std::vector<Reading> World::take_arrived() {
  auto& arrived = parts_->receiver->arrived;
  std::vector<Reading> out(arrived.begin(), arrived.end());
  arrived.clear();
  return out;
}

std::size_t World::arrived() const {
  return parts_->receiver->arrived.size();
}

std::uint64_t World::dropped() const {
  return parts_->receiver->dropped;
}

Status World::set_link(std::uint32_t stream, const LinkOptions& link) {
  NERITIC_CHECK(stream < parts_->streams.size(), "stream {}", stream);
  const std::string& name = parts_->streams[stream].name;
  constexpr double kMost_s = 3600.0;
  for (const auto& [word, value] :
       {std::pair("delay_s", link.delay_s), {"jitter_s", link.jitter_s}})
    if (!(value >= 0.0 && value <= kMost_s))
      return refusal(name + ": " + word, fmt::format("{}", value), "0 to 3600 s");
  if (parts_->streams[stream].sort == StreamInfo::Sort::kInput)
    return refusal("link: " + name, "a stream of inputs, whose commands act with the next step",
                   "one of readings or images");
  if (!(link.loss >= 0.0 && link.loss <= 1.0))
    return refusal(name + ": loss", fmt::format("{}", link.loss), "a share from 0 to 1");
  parts_->receiver->links[stream] = link;
  return {};
}

Result<Truth> World::truth(const std::string& name) const {
  NERITIC_TRY(const std::size_t index, agent(name));
  const PhysicsWorld& world = parts_->world();
  const PhysicsState& state = parts_->newest().state;
  const std::size_t vehicles = world.vehicles().size(), humans = world.humans().size();
  const auto three = [](const Vec3& v) { return std::array<double, 3>{v.x, v.y, v.z}; };
  Truth out;
  const auto set = [&](const Vec3& position_ned_m, const Quat& attitude, const Vec6& velocity,
                       const ContactState& contact) {
    out.position = three(ros::enu_from_ned(position_ned_m));
    out.orientation = ros::xyzw(ros::enu_from_ned(attitude));
    out.linear_velocity = three(ros::flu_from_marine(velocity.linear()));
    out.angular_velocity = three(ros::flu_from_marine(velocity.angular()));
    out.current = three(
        ros::enu_from_ned(world.water_ned(position_ned_m, parts_->newest().time_s).current_m_s));
    out.touched_steps = contact.touched_steps;
  };
  if (index < vehicles) {
    const VehicleState& vehicle = state.vehicles()[index];
    set(vehicle.body.position_ned_m, vehicle.body.attitude, vehicle.body.velocity, vehicle.contact);
    out.thruster_n.assign(
        vehicle.command_n.begin(),
        vehicle.command_n.begin() +
            static_cast<std::ptrdiff_t>(world.vehicles()[index].vehicle.thruster_count));
  } else if (index < vehicles + humans) {
    const HumanPhysics& human = state.humans()[index - vehicles];
    set(human.human.root.position_ned_m, human.human.root.attitude, human.human.root.velocity,
        human.contact);
    out.joints = joint_values(human.human.limbs.rotation);
  } else {
    const ObjectState& object = state.objects()[index - vehicles - humans];
    if (const auto limbs = world.objects()[index - vehicles - humans].limbs;
        limbs && state.limbs()[*limbs].shown != 0)
      out.joints = joint_values(state.limbs()[*limbs].joints);
    // Until a sample places it, it is where its own track has it.
    const scene::Mount mount{
        .object = static_cast<int>(world.objects()[index - vehicles - humans].object)};
    const Motion motion = object.placed != 0
                              ? object.motion
                              : scene::MotionSource(*parts_->motions).at(mount, time_s()).motion;
    out.position = three(ros::enu_from_world(motion.pose.position_m));
    out.orientation = ros::xyzw(ros::enu_from_body(motion.pose.rotation));
    const Quat to_body = glm::conjugate(motion.pose.rotation);
    const auto flu = [&](const Vec3& v) {
      return three(ros::flu_from_marine(ned_from_world(to_body * v)));
    };
    out.linear_velocity = flu(motion.velocity_m_s);
    out.angular_velocity = flu(motion.angular_velocity_rad_s);
  }
  return out;
}

std::vector<std::byte> World::save() const {
  const StateFormat format = parts_->world().state_format();
  if (parts_->owned_physics)
    return encode_state(format, saved_state(parts_->physics->simulation(), format));
  std::optional<SavedState> saved;
  parts_->physics->between_steps(
      [&](PhysicsSimulation& simulation) { saved = saved_state(simulation, format); });
  return encode_state(format, *saved);
}

Status World::restore(std::span<const std::byte> bytes) {
  Parts& parts = *parts_;
  if (!parts.owned_physics)
    return refusal("restore", "a dive with a display", "its own keys, or `neritic serve`");
  if (recording())
    return refusal("restore", "a recording that runs", "the recording's end before it");
  NERITIC_TRY(const SavedState saved,
              parse_state(parts.world().state_format(), bytes, "the saved state"));
  parts.end_loop();
  const Status status = parts.physics->go_to(saved);
  if (status.ok()) {
    // The readings of the saved step came before it was saved.
    parts.receiver->forget(saved.step);
    // Devices begin anew: their next sample may be captured before their last one was.
    for (const auto& [name, id] : parts.sources)
      NERITIC_CHECK(parts.physics->inbox().open(name).ok(), "{}", name);
    parts.sequences.clear();
    parts.find_holders();
    parts.messages.clear();
    const auto modems = parts.world().modems().all();
    for (std::size_t i = 0; i < modems.size(); ++i)
      parts.messages[parts.world().streams().id(
          modems[i].sort, modems[i].owner, PayloadKind::kSend)] = saved.inputs.modems()[i].queue;
  }
  parts.begin_loop();
  return status;
}

Status World::record(const std::filesystem::path& path) {
  if (!parts_->owned_physics)
    return refusal("record", "a dive with a display", "its own keys or flags, or `neritic serve`");
  RecordingSwitch& recording = parts_->receiver->recording;
  if (recording.on())
    return refusal("record", "a recording that runs, " + recording.file().string(),
                   "that recording's end before it");
  NERITIC_TRY(RecordingOptions options, recording_of_scene(parts_->path));
  if (parts_->owned_devices) options.signals = parts_->owned_devices->signals();
  std::filesystem::path base = path;
  if (base.extension() == ".mcap") base.replace_extension();
  for (const char* ending : {".mcap", ".csv"})
    if (auto file = base; being_written(file += ending))
      return refusal("record", file.string() + ", which another program writes", "another name");
  recording.begin(parts_->physics->simulation(), base, std::move(options));
  return {};
}

Status World::stop_recording() {
  RecordingSwitch& recording = parts_->receiver->recording;
  if (!recording.on()) return refusal("stop_recording", "no recording", "record() before it");
  return recording.end()->finish();
}

bool World::recording() const {
  return parts_->receiver->recording.on();
}

void World::Parts::begin_loop() {
  const std::uint64_t step = newest().step;
  const double step_s = world().step_s();
  LoopParts made{.clock = options.real_time ? Clock::real(newest().time_s, step_s)
                                            : Clock::steps(step + 1, step_s),
                 .physics = physics,
                 .step_sinks = {receiver.get()}};
  if (consumer) {
    made.sensors = LoopSensors{.session = session.get(), .consumers = {&*consumer}};
    made.pictures = displays.get();
  }
  loop.emplace(std::move(made));
  loop->begin();
}

// Those of the state: a command that acts in it can be released or followed by another one, whoever
// gave it. A dive's own keys give back what they took.
void World::Parts::find_holders() {
  holders.clear();
  const auto names = physics->inbox().source_names();
  const auto find = [&](OwnerSort sort, std::size_t owner, const auto& now, const auto& chosen,
                        const auto& hold_s) {
    for (std::uint64_t group = 0; group < now.size(); ++group) {
      const SourceId source = static_cast<SourceId>(now[group].source);
      if (now[group].authority != Authority::kLive) continue;
      if (chosen[group].authority == Authority::kLive && chosen[group].source == source) continue;
      if (attached() && source < names.size() && names[source] == kKeyboard) continue;
      const StreamId events =
          world().streams().id(sort, static_cast<std::uint32_t>(owner), PayloadKind::kEvent);
      holders[{events, group}] = {source, hold_s(group)};
    }
  };
  const PhysicsInputs& start = world().start_inputs();
  const auto find_all = [&](const auto& vehicles, const auto& humans, const auto& objects,
                            const auto& groups_of, const auto& hold_of) {
    const auto find_each = [&](OwnerSort sort, const auto& all, const auto& chosen) {
      for (std::size_t i = 0; i < all.size(); ++i)
        find(sort, i, groups_of(all[i]), chosen[i].control,
             [&](std::uint64_t group) { return hold_of(all[i], group); });
    };
    find_each(OwnerSort::kVehicle, vehicles, start.vehicles());
    find_each(OwnerSort::kDiver, humans, start.humans());
    find_each(OwnerSort::kObject, objects, start.objects());
  };
  if (attached()) {
    // The thread that steps owns the inputs. Its state does not say for how long a source holds:
    // the next command of the same source says it anew.
    const PhysicsState& state = newest().state;
    find_all(
        state.vehicles(), state.humans(), state.objects(),
        [](const auto& one) -> const auto& { return one.groups; },
        [](const auto&, std::uint64_t) { return -1.0; });
    return;
  }
  const PhysicsInputs& inputs = physics->simulation().inputs();
  find_all(
      inputs.vehicles(), inputs.humans(), inputs.objects(),
      [](const auto& one) -> const auto& { return one.control; },
      [](const auto& one, std::uint64_t group) { return one.control[group].hold_s; });
}

void World::Parts::end_loop() {
  (void)loop->end({});  // its sinks have nothing to finish
  loop.reset();
}

}  // namespace neritic::testbed
