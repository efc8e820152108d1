#include <gtest/gtest.h>

#include "engine/recording/cdr.hpp"
#include "engine/recording/mcap_copy.hpp"
#include "engine/recording/mcap_reader.hpp"
#include "engine/recording/mcap_writer.hpp"
#include "engine/recording/ros_message.hpp"
#include "engine/recording/ros_types.hpp"
#include "tests/support/support.hpp"

namespace neritic::recording {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

class Kept final : public McapVisitor {
 public:
  Status header(const std::string& profile, const std::string& library) override {
    all += profile + "|" + library + "\n";
    return {};
  }
  Status schema(std::uint16_t, const McapSchema& schema) override {
    all += "schema " + schema.name + "\n";
    return {};
  }
  Status channel(std::uint16_t, const McapChannel& channel) override {
    all += "channel " + channel.topic + channel.metadata.at("a") + "\n";
    return {};
  }
  Status message(const McapMessage& message) override {
    all += fmt::format(
        "message {} {} {} {}\n", message.sequence, message.log_ns, message.publish_ns,
        std::string_view(reinterpret_cast<const char*>(message.data.data()), message.data.size()));
    return {};
  }
  Status attachment(const McapAttachment& attachment) override {
    all += fmt::format("attachment {} {}\n", attachment.name, attachment.data.size());
    return {};
  }
  Status metadata(const McapMetadata& metadata) override {
    all += "metadata " + metadata.name + metadata.words.at("k") + "\n";
    return {};
  }
  std::string all;
};

// Where the packed bytes of a chunk begin, from 0.
std::size_t chunk_at(const std::string& bytes, int chunk) {
  std::size_t at = bytes.find("zstd");
  for (int i = 0; i < chunk; ++i) at = bytes.find("zstd", at + 1);
  return at;
}

// Three chunks with two messages each.
std::string three_chunks() {
  McapWriter writer("ros2", "test");
  writer.metadata({"run", {{"k", "v"}}});
  writer.attachment({0, 0, "scene.toml", "text/plain", bytes_of("[physics]")});
  const auto schema = writer.add_schema(ros_schema("sensor_msgs/msg/Imu"));
  const auto a = writer.add_channel({schema, "/a", "cdr", {{"a", "1"}}});
  const auto b = writer.add_channel({schema, "/b", "cdr", {{"a", "2"}}});
  for (std::uint32_t i = 0; i < 3; ++i) {
    writer.message({a, i, 100 + i, 90 + i, bytes_of("one")});
    writer.message({b, i, 200 + i, 190 + i, bytes_of("two")});
    writer.end_chunk();
  }
  writer.finish();
  return writer.take();
}

TEST(Mcap, WhatIsWrittenReadsBackWithItsIndexes) {
  const std::string bytes = three_chunks();
  Kept kept;
  const auto source = mcap_of(bytes_of(bytes));
  const auto report = read_mcap(*source, "a.mcap", kept);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_TRUE(report->whole) << fmt::format("{}", fmt::join(report->damage, "\n"));
  EXPECT_EQ(report->chunks, 3u);
  EXPECT_EQ(report->messages, 6u);
  EXPECT_EQ(report->first_ns, 100u);
  EXPECT_EQ(report->last_ns, 202u);
  EXPECT_EQ(kept.all,
            "ros2|test\nmetadata runv\nattachment scene.toml 9\nschema sensor_msgs/msg/Imu\n"
            "channel /a1\nmessage 0 100 90 one\nchannel /b2\nmessage 0 200 190 two\n"
            "message 1 101 91 one\nmessage 1 201 191 two\nmessage 2 102 92 one\n"
            "message 2 202 192 two\n");
}

TEST(Mcap, CutOffAtAnyByteItReadsUpToItsLastWholeChunkAndARepairedCopyIsWhole) {
  const std::string bytes = three_chunks();
  std::uint64_t most = 0;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::string cut = bytes.substr(0, n);
    Kept kept;
    const auto source = mcap_of(bytes_of(cut));
    const auto report = read_mcap(*source, "cut.mcap", kept);
    if (!report.ok()) {
      EXPECT_EQ(most, 0u);
      continue;
    }
    EXPECT_FALSE(report->whole) << n;
    EXPECT_GE(report->messages, most) << n;
    most = report->messages;
    McapWriter writer("ros2", "test");
    McapCopy copy(writer);
    ASSERT_TRUE(read_mcap(*source, "cut.mcap", copy).ok());
    writer.finish();
    const std::string repaired = writer.take();
    McapVisitor nobody;
    const auto again = read_mcap(*mcap_of(bytes_of(repaired)), "new.mcap", nobody);
    EXPECT_TRUE(again->whole);
    EXPECT_EQ(again->messages, report->messages);
  }
  EXPECT_EQ(most, 6u);
}

