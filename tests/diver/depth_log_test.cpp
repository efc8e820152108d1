// Depth logs as text: columns in any order, samples that failed, and one line that says what is
// wrong.
#include "diver/depth_log.hpp"

#include <gtest/gtest.h>

#include "diver/deco_live.hpp"
#include "diver/gas_label.hpp"

namespace neritic::diver {
namespace {

TEST(DepthLog, ColumnsStandInAnyOrderBesideOthers) {
  const auto log = read_depth_log(
      "# of a computer\ntemp;depth_m;time_min;gas\r\n\n12;0;0;18/45\n12; 5.5 ;.5;\n11;;1;ean50\n"
      "11;nan;1;18/45\n",
      "dive.csv");
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->samples.size(), 4u);
  EXPECT_EQ(log->samples[1].time_s, 30.0);
  EXPECT_EQ(log->samples[1].depth_m, 5.5);
  for (const std::size_t i : {2u, 3u}) EXPECT_TRUE(log->samples[i].failed) << i;
  ASSERT_EQ(log->gases.size(), 2u);
  EXPECT_EQ(name_of(log->gases[1]), "EAN50");
  const std::size_t gases[] = {0, 0, 1, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(log->samples[i].gas, gases[i]);
}

// As spreadsheets write them, and as the readers of other recordings take them.
TEST(DepthLog, HeadingsOfSpreadsheetsAreRead) {
  for (const char* heading : {"\xEF\xBB\xBFtime_s,depth_m", "Time_s,Depth_m", "time (s),Depth (m)",
                              "time_ms,depth_m", "\"time_min\";\"depth_m\"", "t\tdepth [m]"}) {
    const std::string names = heading;
    const char cut = names.find(';') != names.npos    ? ';'
                     : names.find('\t') != names.npos ? '\t'
                                                      : ',';
    const double unit_s = names.find("_ms") != names.npos    ? 1e-3
                          : names.find("_min") != names.npos ? 60.0
                                                             : 1.0;
    const auto log =
        read_depth_log(fmt::format("{0}\r\n0{1}1\r\n4{1}2.5\r\n", names, cut), "d.csv");
    ASSERT_TRUE(log.ok()) << log.error().message;
    ASSERT_EQ(log->samples.size(), 2u);
    EXPECT_NEAR(log->samples[1].time_s, 4.0 * unit_s, 1e-12) << names;
    EXPECT_EQ(log->samples[1].depth_m, 2.5) << names;
  }
}

// Where a comma is the decimal point, spreadsheets part cells by semicolons.
TEST(DepthLog, DecimalCommasAreReadBetweenSemicolonsAndNamedBetweenCommas) {
  const auto log =
      read_depth_log("time_min;depth_m;gas\r\n0;0,25;air\n0,5;30,5;air\n1;30.5;\n", "d.csv");
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->samples.size(), 3u);
  EXPECT_EQ(log->samples[1].time_s, 30.0);
  EXPECT_EQ(log->samples[0].depth_m, 0.25);
  EXPECT_EQ(log->samples[1].depth_m, 30.5);
  EXPECT_EQ(log->samples[2].depth_m, 30.5);
  const auto fault = [](const char* text) {
    const auto read = read_depth_log(text, "d.csv");
    return read.ok() ? std::string("read") : read.error().message;
  };
  EXPECT_EQ(fault("time_s;depth_m\n0;1,2,3\n"),
            "d.csv: line 2: found depth '1,2,3'; accepted: a number");
  EXPECT_EQ(fault("time_s,depth_m\n0,1,5\n"),
            "d.csv: line 2: found 3 cells; accepted: 2 (commas part cells here; decimal commas are "
            "read where semicolons alone do)");
}

TEST(DepthLog, XmlIsNamedAndWhatIsReadInItsPlace) {
  const auto log = read_depth_log("<uddf version=\"3.2.0\"></uddf>\n", "a.uddf");
  ASSERT_FALSE(log.ok());
  EXPECT_EQ(log.error().message,
            "a.uddf: line 1: found XML, '<uddf version=\"3.2.0\"></uddf>'; accepted: a table (CSV) "
            "with the columns time_s and depth_m, as dive logs export it");
}

TEST(DepthLog, WhatIsWrongIsSaidWithItsLine) {
  const auto fault = [](const char* text) {
    const auto log = read_depth_log(text, "d.csv");
    return log.ok() ? std::string("read") : log.error().message;
  };
  EXPECT_EQ(fault("time_s,depth_m\n0,1\n"), "read");
  EXPECT_EQ(fault(""), "d.csv: found no row of names; accepted: time_s and depth_m");
  EXPECT_EQ(fault("time_s,depth_m\n"), "d.csv: found no sample; accepted: at least one");
  EXPECT_EQ(fault("clock,depth_m\n0,1\n"),
            "d.csv: line 1: found columns 'clock,depth_m'; accepted: with time_s or time_min, "
            "and depth_m");
  EXPECT_EQ(fault("time_s,depth_m\n0,1\n1\n"), "d.csv: line 3: found 1 cells; accepted: 2");
  EXPECT_EQ(fault("time_s,depth_m\nx,1\n"), "d.csv: line 2: found time 'x'; accepted: a number");
  EXPECT_EQ(fault("time_s,depth_m\nnan,1\n"),
            "d.csv: line 2: found time 'nan'; accepted: a number");
  EXPECT_EQ(fault("time_s,depth_m\n5,1\n4,1\n"),
            "d.csv: line 3: found time 4 after 5; accepted: times that do not go back");
  EXPECT_EQ(fault("time_s,depth_m\n0,1m\n"), "d.csv: line 2: found depth '1m'; accepted: a number");
  EXPECT_EQ(fault("time_s,depth_m\n0,0.2\n10,-18.5\n"),
            "d.csv: line 3: found depth '-18.5'; accepted: from -1; --depths-up reads depths that "
            "are negative");
  EXPECT_EQ(fault("time_s,depth_m,gas\n0,1,water\n"),
            "d.csv: line 2: found gas 'water'; accepted: air, o2, ean32 or 18/45");
}

// Depths that are negative below the surface were a dive at the surface. A computer that bobs there
// shows a little above it.
TEST(DepthLog, DepthsCountDownwardsOrAsAskedUpwards) {
  const char* up = "time_s,depth_m\n0,0.4\n10,-18\n20,nan\n30,-30\n40,\n";
  EXPECT_FALSE(read_depth_log(up, "d.csv").ok());
  const auto turned = read_depth_log(up, "d.csv", "", true);
  ASSERT_TRUE(turned.ok()) << turned.error().message;
  EXPECT_EQ(turned->samples[0].depth_m, -0.4);
  EXPECT_EQ(turned->samples[1].depth_m, 18.0);
  EXPECT_TRUE(turned->samples[2].failed);
  EXPECT_EQ(turned->samples[2].depth_m, 24.0);
  EXPECT_EQ(turned->samples[3].depth_m, 30.0);
  const auto down = read_depth_log("time_s,depth_m\n0,-1\n10,-0.3\n20,18\n", "d.csv");
  ASSERT_TRUE(down.ok()) << down.error().message;
  EXPECT_EQ(down->samples[0].depth_m, -1.0);
  const auto wrong = read_depth_log("time_s,depth_m\n0,0\n10,18\n", "d.csv", "", true);
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().message.find("line 3: found depth '18'"), std::string::npos)
      << wrong.error().message;
}

