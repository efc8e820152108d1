#include "tools/neritic/dive_served.hpp"

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/core/version.hpp"

namespace neritic::tools {
using namespace testbed;

Result<Address> tcp_address(const std::string& flag, const std::string& text) {
  auto parsed = parse_address(text);
  if (!parsed.ok() || parsed->transport != Transport::kTcp)
    return refusal(flag, fmt::format("'{}'", printable(text)), "tcp://ADDRESS:PORT");
  return std::move(parsed).value();
}

Result<ServerOptions> server_options(const std::string& flag, const std::string& address,
                                     const std::filesystem::path& keys, std::uint32_t clients) {
  ServerOptions options;
  NERITIC_TRY(options.socket.address, tcp_address(flag, address));
  options.socket.clients = clients;
  options.socket.guard.connections = clients + 96;
  if (!keys.empty()) {
    NERITIC_TRY(options.socket.keys, net::read_server_keys(keys));
  }
  return options;
}

std::string ServedDive::missed_words() const {
  const std::uint64_t dropped = link_->world().dropped();
  if (dropped == 0) return {};
  return fmt::format(
      "--serve: {} readings dropped, which came faster than frames or programs took "
      "them",
      dropped);
}

ServedDive::ServedDive(std::unique_ptr<DiveLink> link)
    : link_(std::move(link)), served_(link_->world(), hand_off_, {.real_time = true}) {
  link_->each_turn([this] { served_.turn(); });
}

Result<std::unique_ptr<ServedDive>> ServedDive::start(const ServerOptions& options,
                                                      LivePhysics& physics,
                                                      const scene::Scene& scene,
                                                      const Devices* devices) {
  NERITIC_TRY(auto link, DiveLink::create(physics, scene, scene.path, devices));
  std::unique_ptr<ServedDive> dive(new ServedDive(std::move(link)));
  NERITIC_TRY(dive->server_,
              Server::start(facts_of(dive->link_->world(), true, std::string(program_version())),
                            dive->hand_off_, options));
  return dive;
}

}  // namespace neritic::tools
