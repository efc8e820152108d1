#include "testbed/samples/sample.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "engine/sim/fields.hpp"
#include "tests/testbed/samples/streams.hpp"

namespace neritic::testbed {
namespace {

TEST(Sample, EveryKindListsAllItsBytesAndHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (std::uint32_t i = 0; i < kPayloadKinds; ++i) {
    const auto kind = static_cast<PayloadKind>(i);
    const Payload payload = empty_payload(kind);
    EXPECT_EQ(payload.index(), i);
    std::visit([](const auto& value) { sim::check_fields_cover(value); }, payload);
    names.insert(name_of(kind));
    EXPECT_TRUE(all_finite(payload)) << name_of(kind);
  }
  EXPECT_EQ(names.size(), kPayloadKinds);
  sim::check_fields_cover(SampleHeader{});
}

TEST(Sample, OneNumberThatIsNotFiniteIsFoundAnywhere) {
  for (std::uint32_t i = 0; i < kPayloadKinds; ++i) {
    Payload payload = empty_payload(static_cast<PayloadKind>(i));
    std::visit(
        [](auto& value) {
          sim::for_each_scalar(value, [&](auto& scalar) {
            using Scalar = std::remove_reference_t<decltype(scalar)>;
            if constexpr (std::is_floating_point_v<Scalar>) {
              const Scalar before = scalar;
              scalar = std::numeric_limits<Scalar>::infinity();
              EXPECT_FALSE(all_finite(Payload(value)));
              scalar = before;
            }
          });
        },
        payload);
  }
}

TEST(StreamTable, EveryStreamIsFoundByNameAndByOwner) {
  StreamTable table = diver_and_rov();
  table.add_diver("buddy");
  for (StreamId id = 0; id < table.size(); ++id) {
    const Stream& stream = table[id];
    EXPECT_EQ(table.find(stream.name), id);
    EXPECT_EQ(table.id(stream.sort, stream.owner, stream.kind), id) << stream.name;
  }
  EXPECT_EQ(table[*table.find("buddy/joints")].owner, 1u);
  EXPECT_EQ(table[*table.find("rov/imu")].kind, PayloadKind::kImu);
  EXPECT_FALSE(table.find("rov/dvl"));  // a sensor that the vehicle lacks
  EXPECT_FALSE(table.find("nobody/joints"));
}

}  // namespace
}  // namespace neritic::testbed
