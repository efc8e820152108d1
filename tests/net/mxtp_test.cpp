#include "engine/net/mxtp.hpp"

#include <bit>

#include "engine/net/mxtp_frames.hpp"
#include "tests/net/vectors.hpp"

namespace neritic::net {
namespace {

using nlohmann::json;

json vector_named(const std::string& name) {
  for (const json all = wire_vectors(); const json& vector : all["xsens_mvn"]["vectors"])
    if (vector["name"] == name) return vector;
  ADD_FAILURE() << name;
  return {};
}
json malformed(const std::string& name) {
  for (const json all = wire_vectors(); const json& vector : all["xsens_mvn"]["malformed"])
    if (vector["name"] == name) return vector;
  ADD_FAILURE() << name;
  return {};
}
MxtpDatagram decoded(const json& vector) {
  const auto datagram = decode_mxtp(bytes_of(vector));
  EXPECT_TRUE(datagram.ok()) << vector["name"] << ": " << datagram.error().message;
  return datagram.ok() ? *datagram : MxtpDatagram();
}
template <class Item>
std::vector<Item> items_of(const std::string& name) {
  return std::get<std::vector<Item>>(decoded(vector_named(name)).items);
}
Float3 float3(const json& list) {
  return {list[0].get<float>(), list[1].get<float>(), list[2].get<float>()};
}

TEST(Mxtp, EveryVectorHasTheHeaderThatItsFactsSay) {
  for (const json all = wire_vectors(); const json& vector : all["xsens_mvn"]["vectors"]) {
    EXPECT_EQ(bytes_of(vector).size(), vector["bytes"].get<std::size_t>());
    const MxtpDatagram datagram = decoded(vector);
    EXPECT_EQ(datagram.refused_items, 0u) << vector["name"];
    if (!vector["expected"].contains("header")) continue;
    const json& says = vector["expected"]["header"];
    const MxtpHeader& header = datagram.header;
    EXPECT_EQ(fmt::format("MXTP{:02}", header.type), says["magic"]);
    EXPECT_EQ(header.sample, says["sample"]);
    EXPECT_EQ(header.datagram, says["datagram"]);
    EXPECT_EQ(header.last, says["last"]);
    EXPECT_EQ(header.items, says["items"]);
    EXPECT_EQ(header.time_ms, says["time_ms"]);
    EXPECT_EQ(header.character, says["character"]);
    EXPECT_EQ(header.body_segments, says["body_segments"]);
    EXPECT_EQ(header.props, says["props"]);
    EXPECT_EQ(header.finger_segments, says["finger_segments"]);
    EXPECT_EQ(header.payload, says["payload"]);
  }
}

TEST(Mxtp, PosesHaveTheirVectorsValues) {
  const std::string name = "MXTP02 split part 0 (not last)";
  const auto poses = items_of<MxtpPose>(name);
  const json says = vector_named(name)["expected"]["items"];
  ASSERT_EQ(poses.size(), says.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].id, says[i]["id"]);
    EXPECT_EQ(poses[i].position_m, float3(says[i]["pos"]));
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(poses[i].rotation[k], says[i]["quat_wxyz"][k].get<float>(), 1e-7);
  }
}

TEST(Mxtp, OtherTypesHaveTheirVectorsValues) {
  const auto joints = items_of<MxtpJoint>("MXTP20 joint angles");
  const json says = vector_named("MXTP20 joint angles")["expected"]["items"];
  ASSERT_EQ(joints.size(), says.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    EXPECT_EQ(joints[i].parent_segment, says[i]["parent_segment"]);
    EXPECT_EQ(joints[i].parent_point, says[i]["parent_point"]);
    EXPECT_EQ(joints[i].child_segment, says[i]["child_segment"]);
    EXPECT_EQ(joints[i].child_point, says[i]["child_point"]);
    EXPECT_EQ(joints[i].angles_deg, float3(says[i]["angles_deg"]));
  }
  const auto linear = items_of<MxtpLinear>("MXTP21 linear kinematics");
  ASSERT_EQ(linear.size(), 2u);
  EXPECT_EQ(linear[0].position_m, (Float3{0.1F, 0.11F, 0.12F}));
  EXPECT_EQ(linear[0].velocity_m_s, (Float3{0.13F, 0.14F, 0.15F}));
  EXPECT_EQ(linear[0].acceleration_m_s2, (Float3{0.16F, 0.17F, 0.18F}));
  const auto angular = items_of<MxtpAngular>("MXTP22 angular kinematics");
  ASSERT_EQ(angular.size(), 1u);
  EXPECT_EQ(angular[0].velocity_rad_s, (Float3{0.5F, 0, 0}));
  const auto tracker = items_of<MxtpTracker>("MXTP23 tracker kinematics, rev N layout");
  ASSERT_EQ(tracker.size(), 1u);
  EXPECT_FALSE(tracker[0].whole);
  EXPECT_EQ(tracker[0].magnetic_field, (Float3{0.1F, 0.2F, 0.3F}));
  const auto all = items_of<MxtpTracker>("MXTP23 tracker kinematics, SDK layout");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].whole);
  EXPECT_EQ(all[0].acceleration_m_s2, (Float3{0, 0, 9.81F}));
  EXPECT_EQ(all[0].turn_rate_rad_s, (Float3{0.1F, 0.2F, 0.3F}));
  EXPECT_EQ(all[0].magnetic_field, (Float3{0.4F, 0.5F, 0.6F}));
  const auto centre = items_of<MxtpMassCentre>("MXTP24 centre of mass");
  ASSERT_EQ(centre.size(), 1u);
  EXPECT_EQ(centre[0].position_m, (Float3{0.1F, 0.2F, 0.95F}));
  for (const char* name :
       {"MXTP25 time code, spec form", "MXTP25 time code, SDK form (length prefixed)"})
    EXPECT_EQ(std::get<MxtpTimeCode>(decoded(vector_named(name)).items).text, "16:00:31.123");
}