// A dive of 30 m whose way down failed was read as 20 minutes at the surface.
TEST(DepthLog, AFailedSampleLiesBetweenItsNeighboursAndALongGapIsRefused) {
  const auto log = read_depth_log(
      "time_s,depth_m\n0,nan\n5,0\n20,10\n30,nan\n60,9999\n70,30\n80,28\n90,\n", "d.csv");
  ASSERT_TRUE(log.ok()) << log.error().message;
  const double depths_m[] = {0.0, 0.0, 10.0, 14.0, 26.0, 30.0, 28.0, 28.0};
  const bool failed[] = {true, false, false, true, true, false, false, true};
  ASSERT_EQ(log->samples.size(), std::size(depths_m));
  for (std::size_t i = 0; i < std::size(depths_m); ++i) {
    EXPECT_NEAR(log->samples[i].depth_m, depths_m[i], 1e-12) << i;
    EXPECT_EQ(log->samples[i].failed, failed[i]) << i;
  }
  EXPECT_EQ(log->failed, 4u);
  ASSERT_EQ(log->notes.size(), 1u);
  EXPECT_EQ(log->notes[0].find("4 samples were refused, first in line 2: found depth 'nan'; "), 0u)
      << log->notes[0];
  const auto fault = [](const char* rows) {
    const auto read = read_depth_log(std::string("time_s,depth_m\n") + rows, "d.csv");
    return read.ok() ? std::string("read") : read.error().message;
  };
  const char* accepted = "; accepted: metres from -1 to 2000, and up to 60 s without one";
  EXPECT_EQ(fault("0,0\n120,nan\n1200,30\n1800,0\n"),
            std::string("d.csv: line 3: found depth 'nan', and no depth for 1200 s") + accepted);
  EXPECT_EQ(fault("0,0\n60,30\n90,\n121,30\n"),
            std::string("d.csv: line 4: found depth '', and no depth for 61 s") + accepted);
  EXPECT_EQ(fault("0,nan\n61,0\n"),
            std::string("d.csv: line 2: found depth 'nan', and no depth for 61 s") + accepted);
  EXPECT_EQ(fault("0,0\n10,20\n20,2001\n71,inf\n"),
            std::string("d.csv: line 4: found depth '2001', and no depth for 61 s") + accepted);
  EXPECT_EQ(fault("0,0\n60,30\n90,\n120,30\n"), "read");
  EXPECT_EQ(fault("0,nan\n1,\n"),
            "d.csv: found no depth that a dive has in 2 samples; accepted: a log with depths in "
            "metres");
}

