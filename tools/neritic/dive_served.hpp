// `dive --serve`: a dive with a display for programs, as `neritic serve` is without one.
#pragma once

#include "testbed/server/server.hpp"
#include "testbed/server/world_server.hpp"
#include "testbed/world/dive_link.hpp"

namespace neritic::tools {

// An address of TCP, beyond which this program's servers do not go.
Result<Address> tcp_address(const std::string& flag, const std::string& text);

// Where a server listens. flag: "--bind". keys: a folder; empty: none.
Result<testbed::ServerOptions> server_options(const std::string& flag, const std::string& address,
                                              const std::filesystem::path& keys,
                                              std::uint32_t clients);

// Joins the loop as a step sink and a source; the network has a thread of its own.
class ServedDive {
 public:
  // Borrows physics, scene and devices (null: none). Errors as Server::start.
  static Result<std::unique_ptr<ServedDive>> start(const testbed::ServerOptions& options,
                                                   testbed::LivePhysics& physics,
                                                   const scene::Scene& scene,
                                                   const testbed::Devices* devices);
  testbed::DiveLink& link() { return *link_; }
  // For the loop's sensors: the images that clients want.
  testbed::ImageConsumer* images() { return link_->world().images(); }
  // A line where programs missed readings, else none.
  std::string missed_words() const;
  Address address() const { return server_->address(); }

 private:
  explicit ServedDive(std::unique_ptr<testbed::DiveLink> link);

  std::unique_ptr<testbed::DiveLink> link_;
  testbed::HandOff hand_off_;
  std::unique_ptr<testbed::Server> server_;
  testbed::WorldServer served_;
};

}  // namespace neritic::tools