// The bits of an item's numbers in the order of the wire.
using Words = std::vector<std::uint32_t>;
void add(Words& words, std::uint32_t number) {
  words.push_back(number);
}
template <std::size_t N>
void add(Words& words, const std::array<float, N>& numbers) {
  for (const float number : numbers) words.push_back(std::bit_cast<std::uint32_t>(number));
}
void add(Words& words, const MxtpEuler& item) {
  add(words, item.id), add(words, item.position_cm), add(words, item.angles_deg);
}
void add(Words& words, const MxtpPose& item) {
  add(words, item.id), add(words, item.position_m), add(words, item.rotation);
}
void add(Words& words, const MxtpJoint& item) {
  add(words, item.parent_segment << 8 | item.parent_point);
  add(words, item.child_segment << 8 | item.child_point);
  add(words, item.angles_deg);
}
void add(Words& words, const MxtpLinear& item) {
  add(words, item.id), add(words, item.position_m);
  add(words, item.velocity_m_s), add(words, item.acceleration_m_s2);
}
void add(Words& words, const MxtpAngular& item) {
  add(words, item.id), add(words, item.rotation);
  add(words, item.velocity_rad_s), add(words, item.acceleration_rad_s2);
}
void add(Words& words, const MxtpTracker& item) {
  add(words, item.id), add(words, item.rotation), add(words, item.free_acceleration_m_s2);
  if (item.whole) add(words, item.acceleration_m_s2), add(words, item.turn_rate_rad_s);
  add(words, item.magnetic_field);
}
void add(Words& words, const MxtpMassCentre& item) {
  add(words, item.position_m);
  if (item.moving) add(words, item.velocity_m_s), add(words, item.acceleration_m_s2);
}
template <class Item>
Words words_of(const std::vector<Item>& items) {
  Words words;
  for (const Item& item : items) add(words, item);
  return words;
}
Words words_of(const MxtpTimeCode&) {
  return {};
}

// Type 01 as the specification says: a segment, three coordinates, three angles. No vector has it.
constexpr const char* kEuler =
    "4d58545030310000000780020000002a00170000000000380000000142c80000c2480000412000003f800000400000"
    "00"
    "4040000000000017bf800000c00000003f00000042b40000c334000041700000";

TEST(Mxtp, EveryItemHasItsBytesBitForBit) {
  std::vector<std::vector<std::byte>> datagrams{bytes_of(std::string(kEuler))};
  for (const json all = wire_vectors(); const json& vector : all["xsens_mvn"]["vectors"])
    datagrams.push_back(bytes_of(vector));
  std::map<int, std::size_t> compared;
  for (const auto& bytes : datagrams) {
    const auto datagram = decode_mxtp(bytes);
    ASSERT_TRUE(datagram.ok()) << datagram.error().message;
    if (datagram->header.type == 25) continue;  // a text
    Words wire;
    for (std::size_t at = kMxtpHeader; at < bytes.size(); at += 4)
      wire.push_back(static_cast<std::uint32_t>(std::to_integer<unsigned>(bytes[at]) << 24 |
                                                std::to_integer<unsigned>(bytes[at + 1]) << 16 |
                                                std::to_integer<unsigned>(bytes[at + 2]) << 8 |
                                                std::to_integer<unsigned>(bytes[at + 3])));
    EXPECT_EQ(std::visit([](const auto& items) { return words_of(items); }, datagram->items), wire)
        << datagram->header.type;
    compared[datagram->header.type] += wire.size();
  }
  EXPECT_THAT(compared, testing::UnorderedElementsAre(
                            testing::Key(1), testing::Key(2), testing::Key(20), testing::Key(21),
                            testing::Key(22), testing::Key(23), testing::Key(24)));
  const auto euler = decode_mxtp(datagrams[0]);
  const auto& items = std::get<std::vector<MxtpEuler>>(euler->items);
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0].position_cm, (Float3{100, -50, 10}));
  EXPECT_EQ(items[1].id, 23u);
  EXPECT_EQ(items[1].angles_deg, (Float3{90, -180, 15}));
}