// Every byte of the file is under a CRC, a magic or a length that tells.
TEST(Mcap, AChangedByteIsFound) {
  const std::string bytes = three_chunks();
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    std::string changed = bytes;
    changed[n] = static_cast<char>(changed[n] ^ 0x41);
    McapVisitor nobody;
    const auto report =
        read_mcap(*mcap_of(bytes_of(changed)), "bad.mcap", nobody, AfterDamage::kGoOn);
    EXPECT_FALSE(report.ok() && report->whole) << n;
    if (report.ok()) {
      EXPECT_LE(report->messages, 6u) << n;
    }
  }
}

TEST(Mcap, ADamagedChunkIsLeftOutAndTheRestIsRead) {
  std::string bytes = three_chunks();
  const std::size_t second = bytes.find("zstd", bytes.find("zstd") + 1);
  bytes[second + 20] = static_cast<char>(bytes[second + 20] ^ 1);
  McapVisitor nobody;
  const auto source = mcap_of(bytes_of(bytes));
  const auto stop = read_mcap(*source, "a.mcap", nobody);
  EXPECT_EQ(stop->messages, 2u);
  EXPECT_FALSE(stop->whole);
  const auto all = read_mcap(*source, "a.mcap", nobody, AfterDamage::kGoOn);
  EXPECT_EQ(all->messages, 4u);
  EXPECT_EQ(all->damage.front().substr(0, 8), "at byte ");
}

// The schemas and channels are in the first chunk, and in the summary.
TEST(Mcap, WithoutItsFirstChunkItIsReadByItsSummary) {
  std::string bytes = three_chunks();
  const std::size_t first = bytes.find("zstd");
  bytes[first + 20] = static_cast<char>(bytes[first + 20] ^ 1);
  Kept kept;
  const auto all = read_mcap(*mcap_of(bytes_of(bytes)), "a.mcap", kept, AfterDamage::kGoOn);
  EXPECT_EQ(all->messages, 4u);
  EXPECT_EQ(all->chunks, 2u);
  EXPECT_NE(kept.all.find("schema sensor_msgs/msg/Imu\nchannel /a1\nmessage 1 101 91 one\n"
                          "channel /b2\nmessage 1 201 191 two\nmessage 2 102 92 one\n"),
            std::string::npos)
      << kept.all;
  McapWriter writer("ros2", "test");
  McapCopy copy(writer);
  ASSERT_TRUE(read_mcap(*mcap_of(bytes_of(bytes)), "a.mcap", copy, AfterDamage::kGoOn).ok());
  writer.finish();
  McapVisitor nobody;
  const auto again = read_mcap(*mcap_of(bytes_of(writer.take())), "new.mcap", nobody);
  EXPECT_EQ(again->messages, 4u);
  // Without a summary nobody knows them: one line says so.
  bytes.resize(chunk_at(bytes, 2));
  const auto none = read_mcap(*mcap_of(bytes_of(bytes)), "a.mcap", nobody, AfterDamage::kGoOn);
  EXPECT_EQ(none->messages, 0u);
  ASSERT_EQ(none->damages, 2u);
  EXPECT_NE(none->damage[1].find(": 2 messages of 2 channels, which come nowhere before"),
            std::string::npos)
      << none->damage[1];
}

TEST(Mcap, AfterARecordOfAWrongLengthItGoesOnWithTheNextChunk) {
  const std::string bytes = three_chunks();
  // The head of the second chunk's record: its kind, then its length.
  const std::size_t second = chunk_at(bytes, 1);
  const std::size_t head = second - 4 - 4 - 8 - 16 - 9;
  ASSERT_EQ(bytes[head], '\6');
  for (std::size_t at = head; at < head + 9; ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = bytes;
      changed[at] = static_cast<char>(changed[at] ^ 1 << bit);
      McapVisitor nobody;
      const auto report =
          read_mcap(*mcap_of(bytes_of(changed)), "bad.mcap", nobody, AfterDamage::kGoOn);
      ASSERT_TRUE(report.ok()) << report.error().message;
      EXPECT_FALSE(report->whole);
      EXPECT_EQ(report->messages, 4u) << at - head << " " << bit;
    }
}

