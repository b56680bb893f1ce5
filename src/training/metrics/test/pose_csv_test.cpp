#include "metrics/pose_csv.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "metrics/testing/recording.h"

namespace trocar::metrics {
namespace {

class PoseCsv : public ::testing::Test {
 protected:
  Result<PoseTable> read(const std::string& text) {
    std::ofstream(file_) << text;
    return PoseTable::read(file_);
  }
  std::vector<Moment> moments(const std::string& text) {
    const auto table = read(text);
    std::vector<Moment> all;
    EXPECT_TRUE(table) << (table ? "" : table.error().text());
    if (table) table->walk([&](const Moment& moment) { all.push_back(moment); });
    return all;
  }
  std::string refused(const std::string& text) {
    const auto table = read(text);
    EXPECT_FALSE(table) << text;
    return table ? std::string() : table.error().what;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "poses.csv";
};

constexpr const char* kHeader = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z\n";

TEST_F(PoseCsv, ReadsNeedlePoses) {
  const std::string header = kHeader;
  const auto all = moments(header + "0.5,1,2,3,0,0,1\n1.5,1e1,-2.5,3,0,1,0");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].time_s, 0.5);
  EXPECT_EQ(all[1].tip_P, Vec3(10.0, -2.5, 3.0));
  EXPECT_EQ(all[1].axis_P, Vec3(0, 1, 0));
  EXPECT_FALSE(all[0].depth_mm || all[0].X_PT || all[0].resistance_n || all[0].events || all[0].phase);
}

TEST_F(PoseCsv, ReadsMetresAnyColumnOrderAndSpreadsheetQuirks) {
  const auto all = moments(
      "\xEF\xBB\xBFoperator, axis_x,axis_y,axis_z,tip_z_m,tip_y_m,tip_x_m,time_s\r\n"
      "\"Doe, J.\", 0,0,1,0.003,0.002,0.001,7\r\n\r\n");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_LT((all[0].tip_P - Vec3(1, 2, 3)).norm(), 1e-12);
  EXPECT_EQ(all[0].time_s, 7.0);
}

TEST_F(PoseCsv, ReadsTransducerForceDepthPhaseAndEvents) {
  const auto table = read(
      "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,probe_x_mm,probe_y_mm,probe_z_mm,probe_qw,probe_qx,"
      "probe_qy,probe_qz,probe_contact_n,force_n,depth_mm,phase,event\n"
      "0,0,0,0,0,0,1,4,5,6,0,0,0,1,2.5,1.25,12,inserted,puncture:skin;enter:liver\n"
      "1,0,0,0,0,0,1,,,,,,,,,nan,,retracting,\"interruption:0.5;puncture:muscle\"\n");
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_EQ(table->layer_names(), (std::vector<std::string>{"skin", "muscle"}));
  std::vector<Moment> all;
  table->walk([&](const Moment& moment) { all.push_back(moment); });
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].X_PT->p(), Vec3(4, 5, 6));
  EXPECT_LT((all[0].X_PT->R() * Vec3(1, 2, 3) - Vec3(-1, -2, 3)).norm(), 1e-12);
  EXPECT_EQ(*all[0].contact_n, 2.5);
  EXPECT_EQ(*all[0].resistance_n, 1.25);
  EXPECT_EQ(*all[0].depth_mm, 12.0);
  EXPECT_EQ(*all[0].phase, telemetry::InsertionPhase::kInserted);
  EXPECT_EQ((*all[0].events)[0].kind, telemetry::EventKind::kPuncture);
  EXPECT_EQ((*all[0].events)[0].id, 0);
  EXPECT_FALSE(all[1].X_PT || all[1].contact_n || all[1].resistance_n || all[1].depth_mm);
  EXPECT_TRUE(all[1].is_paused);
  EXPECT_EQ((*all[1].events)[0].id, 1);
}

TEST_F(PoseCsv, KnowsHowFarALoadedTipPressesIn) {
  const std::string header = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,phase,layer_displacement_mm\n";
  const auto all = moments(header + "0,0,0,9,0,0,1,loading,2\n1,0,0,9,0,0,1,inserted,2\n2,0,0,9,0,0,1,loading,\n");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_GT(all[0].pressed_mm, 2.0);
  EXPECT_LT(all[0].pressed_mm, 2.2);
  EXPECT_EQ(all[1].pressed_mm, 0.0) << "it has given way";
  EXPECT_EQ(all[2].pressed_mm, 0.0);
}