TEST(Mxtp, WhatIsMalformedIsRefusedAsItsFactsSay) {
  for (const char* name :
       {"bad magic", "truncated header", "truncated payload", "item count lies", "segment id 0"})
    EXPECT_FALSE(decode_mxtp(bytes_of(malformed(name))).ok()) << name;
  for (const char* name : {"NaN position", "zero quaternion"}) {
    const MxtpDatagram datagram = decoded(malformed(name));
    EXPECT_EQ(datagram.refused_items, 1u) << name;
    ASSERT_EQ(std::get<std::vector<MxtpPose>>(datagram.items).size(), 1u);
    EXPECT_EQ(std::get<std::vector<MxtpPose>>(datagram.items)[0].id, 2u);
  }
}

TEST(Mxtp, WrittenAgainPosesAreTheSameBytes) {
  for (const char* name : {"MXTP02 split part 0 (not last)", "MXTP02 split part 1 (last)",
                           "MXTP02 with left-hand fingers (third datagram, last)"}) {
    const MxtpDatagram datagram = decoded(vector_named(name));
    const auto& poses = std::get<std::vector<MxtpPose>>(datagram.items);
    EXPECT_EQ(encode_mxtp(datagram.header, poses), bytes_of(vector_named(name))) << name;
  }
}

// One frame of a suit in `parts` datagrams, with gloves 63 items.
std::vector<MxtpDatagram> frame_of(std::uint32_t sample, std::uint32_t time_ms, int parts) {
  std::vector<MxtpDatagram> out;
  std::uint32_t id = 1;
  for (int i = 0; i < parts; ++i) {
    std::vector<MxtpPose> poses;
    while (id <= 63U * static_cast<std::uint32_t>(i + 1) / static_cast<std::uint32_t>(parts))
      poses.push_back({id++, {0, 0, static_cast<float>(sample % 1000)}, {1, 0, 0, 0}});
    MxtpHeader header{.sample = sample,
                      .datagram = static_cast<std::uint8_t>(i),
                      .last = i + 1 == parts,
                      .time_ms = time_ms,
                      .body_segments = 23,
                      .finger_segments = 40};
    out.push_back(decode_mxtp(encode_mxtp(header, poses)).value());
  }
  return out;
}

TEST(SuitFrames, AFrameIsWholeWhenAllPartsCameInAnyOrder) {
  SuitFrames frames;
  LinkCounts counts;
  const auto parts = frame_of(7, 1000, 3);
  EXPECT_EQ(frames.take(parts[2], 0, counts), nullptr);
  EXPECT_EQ(frames.take(parts[0], 0, counts), nullptr);
  EXPECT_EQ(frames.take(parts[0], 0, counts), nullptr);
  const SuitFrame* frame = frames.take(parts[1], 0, counts);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(counts.repeated, 1u);
  EXPECT_EQ(frame->sample, 7u);
  EXPECT_TRUE(frame->has_hands);
  EXPECT_EQ(frame->body[22].id, 23u);
  EXPECT_EQ(frame->hands[0][0].id, 24u);
  EXPECT_EQ(frame->hands[1][19].id, 63u);
}

TEST(SuitFrames, LateLostAndRepeatedFramesAreCounted) {
  SuitFrames frames;
  LinkCounts counts;
  const auto take = [&](std::uint32_t sample) {
    const SuitFrame* frame = nullptr;
    for (const auto& part : frame_of(sample, sample * 4, 2))
      if (const auto* whole = frames.take(part, TimeNs{4'000'000} * sample, counts)) frame = whole;
    return frame != nullptr;
  };
  EXPECT_TRUE(take(10));
  EXPECT_TRUE(take(14));
  EXPECT_EQ(counts.lost, 3u);
  EXPECT_FALSE(take(12));
  EXPECT_EQ(counts.older, 1u);
  EXPECT_EQ(counts.lost, 2u);
  EXPECT_FALSE(take(14));
  EXPECT_EQ(counts.repeated, 1u);
  EXPECT_TRUE(take(15));
}