TEST(DepthLog, DepthsInAnotherUnitAndLongTimesBetweenSamplesAreSaid) {
  const auto millibar = read_depth_log("time_s,depth_m\n0,1013\n60,1913\n120,1013\n", "d.csv");
  ASSERT_FALSE(millibar.ok());
  EXPECT_EQ(millibar.error().message,
            "d.csv: found no depth above 1013 m; accepted: a log with depths in metres");
  const auto notes = [](const char* rows) {
    const auto read = read_depth_log(std::string("time_s,depth_m\n") + rows, "d.csv");
    EXPECT_TRUE(read.ok()) << rows;
    return read.ok() ? read->notes : std::vector<std::string>();
  };
  const auto bar = notes("0,1.013\n60,4.1\n");
  ASSERT_EQ(bar.size(), 1u);
  EXPECT_EQ(bar[0].find("no depth is nearer to the surface than 1.01 m: "), 0u) << bar[0];
  const auto gap = notes("0,0\n60,10\n6000,30\n6090,0\n");
  ASSERT_EQ(gap.size(), 1u);
  EXPECT_EQ(gap[0].find("from line 3 to 4, 5940 s pass without a sample: "), 0u) << gap[0];
  EXPECT_TRUE(notes("0,0\n60,10\n120,30\n180,0.5\n").empty());
}

// A computer reads the depths that a log has.
TEST(DepthLog, AComputerRefusesNoSampleOfALog) {
  const auto computer = DiveComputer::create({});
  ASSERT_TRUE(computer.ok());
  const auto log = read_depth_log("time_s,depth_m\n0,-1\n10,nan\n60,2000\n", "d.csv");
  ASSERT_TRUE(log.ok()) << log.error().message;
  DiveComputerState state = computer->start();
  for (const DepthSample& s : log->samples) state = computer->step(state, {s.depth_m, s.gas}, 10.0);
  EXPECT_EQ(state.refused, 0u);
}

}  // namespace
}  // namespace neritic::diver
