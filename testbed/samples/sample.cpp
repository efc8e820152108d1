#include "testbed/samples/sample.hpp"

#include <array>
#include <utility>

#include "engine/sim/fields.hpp"

namespace neritic::testbed {
namespace {

constexpr std::array<std::string_view, kPayloadKinds> kKindNames{
    "joints",  "hands",     "hand_poses", "head",      "gaze",   "buttons", "breath", "heart",
    "gas",     "wrench",    "setpoint",   "fault",     "event",  "imu",     "dvl",    "pressure",
    "compass", "altimeter", "usbl",       "collision", "motion", "computer"};

template <std::size_t... index>
Payload make_payload(std::size_t kind, std::index_sequence<index...>) {
  Payload payload;
  ((kind == index ? void(payload.emplace<index>()) : void()), ...);
  return payload;
}

}  // namespace

std::string_view name_of(PayloadKind kind) {
  return kKindNames.at(static_cast<std::size_t>(kind));
}

Payload empty_payload(PayloadKind kind) {
  NERITIC_CHECK(static_cast<std::size_t>(kind) < kPayloadKinds, "kind {}",
                static_cast<std::uint32_t>(kind));
  return make_payload(static_cast<std::size_t>(kind), std::make_index_sequence<kPayloadKinds>{});
}

bool all_finite(const Payload& payload) {
  return std::visit([](const auto& value) { return sim::all_finite(value); }, payload);
}

}  // namespace neritic::testbed
