// `neritic serve SCENE`: a scene for clients on this machine or, with keys, on others. `neritic
// keys`: the keys.
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/version.hpp"
#include "testbed/server/server.hpp"
#include "testbed/server/world_server.hpp"
#include "tools/neritic/commands.hpp"
#include "tools/neritic/dive_served.hpp"
#include "tools/neritic/interrupt.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

Result<ServerOptions> options_of(const ServeFlags& flags) {
  NERITIC_TRY(ServerOptions options,
              server_options("--bind", flags.bind, flags.keys, flags.clients));
  options.shared_memory = !flags.no_shared_memory;
  return options;
}

void tell(const Server::Counts& counts, const World& world, std::uint64_t first_step) {
  fmt::print(
      "{} steps to {:.3f} s, hash {:016x}; {} requests, {} refused; lost: {} messages, {} "
      "readings; "
      "strangers: {} unknown keys, {} failed handshakes, {} crowded out\n",
      world.step() - first_step, world.time_s(), world.hash(), counts.requests, counts.refused,
      counts.socket.lost, world.dropped(), counts.socket.not_known, counts.socket.no_greeting,
      counts.socket.connections.crowded_out);
}

}  // namespace

Status run_serve(const ServeFlags& flags) {
  const Interrupt interrupt;
  NERITIC_TRY(const ServerOptions options, options_of(flags));
  std::error_code error;
  if (!flags.recordings.empty() && !std::filesystem::is_directory(flags.recordings, error))
    return refusal("--recordings", fmt::format("{}, no folder", flags.recordings.string()),
                   "a folder that there is");
  NERITIC_TRY(const auto world, World::open(flags.scene, {.seed = flags.seed,
                                                          .real_time = flags.real_time,
                                                          .device = flags.device,
                                                          .validation = flags.validation}));
  const std::uint64_t first_step = world->step();
  if (world->leaves_devices())
    log_warn("{}: its devices send in real time; only --realtime listens to them", flags.scene);
  HandOff hand_off;
  NERITIC_TRY(const auto server,
              Server::start(facts_of(*world, flags.real_time, std::string(program_version())),
                            hand_off, options));
  // After all that may refuse: an older file of that name is moved away. No client is answered yet.
  if (!flags.record.empty()) NERITIC_TRY_STATUS(world->record(flags.record));
  if (!flags.quiet) {
    fmt::print("{} at {}, {}, {}\n", world->title().empty() ? flags.scene : world->title(),
               to_text(server->address()),
               flags.real_time ? "in real time" : "in lock-step with the first client that ticks",
               flags.keys.empty() ? "for this machine alone" : "for clients with a key");
    std::fflush(stdout);  // programs wait for this line
  }
  WorldServer served(
      *world, hand_off,
      {.real_time = flags.real_time,
       .recordings = flags.recordings,
       .last_step = flags.seconds ? first_step + static_cast<std::uint64_t>(
                                                     *flags.seconds / world->step_s() + 0.5)
                                  : 0});
  const Status status = served.run([&] { return interrupt.requested(); });
  if (!flags.quiet) tell(server->counts(), *world, first_step);
  const Status recorded = world->recording() ? world->stop_recording() : Status();
  return status.ok() ? recorded : status;
}

Result<std::string> run_keys(const KeysFlags& flags) {
  NERITIC_TRY_STATUS(net::make_keys(flags.folder, flags.client));
  if (flags.client.empty()) return fmt::format("{}: the server's keys", flags.folder.string());
  return fmt::format("{0}/{1}.secret and {0}/server.public: for {1}'s machine",
                     flags.folder.string(), flags.client);
}

}  // namespace neritic::tools