TEST_F(PoseCsv, ATableWithoutAnyPunctureKnowsNoEvents) {
  const std::string header = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,event\n";
  EXPECT_FALSE(moments(header + "0,0,0,9,0,0,1,\n1,0,0,9,0,0,1,enter:liver\n")[1].events);
  EXPECT_TRUE(moments(header + "0,0,0,9,0,0,1,\n1,0,0,9,0,0,1,puncture:skin\n")[0].events);
}

TEST_F(PoseCsv, NamesLineAndColumnOfAnError) {
  const std::string header = kHeader;
  EXPECT_EQ(refused(""), "the file is empty");
  EXPECT_EQ(refused(header), "the table has no row of poses");
  EXPECT_EQ(refused("tip_x_mm,tip_y_mm\n1,2\n"), "line 1: missing column time_s");
  EXPECT_EQ(refused("time_s,tip_x_mm,tip_z_mm,axis_x,axis_y,axis_z\n"), "line 1: missing column tip_y_mm");
  EXPECT_EQ(refused("time_s,tip_x_mm,tip_y_mm,tip_z_mm\n"), "line 1: missing column axis_x");
  EXPECT_EQ(refused("time_s,time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z\n"),
            "line 1: column time_s occurs twice");
  EXPECT_EQ(refused("time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,probe_x_mm,probe_y_mm,probe_z_mm\n"),
            "line 1: missing column probe_qw");
  EXPECT_EQ(refused(header + "0,0,0,0,0,0,1\n1,0,x7,0,0,0,1\n"), "line 3: column tip_y_mm: 'x7' is not a number");
  EXPECT_EQ(refused(header + "0,0,0,0,0,0,1\n1,0,0\n"), "line 3: 3 fields, the header has 7");
  EXPECT_EQ(refused(header + "2,0,0,0,0,0,1\n1,0,0,0,0,0,1\n"),
            "line 3: column time_s: 1 s is before the line above (2 s)");
}

TEST_F(PoseCsv, RefusesInvalidNumbersPhasesAndEvents) {
  const std::string header = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,depth_mm,phase,event\n";
  struct Case {
    const char *row, *what;
  };
  for (const Case& c : std::vector<Case>{
           {"0,0,0,0,0,0,1,1.0x,,", "line 2: column depth_mm: '1.0x' is not a number"},
           {"0,inf,0,0,0,0,1,1,,", "line 2: column tip_x_mm: 'inf' is not a number"},
           {"0,0,0,-inf,0,0,1,1,,", "line 2: column tip_z_mm: '-inf' is not a number"},
           {"0,1e999,0,0,0,0,1,1,,", "line 2: column tip_x_mm: '1e999' is not a number"},
           {"0,\"0,5\",0,0,0,0,1,1,,", "line 2: column tip_x_mm: '0,5' is not a number"},
           {"0,0,5,0,0,0,0,1,1,,", "line 2: 11 fields, the header has 10"},
           {"0;0;0;0;0;0;1;1;;", "line 2: 1 fields, the header has 10"},
           {",0,0,0,0,0,1,1,,", "line 2: column time_s: a row has no time"},
           {"nan,0,0,0,0,0,1,1,,", "line 2: column time_s: a row has no time"},
           {"0,0,0,0,0,0,1,1,inside,", "line 2: column phase: 'inside' is no phase"},
           {"0,0,0,0,0,0,1,1,Inserted,", "line 2: column phase: 'Inserted' is no phase"},
           {"0,0,0,0,0,0,1,1,,interruption:abc",
            "line 2: column event: 'interruption:abc': the length is no number of seconds up to a day"},
           {"0,0,0,0,0,0,1,1,,interruption:",
            "line 2: column event: 'interruption:': the length is no number of seconds up to a day"},
           {"0,0,0,0,0,0,1,1,,interruption:-1",
            "line 2: column event: 'interruption:-1': the length is no number of seconds up to a day"},
           {"0,0,0,0,0,0,1,1,,interruption:1.0x",
            "line 2: column event: 'interruption:1.0x': the length is no number of seconds up to a day"},
           {"0,0,0,0,0,0,1,1,,interruption:inf",
            "line 2: column event: 'interruption:inf': the length is no number of seconds up to a day"},
           {"0,0,0,0,0,0,1,1,,interruption:1e308",
            "line 2: column event: 'interruption:1e308': the length is no number of seconds up to a day"},
           {"0,0,0,0,0,0,1,1,,puncture", "line 2: column event: 'puncture': the name is missing"},
           {"0,0,0,0,0,0,1,1,,puncture:", "line 2: column event: 'puncture:': the name is missing"},
           {"0,0,0,0,0,0,1,1,,puncture:skin;", "line 2: column event: '': an event is empty"},
           {"0,0,0,0,0,0,1,1,,puncture:skin;;enter:liver", "line 2: column event: '': an event is empty"},
           {"0,0,0,0,0,0,1,1,,puncure:skin", "line 2: column event: 'puncure:skin': there is no such event"},
           {"0,0,0,0,0,0,1,1,,start", "line 2: column event: 'start': there is no such event"},
           {"0,0,0,0,0,0,1,1,,limit:speed", "line 2: column event: 'limit:speed': there is no such limit"},
           {"0,0,0,0,0,0,1,1,,set:skin.fp", "line 2: column event: 'set:skin.fp': it is not set:NAME=VALUE"},
           {"0,0,0,0,0,0,1,1,,damaged:9-3", "line 2: column event: 'damaged:9-3': it is not damaged:FIRST-LAST"},
           {"0,0,0,0,0,0,1,1,,incomplete:1", "line 2: column event: 'incomplete:1': it has no value"},
           {"0,0,0,0,0,0,1,1,,puncture:a;puncture:b;puncture:c;puncture:d;puncture:e",
            "line 2: column event: more than 4 punctures in a row"},
           {"0,0,0,0,0,0,1,1,,\"puncture:skin", "a quotation does not end"},
           {"0,\"0\"1,0,0,0,0,1,1,,", "text after a quotation"},
           {"0,0,0,0,0,0,1,1,,puncture:\"skin\"", "a quotation mark inside of a field"},
       })
    EXPECT_EQ(refused(header + c.row + "\n"), c.what) << c.row;
  EXPECT_EQ(refused("time_s;tip_x_mm\n0;0\n"), "line 1: missing column time_s");
  EXPECT_EQ(refused("time_s,tip_x_mm,tip_x_m,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z\n"),
            "line 1: columns tip_x_mm and tip_x_m are the same");
}

