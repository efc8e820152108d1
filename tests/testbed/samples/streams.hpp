// Streams and samples that several tests use.
#pragma once

#include <gtest/gtest.h>

#include "testbed/samples/inbox.hpp"

namespace neritic::testbed {

// A diver, a vehicle with an inertial unit and an object that devices move.
inline StreamTable diver_and_rov() {
  StreamTable table;
  table.add_diver("diver");
  rov::SensorSet sensors;
  sensors.imu.emplace();
  table.add_vehicle("rov", sensors);
  table.add_object("prop");
  return table;
}

inline Sample sample_of(const StreamTable& table, const std::string& stream, SourceId source,
                        std::uint64_t sequence, const Payload& payload, TimeNs now_ns = 0) {
  return {{table.find(stream).value(), source, sequence, now_ns, now_ns}, payload};
}

}  // namespace neritic::testbed