TEST(SuitFrames, CountersThatWrapGoOn) {
  SuitFrames frames;
  LinkCounts counts;
  std::uint64_t last = 0, last_ms = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const SuitFrame* frame = nullptr;
    for (const auto& part : frame_of(0xfffffff5U + i, 0xfffffff0U + 4 * i, 1))
      frame = frames.take(part, TimeNs{4'000'000} * i, counts);
    ASSERT_NE(frame, nullptr) << i;
    if (i > 0) {
      EXPECT_EQ(frame->sample, last + 1);
      EXPECT_EQ(frame->time_ms, last_ms + 4);
    }
    last = frame->sample, last_ms = frame->time_ms;
  }
  EXPECT_EQ(counts.lost + counts.older + counts.repeated + counts.restarts, 0u);
}

TEST(SuitFrames, ARefusedSegmentKeepsItsLastGoodValue) {
  SuitFrames frames;
  LinkCounts counts;
  const auto good = frame_of(1, 4, 1);
  ASSERT_NE(frames.take(good[0], 0, counts), nullptr);
  auto bad = frame_of(2, 8, 1);
  auto& poses = std::get<std::vector<MxtpPose>>(bad[0].items);
  poses.erase(poses.begin() + 5);
  bad[0].refused_items = 1;
  const SuitFrame* frame = frames.take(bad[0], 4'000'000, counts);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(counts.refused, 1u);
  EXPECT_EQ(frame->body[5].position_m[2], 1.0F);
  EXPECT_EQ(frame->body[6].position_m[2], 2.0F);
}

TEST(SuitFrames, ADeviceThatStartsAgainIsHeardAfterASilence) {
  SuitFrames frames;
  LinkCounts counts;
  ASSERT_NE(frames.take(frame_of(5000, 20'000, 1)[0], 0, counts), nullptr);
  EXPECT_EQ(frames.take(frame_of(1, 4, 1)[0], 400'000'000, counts), nullptr);
  ASSERT_NE(frames.take(frame_of(2, 8, 1)[0], 600'000'000, counts), nullptr);
  EXPECT_EQ(counts.restarts, 1u);
}

TEST(SuitFrames, AFrameWithoutAllSegmentsOfTheBodyIsNone) {
  SuitFrames frames;
  LinkCounts counts;
  ASSERT_NE(frames.take(frame_of(1, 4, 1)[0], 0, counts), nullptr);
  for (std::uint32_t sample = 2; sample < 12; ++sample) {
    auto one = frame_of(sample, 4 * sample, 1);
    std::get<std::vector<MxtpPose>>(one[0].items).resize(1);
    EXPECT_EQ(frames.take(one[0], TimeNs{4'000'000} * sample, counts), nullptr);
  }
  EXPECT_EQ(counts.refused, 10u);
  EXPECT_EQ(frames.incomplete(), 10u);
  // Nor is the frame of a smaller body.
  auto few = frame_of(12, 48, 1);
  few[0].header.body_segments = 5;
  std::get<std::vector<MxtpPose>>(few[0].items).resize(5);
  EXPECT_EQ(frames.take(few[0], 48'000'000, counts), nullptr);
  const SuitFrame* frame = frames.take(frame_of(13, 52, 1)[0], 52'000'000, counts);
  ASSERT_NE(frame, nullptr);
  EXPECT_FALSE(frame->restarted);
  EXPECT_EQ(frames.incomplete(), 0u);
}

// A segment that is never good again, and gloves that are no longer worn, do not stay as they were.
TEST(SuitFrames, AValueIsKeptForHalfASecond) {
  SuitFrames frames;
  LinkCounts counts;
  ASSERT_NE(frames.take(frame_of(1, 4, 1)[0], 0, counts), nullptr);
  for (std::uint32_t sample = 2; sample < 300; ++sample) {
    auto bad = frame_of(sample, 4 * sample, 1);
    auto& poses = std::get<std::vector<MxtpPose>>(bad[0].items);
    poses.resize(23);
    if (sample < 200) {
      poses.erase(poses.begin() + 5);
      bad[0].refused_items = 1;
    }
    const TimeNs now = TimeNs{4'000'000} * sample;
    const SuitFrame* frame = frames.take(bad[0], now, counts);
    EXPECT_EQ(frame != nullptr, now <= SuitFrames::kKept_ns || sample >= 200) << sample;
    if (frame) {
      EXPECT_EQ(frame->has_hands, now <= SuitFrames::kKept_ns) << sample;
    }
  }
}

}  // namespace
}  // namespace neritic::net