// What trocar session export writes.
TEST_F(PoseCsv, ReadsEveryEventOfASession) {
  const auto all = moments(
      "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,event\n"
      "0,0,0,0,0,0,1,set:skin.fp=6;set:liver.k=0.5\n1,0,0,0,0,0,1,interruption:0.000;puncture:skin;enter:#7;limit:"
      "force\n"
      "2,0,0,0,0,0,1,limit:unknown;pain:rib\n3,0,0,0,0,0,1,damaged:500-999;incomplete\n");
  ASSERT_EQ(all.size(), 4u);
  EXPECT_FALSE(all[0].is_paused);
  EXPECT_TRUE(all[1].is_paused);
  EXPECT_EQ((*all[1].events)[0].kind, telemetry::EventKind::kPuncture);
}

TEST_F(PoseCsv, RefusesAnInvalidRotation) {
  EXPECT_EQ(refused("time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,probe_x_mm,probe_y_mm,probe_z_mm,probe_qw,"
                    "probe_qx,probe_qy,probe_qz\n0,0,0,0,0,0,1,0,0,0,2,0,0,0\n"),
            "line 2: column probe_qw: the quaternion's length is not 1");
}

TEST_F(PoseCsv, RefusesAHugeFileBeforeReadingIt) {
  std::ofstream(file_) << kHeader;
  std::filesystem::resize_file(file_, (256ULL << 20) + 1);
  const auto table = PoseTable::read(file_);
  ASSERT_FALSE(table);
  EXPECT_EQ(PoseTable::read(folder_ / "missing.csv").error().exit_status, 1);
}

TEST_F(PoseCsv, HostileTextIsRefusedOrRead) {
  const std::string header = kHeader;
  const auto expect_refused = [&](const std::string& text) { EXPECT_FALSE(read(text)) << text.substr(0, 60); };
  expect_refused(std::string(4, '\0'));
  expect_refused("\n\n\n");
  expect_refused("\"\"\"\"\n");
  expect_refused(header + "\"\n");
  expect_refused(header + std::string(1000, ','));
  expect_refused(std::string(100000, 'a'));
  expect_refused(header + "\"0\"\"\",1,2,3,4,5,6\n");
}

}  // namespace
}  // namespace trocar::metrics
