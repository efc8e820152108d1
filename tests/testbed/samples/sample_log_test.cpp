#include "testbed/samples/sample_log.hpp"

#include <limits>

#include "engine/core/files.hpp"
#include "engine/sim/fields.hpp"
#include "testbed/samples/authority.hpp"
#include "testbed/samples/recorded_source.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/samples/streams.hpp"

namespace neritic::testbed {
namespace {

// One sample of each stream, every number of its payload another one.
SampleLog log_of_every_kind() {
  const StreamTable table = diver_and_rov();
  SampleLog log{0.25, 42, logged_streams(table), {"simulation", "motion suit"}, {}, {1, 2, 3, 4}};
  double next = 0.5;
  for (StreamId id = 0; id < table.size(); ++id) {
    Payload payload = empty_payload(table[id].kind);
    std::visit(
        [&](auto& value) {
          sim::for_each_scalar(value, [&](auto& scalar) {
            scalar = static_cast<std::remove_reference_t<decltype(scalar)>>(next++);
          });
        },
        payload);
    log.entries.push_back({id / 8u, {{id, 1, 7 + id, -3, 1'000'000'000'000}, payload}});
  }
  return log;
}

TEST(SampleLog, EveryKindReadsBackAsItWasWritten) {
  const test::ScratchFolder folder;
  const SampleLog log = log_of_every_kind();
  ASSERT_TRUE(write_sample_log(folder / "run.log", log).ok());
  const auto read = read_sample_log(folder / "run.log");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->step_s, 0.25);
  EXPECT_EQ(read->seed, 42u);
  EXPECT_EQ(read->streams, log.streams);
  EXPECT_EQ(read->sources, log.sources);
  EXPECT_EQ(read->hashes, log.hashes);
  ASSERT_EQ(read->entries.size(), log.entries.size());
  for (std::size_t i = 0; i < log.entries.size(); ++i) {
    EXPECT_EQ(read->entries[i].step, log.entries[i].step);
    EXPECT_TRUE(sim::same_bits(read->entries[i].sample.header, log.entries[i].sample.header));
    std::visit(
        [&](const auto& value) {
          using T = std::remove_cvref_t<decltype(value)>;
          EXPECT_TRUE(sim::same_bits(value, std::get<T>(log.entries[i].sample.payload))) << i;
        },
        read->entries[i].sample.payload);
  }
}

// The format's description, read by hand.
TEST(SampleLog, BytesLieAsTheFormatSays) {
  const SampleLog log{0.25,
                      7,
                      {{"d/gas", PayloadKind::kGas}},
                      {"s"},
                      {{0, {{0, 0, 5, 1, 2}, GasSupply{9}}}},
                      {0x1122334455667788ull, 3}};
  const std::vector<int> expected{
      'N', 'R', 'T', 'C', 'L', 'O', 'G', '3',                    //
      0, 0, 0, 0, 0, 0, 0xd0, 0x3f, 7, 0, 0, 0, 0, 0, 0, 0,      // 0.25, seed
      1, 0, 0, 0, 1, 0, 0, 0,                                    // kinds, streams
      3, 'g', 'a', 's', 1, 0, 0, 0, 'Q', 4, 't', 'a', 'n', 'k',  //
      5, 'd', '/', 'g', 'a', 's', 0, 0, 0, 0,                    //
      'N', 1, 's',                                               //
      'H', 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11,       //
      'S', 0, 0, 0, 0, 0, 0, 0, 0,                               // stream,
                                                                 // source
      5, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0,            // sequence, captured
      2, 0, 0, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0,            // arrived, tank
      'H', 3, 0, 0, 0, 0, 0, 0, 0,                               //
      'E', 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  const auto bytes = encode_sample_log(log);
  ASSERT_EQ(bytes.size(), expected.size());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    EXPECT_EQ(static_cast<unsigned char>(bytes[i]), expected[i]) << i;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// A run that was killed, at any byte: its whole steps, with their samples.
TEST(SampleLog, ACutOffLogReadsUpToItsLastWholeStep) {
  const SampleLog whole = log_of_every_kind();
  const std::string bytes = encode_sample_log(whole);
  std::uint64_t steps = 0;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const auto log = parse_sample_log(bytes_of(bytes.substr(0, n)), "cut.log");
    if (!log.ok()) {
      EXPECT_EQ(steps, 0u);
      EXPECT_TRUE(log.error().message.starts_with("cut.log: ")) << log.error().message;
      EXPECT_EQ(log.error().message.find('\n'), std::string::npos);
      continue;
    }
    EXPECT_FALSE(log->whole);
    EXPECT_GE(log->steps(), steps);
    steps = log->steps();
    const auto used = std::ranges::count_if(
        whole.entries, [&](const SampleLog::Entry& entry) { return entry.step < steps; });
    ASSERT_EQ(log->entries.size(), static_cast<std::size_t>(used)) << n;
    ASSERT_TRUE(std::equal(log->hashes.begin(), log->hashes.end(), whole.hashes.begin())) << n;
  }
  EXPECT_EQ(steps, 3u);
  EXPECT_EQ(parse_sample_log(bytes_of(bytes + "x"), "long.log").error().message,
            "long.log: 1 bytes after its end");
}

// Its run failed after samples were drained: they have no step.
TEST(SampleLog, SamplesOfAStepThatDidNotEndAreLeftOut) {
  const SampleLog log = log_of_every_kind();
  SampleLogWriter out(log.step_s, log.seed, log.streams);
  for (const std::string& source : log.sources) out.source(source);
  out.hash(1);
  out.sample(log.entries[0].sample);
  out.hash(2);
  out.sample(log.entries[1].sample);
  out.end();
  const auto read = parse_sample_log(bytes_of(out.take()), "run.log");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_TRUE(read->whole);
  EXPECT_EQ(read->steps(), 1u);
  EXPECT_EQ(read->entries.size(), 1u);
}

struct BadLog {
  const char* says;
  void (*spoil)(SampleLog&);
};
void PrintTo(const BadLog& bad, std::ostream* out) {
  *out << bad.says;
}
class BadSampleLog : public testing::TestWithParam<BadLog> {};

TEST_P(BadSampleLog, IsTheDocumentedLine) {
  SampleLog log = log_of_every_kind();
  GetParam().spoil(log);
  const auto read = parse_sample_log(bytes_of(encode_sample_log(log)), "bad.log");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().message, GetParam().says);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSampleLog,
    testing::Values(BadLog{"bad.log: a step of 0 s; accepted: over 0 to 1 s",
                           [](SampleLog& log) { log.step_s = 0.0; }},
                    BadLog{"bad.log: sample 1 is of no stream or source of the file",
                           [](SampleLog& log) { log.entries[1].sample.header.stream = 999; }},
                    BadLog{"bad.log: sample 0, of diver/joints at step 0, is not finite",
                           [](SampleLog& log) {
                             std::get<BodyJoints>(log.entries[0].sample.payload).joints[2].y =
                                 std::numeric_limits<double>::quiet_NaN();
                           }},
                    BadLog{"bad.log: source 1 has no name in printable text",
                           [](SampleLog& log) { log.sources[1] = "\n"; }}));

TEST(SampleLog, AnOlderVersionsLogAndOtherStreamsAreRefusedInOneLine) {
  auto bytes = encode_sample_log(log_of_every_kind());
  for (const char version : {'1', '2'}) {
    bytes[7] = version;
    EXPECT_EQ(
        parse_sample_log(bytes_of(bytes), "old.log").error().message,
        fmt::format("old.log: a log of inputs of an older version (NRTCLOG{}); accepted: NRTCLOG3",
                    version));
  }
  const SampleLog log = log_of_every_kind();
  EXPECT_TRUE(check_streams(log, diver_and_rov(), "run.log").ok());
  StreamTable other;
  other.add_diver("buddy");
  EXPECT_EQ(check_streams(log, other, "run.log").error().message,
            "run.log: samples of diver/joints found; accepted: of the scene's streams");
  StreamTable more = diver_and_rov();
  more.add_diver("buddy");
  EXPECT_TRUE(check_streams(log, more, "run.log").ok());
}

TEST(SampleLog, AnEventOfASourceThatTheLogDoesNotNameIsRefusedInOneLine) {
  const StreamTable table = diver_and_rov();
  for (const SourceId named : {0u, 1u, 2u}) {
    SampleLog log{1.0 / 240.0, 0, logged_streams(table), {"simulation", "suit"}, {}, {1, 2}};
    const Event event{EventKind::kSetAuthority, 0, static_cast<std::uint64_t>(Authority::kLive),
                      named};
    log.entries.push_back({0, sample_of(table, "diver/event", 1, 0, event)});
    SampleInbox inbox(table, 8);
    ASSERT_TRUE(inbox.open("pad").ok());  // has the number 1 here
    auto source = RecordedSource::create(log, table, "run.log");
    const Status polled = source->poll(inbox, 0.0);
    if (named == 2) {
      EXPECT_EQ(polled.error().message,
                "run.log: diver/event at step 0: an event of source 2 found; accepted: of the "
                "log's 2");
      continue;
    }
    ASSERT_TRUE(polled.ok()) << polled.error().message;
    EXPECT_EQ(std::get<Event>(inbox.drain()[0].payload).source, named == 0 ? 0u : 2u);
  }
}

}  // namespace
}  // namespace neritic::testbed