// A chunk of the full size has all schemas and channels of its messages.
// As many chunks, as a killed run leaves them: without an end.
std::string unfinished(std::uint32_t chunks) {
  McapWriter writer("ros2", "test");
  const auto schema = writer.add_schema(ros_schema("sensor_msgs/msg/Imu"));
  const auto a = writer.add_channel({schema, "/a", "cdr", {{"a", "1"}}});
  for (std::uint32_t i = 0; i < chunks; ++i) {
    writer.message({a, 2 * i, 100 + i, 90 + i, bytes_of("one")});
    writer.message({a, 2 * i + 1, 200 + i, 190 + i, bytes_of("two")});
    writer.end_chunk();
  }
  return writer.take();
}

// The head of a chunk's record lies 41 bytes before its packed bytes: 9 of kind and length, 28 of
// times, size and CRC, 4 of the length of "zstd".
TEST(Mcap, WithoutASummaryTooItGoesOnWithTheNextChunk) {
  constexpr std::uint32_t kChunks = 8;
  const std::string whole = unfinished(kChunks);
  const std::size_t third = chunk_at(whole, 2) - 41, fourth = chunk_at(whole, 3) - 41;
  McapVisitor nobody;
  const auto expect_rest = [&](const std::string& changed, const std::string& what) {
    const auto source = mcap_of(bytes_of(changed));
    const auto all = read_mcap(*source, "a.mcap", nobody, AfterDamage::kGoOn);
    ASSERT_TRUE(all.ok()) << what;
    EXPECT_EQ(all->messages, 2 * (kChunks - 1)) << what;
    EXPECT_GE(all->damages, 1u) << what;
    // A reader that stops there says so: the file is not only cut off.
    const auto stop = read_mcap(*source, "a.mcap", nobody);
    EXPECT_EQ(stop->messages, 4u) << what;
    EXPECT_EQ(stop->damages, 1u) << what;
  };
  std::string changed = whole;
  changed.replace(third, 60, std::string(60, '\0'));
  expect_rest(changed, "zeros");
  for (std::size_t bit = 0; bit < 64; ++bit) {
    changed = whole;
    changed[third + 1 + bit / 8] = static_cast<char>(changed[third + 1 + bit / 8] ^ (1 << bit % 8));
    expect_rest(changed, fmt::format("bit {} of a length", bit));
  }
  changed = whole;
  changed.erase(third + 20, 30);
  expect_rest(changed, "bytes that are missing");
  changed = whole;
  changed.insert(third + 20, 30, 'x');
  expect_rest(changed, "bytes too many");
  changed = whole;
  changed[fourth - 1] = static_cast<char>(changed[fourth - 1] ^ 1);  // of the index of messages
  const auto index = read_mcap(*mcap_of(bytes_of(changed)), "a.mcap", nobody, AfterDamage::kGoOn);
  EXPECT_EQ(index->messages, 2 * kChunks);
}

// Its addresses are wrong then.
TEST(Mcap, WithBytesMissingInTheMiddleTheSummaryDoesNotLeadAstray) {
  const std::string whole = three_chunks();
  const std::size_t second = chunk_at(whole, 1);
  McapVisitor nobody;
  for (const std::size_t bytes : {1, 7, 30}) {
    std::string changed = whole;
    changed.erase(second + 4, bytes);
    const auto all = read_mcap(*mcap_of(bytes_of(changed)), "a.mcap", nobody, AfterDamage::kGoOn);
    ASSERT_TRUE(all.ok());
    EXPECT_EQ(all->messages, 4u) << bytes;
    EXPECT_FALSE(all->whole);
  }
}

TEST(Mcap, AFullChunkStandsAlone) {
  McapWriter writer("ros2", "test");
  const auto schema = writer.add_schema(ros_schema("sensor_msgs/msg/Imu"));
  const auto a = writer.add_channel({schema, "/a", "cdr", {{"a", "1"}}});
  const std::string large(McapWriter::kChunk_bytes, 'x');
  for (std::uint32_t i = 0; i < 3; ++i) writer.message({a, i, i, i, bytes_of(large)});
  writer.finish();
  std::string bytes = writer.take();
  const std::size_t first = bytes.find("zstd");
  bytes[first + 20] = static_cast<char>(bytes[first + 20] ^ 1);
  bytes.resize(chunk_at(bytes, 2));
  McapVisitor nobody;
  const auto rest = read_mcap(*mcap_of(bytes_of(bytes)), "a.mcap", nobody, AfterDamage::kGoOn);
  EXPECT_EQ(rest->messages, 1u);
  EXPECT_EQ(rest->damages, 1u);
}

