// XDF is read back by libxdf, where that is installed (Debian package libxdf-dev).
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/recording/xdf_writer.hpp"
#include "tests/support/support.hpp"
#if NERITIC_HAS_LIBXDF
#include <xdf.h>
#endif

namespace neritic::recording {
namespace {

std::string two_streams() {
  XdfWriter writer;
  const auto a = writer.add_stream({"/diver/heart", "heart", {"bpm", "a<b"}, 0.0});
  const auto b = writer.add_stream({"/rov/imu", "imu", {"x"}, 200.0});
  for (int i = 0; i < 10'000; ++i) {
    const double values[] = {60.0 + i, -1.0 * i};
    if (i < 3) writer.sample(a, 0.5 * i, values);
    writer.sample(b, 0.005 * i, std::span(values).first(1));
  }
  writer.finish();
  return writer.take();
}

TEST(Xdf, BeginsAsTheFormatSays) {
  const std::string bytes = two_streams();
  EXPECT_EQ(bytes.substr(0, 4), "XDF:");
  EXPECT_EQ(bytes[4], 1);  // a length of one byte
  EXPECT_EQ(bytes.substr(6, 2), std::string("\1\0", 2));
  EXPECT_NE(bytes.find("<label>a&lt;b</label>"), std::string::npos);
}

TEST(Xdf, AnotherProgramsLibraryReadsItBack) {
#if NERITIC_HAS_LIBXDF
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "a.xdf", two_streams()).ok());
  Xdf xdf;
  xdf.load_xdf((folder / "a.xdf").string());
  ASSERT_EQ(xdf.streams.size(), 2u);
  EXPECT_EQ(xdf.streams[0].info.name, "/diver/heart");
  ASSERT_EQ(xdf.streams[0].time_series.size(), 2u);
  ASSERT_EQ(xdf.streams[0].time_series[0].size(), 3u);
  EXPECT_EQ(xdf.streams[0].time_series[0][2], 62.0f);
  EXPECT_EQ(xdf.streams[0].time_series[1][2], -2.0f);
  ASSERT_EQ(xdf.streams[1].time_stamps.size(), 10'000u);
  EXPECT_NEAR(xdf.streams[1].time_stamps.back(), 49.995, 1e-9);
#else
  GTEST_SKIP() << "no libxdf (Debian package libxdf-dev)";
#endif
}

}  // namespace
}  // namespace neritic::recording