TEST(Mcap, OtherFilesAreRefusedInOneLine) {
  McapVisitor nobody;
  for (const std::string& other : {std::string(), std::string("NRTCLOG3"), std::string(100, 'x')})
    EXPECT_EQ(read_mcap(*mcap_of(bytes_of(other)), "x", nobody).error().message,
              "x: found no MCAP file; accepted: a recording of this program, or another MCAP file");
}

// By hand from OMG's rules: a header, then numbers at multiples of their size.
TEST(Cdr, BytesLieAsTheFormatSays) {
  std::string bytes;
  CdrWriter out(bytes);
  out.header(2'000'000'003, "ab");
  out.number(std::uint8_t{7});
  out.number(1.0);
  const std::vector<int> expected{0, 1, 0,   0,   2, 0, 0, 0, 3, 0, 0, 0, 3,    0,
                                  0, 0, 'a', 'b', 0, 7, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f};
  // The float64 is at the next multiple of 8 behind the first four bytes.
  ASSERT_EQ(bytes.size(), 4u + 24u);
  EXPECT_EQ(bytes.substr(0, 20), std::string("\0\1\0\0\2\0\0\0\3\0\0\0\3\0\0\0ab\0\7", 20));
  EXPECT_EQ(static_cast<unsigned char>(bytes[27]), 0x3fu);
  CdrReader in(bytes_of(bytes));
  EXPECT_EQ(in.number<std::int32_t>(), 2);
  EXPECT_EQ(in.number<std::uint32_t>(), 3u);
  EXPECT_EQ(in.text(), "ab");
  EXPECT_EQ(in.number<std::uint8_t>(), 7);
  EXPECT_EQ(in.number<double>(), 1.0);
  EXPECT_TRUE(in.whole());
  EXPECT_EQ(in.left(), 0u);
}

TEST(RosMessage, ReadsNestedFieldsArraysAndSequencesByTheSchema) {
  const auto type = RosMessage::parse(
      own_schema("x/msg/Y",
                 "uint8 A=3\nstd_msgs/Header header # the time\ngeometry_msgs/Point[2] corners\n"
                 "uint8[] data\nuint64 hash\n"));
  ASSERT_TRUE(type.ok()) << type.error().message;
  std::vector<std::string> names;
  for (const auto& column : type->columns()) names.push_back(column.name);
  EXPECT_EQ(fmt::format("{}", fmt::join(names, " ")),
            "header_stamp_sec header_stamp_nanosec header_frame_id corners_0_x corners_0_y "
            "corners_0_z corners_1_x corners_1_y corners_1_z data hash");
  std::string bytes;
  CdrWriter out(bytes);
  out.header(5, "f");
  out.vector({1, 2, 3}), out.vector({4, 5, 6});
  out.count(2);
  out.number(std::uint8_t{8}), out.number(std::uint8_t{9});
  out.number(~std::uint64_t{0});
  const auto values = type->read(bytes_of(bytes));
  ASSERT_TRUE(values);
  EXPECT_EQ(std::get<double>((*values)[7]), 5.0);
  EXPECT_EQ(std::get<std::vector<double>>((*values)[9]), (std::vector<double>{8, 9}));
  EXPECT_EQ(std::get<std::uint64_t>((*values)[10]), ~std::uint64_t{0});
  EXPECT_EQ(type->read_bytes(bytes_of(bytes), 9)->size(), 2u);
  EXPECT_FALSE(type->read(bytes_of(bytes.substr(0, bytes.size() - 1))));
}

TEST(RosMessage, SchemasThatAreNoneAreRefused) {
  for (const char* lines :
       {"float64", "unknown/Type x\n", "float64[0] x\n", "float64[x] y\n", "float64 a-b\n"}) {
    McapSchema schema{"x/msg/Y", "ros2msg", lines};
    EXPECT_FALSE(RosMessage::parse(schema).ok()) << lines;
  }
  // One that contains itself.
  McapSchema loop{"x/msg/Y", "ros2msg", "x/Z z\n====\nMSG: x/Z\nx/Z z\nfloat64 a\n"};
  EXPECT_FALSE(RosMessage::parse(loop).ok());
}

}  // namespace
}  // namespace neritic::recording
