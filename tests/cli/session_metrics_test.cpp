// trocar session metrics: a session, the same as CSV, poses of another system, bad input.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

class SessionMetrics : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    session_ = *folder_ / "expert.session";
    const Outcome ran = trocar("run liver-biopsy --patient abdomen --operator expert --out '" + session_ + "'");
    ASSERT_EQ(ran.exit_status, 0) << ran.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  /// Metrics by name.
  static std::map<std::string, config::Json> metrics_of(const std::string& arguments) {
    std::map<std::string, config::Json> metrics;
    const Outcome outcome = trocar("session metrics " + arguments + " --json");
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    if (outcome.exit_status != 0) return metrics;
    const config::Json json = json_of(outcome);
    for (const config::Json& metric : json["metrics"]) metrics[metric["name"]] = metric;
    return metrics;
  }
  /// The value of a metric; NaN and a test failure if it has none.
  static double value_of(const std::map<std::string, config::Json>& metrics, const std::string& name) {
    const auto found = metrics.find(name);
    if (found != metrics.end() && found->second["value"].is_number()) return found->second["value"];
    ADD_FAILURE() << name << " has no value";
    return std::nan("");
  }
  static std::string write(const std::string& name, const std::string& text) {
    std::ofstream(*folder_ / name) << text;
    return *folder_ / name;
  }
  static void expect_refused(const std::string& arguments, const std::string& words, int exit_status = 1) {
    SCOPED_TRACE(arguments);
    cli_test::expect_refused(trocar("session metrics " + arguments), exit_status, words);
  }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline std::string session_;
};

TEST_F(SessionMetrics, ExpertBiopsyFollowsItsPath) {
  auto metrics = metrics_of("'" + session_ + "'");
  EXPECT_LT(value_of(metrics, "target_distance"), 3.0);
  EXPECT_LT(value_of(metrics, "path_distance_max"), 3.0);
  EXPECT_EQ(value_of(metrics, "skin_punctures"), 1.0);
  EXPECT_EQ(value_of(metrics, "needle_passes"), 1.0);
  EXPECT_EQ(value_of(metrics, "end_in_target"), 1.0);
  EXPECT_EQ(value_of(metrics, "risk_structures"), 0.0);
  EXPECT_GT(value_of(metrics, "force_peak"), 0.5);
  EXPECT_EQ(metrics["force_peak"]["unit"], "N");
  for (const auto& [name, metric] : metrics) EXPECT_NE(metric["value"].is_null(), !metric.contains("missing")) << name;
}

TEST_F(SessionMetrics, ExportKeepsTheMetrics) {
  const std::string csv = *folder_ / "expert.csv";
  ASSERT_EQ(trocar("session export '" + session_ + "' --csv '" + csv + "'").exit_status, 0);
  auto wanted = metrics_of("'" + session_ + "'");
  auto metrics = metrics_of("'" + csv + "' --task liver-biopsy --patient abdomen");
  for (const char* name :
       {"path_length", "time_in_tissue", "tissue_damage", "skin_punctures", "layer_punctures", "force_peak",
        "puncture_overshoot", "structures_pierced", "no_go_time", "spectral_arc_length"})
    EXPECT_EQ(value_of(metrics, name), value_of(wanted, name)) << name;
  EXPECT_EQ(metrics["plane_angle"]["missing"], "the recording has no transducer");
}

TEST_F(SessionMetrics, ComparesForeignPosesWithExpertPaths) {
  // 60 mm along +z at 20 mm/s, 3 mm beside one path and 20 mm beside the other; in metres, without depth.
  std::string rows = "time_s,tip_x_m,tip_y_m,tip_z_m,axis_x,axis_y,axis_z\n";
  for (int n = 0; n <= 300; ++n) rows += fmt::format("{},0.003,0,{},0,0,1\n", 0.01 * n, 0.0002 * n);
  const std::string poses = write("poses.csv", rows);
  const std::string paths = write("paths.mrk.json", R"({"markups": [
    {"type": "Line", "coordinateSystem": "LPS", "controlPoints": [
      {"id": "1", "label": "e", "position": [23, 0, 0]}, {"id": "2", "label": "t", "position": [23, 0, 60]}]},
    {"type": "Line", "coordinateSystem": "LPS", "controlPoints": [
      {"id": "1", "label": "e", "position": [0, 0, 0]}, {"id": "2", "label": "t", "position": [0, 0, 60]}]}]})");
  auto metrics = metrics_of("'" + poses + "' --expert '" + paths + "'");
  EXPECT_NEAR(value_of(metrics, "path_length"), 60.0, 0.001);
  EXPECT_NEAR(value_of(metrics, "elapsed_time"), 3.0, 1e-9);
  EXPECT_EQ(value_of(metrics, "expert_path"), 2.0);
  EXPECT_NEAR(value_of(metrics, "target_distance"), 3.0, 0.001);
  EXPECT_EQ(metrics["path_in_tissue"]["missing"], "the recording has no depth and no patient was given");
  EXPECT_EQ(metrics["end_in_target"]["missing"], "the recording has no depth and no patient was given");
  const Outcome text = trocar("session metrics '" + poses + "' --expert '" + paths + "'");
  EXPECT_NE(text.out.find("Path length of the tip"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("no patient was given"), std::string::npos) << text.out;
}

TEST_F(SessionMetrics, MeasuresNeedleAgainstTheRecordedImagePlane) {
  // Straight down from the face of a C5-2 to 60 mm; for the last 15 mm the plane is 20 mm beside the needle.
  std::string rows =
      "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,depth_mm,probe_x_mm,probe_y_mm,probe_z_mm,probe_qw,"
      "probe_qx,probe_qy,probe_qz,probe_contact_n\n";
  for (int n = 0; n <= 300; ++n) {
    const double depth_mm = 0.2 * n;
    rows +=
        fmt::format("{},0,{},0,0,1,0,{},0,0,{},1,0,0,0,2\n", 0.01 * n, depth_mm, depth_mm, depth_mm > 45.0 ? 20 : 0);
  }
  auto metrics = metrics_of("'" + write("in_plane.csv", rows) + "'");
  EXPECT_NEAR(value_of(metrics, "plane_angle"), 0.0, 0.03);
  EXPECT_NEAR(value_of(metrics, "plane_offset"), 0.0, 0.03);
  EXPECT_NEAR(value_of(metrics, "plane_offset_end"), 20.0, 1e-6);
  EXPECT_NEAR(value_of(metrics, "tip_visible"), 75.0, 0.5);
  EXPECT_NEAR(value_of(metrics, "probe_time"), 3.0, 1e-6);
  EXPECT_EQ(value_of(metrics, "skin_contacts"), 1.0);
}

TEST_F(SessionMetrics, ReportsBadInputInOneLine) {
  const std::string header = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z\n";
  const std::string good = write("good.csv", header + "0,0,0,0,0,0,1\n");
  expect_refused("'" + (*folder_ / "none.csv") + "'", "none.csv");
  expect_refused("'" + write("empty.csv", "") + "'", "the file is empty");
  expect_refused("'" + write("header.csv", header) + "'", "no row");
  for (const char* row : {"0,nan,nan,nan,nan,nan,nan\n", "0,0,0,0,0,0,0\n"})
    expect_refused("'" + write("no_pose.csv", header + row) + "'", "none of the 1 rows has a time");
  expect_refused("'" + session_ + "' --patient nobody", "nobody", 2);
  const Outcome other = trocar("session metrics '" + session_ + "' --patient layers-liver");  // prints its progress
  EXPECT_EQ(other.exit_status, 1);
  EXPECT_TRUE(other.out.empty()) << other.out;
  EXPECT_NE(other.err.find("error: is not the patient of the session — layers-liver"), std::string::npos) << other.err;
  expect_refused("'" + write("text.csv", header + "0,a,0,0,0,0,1\n") + "'", "line 2: column tip_x_mm");
  expect_refused("'" + write("time.csv", header + "1,0,0,0,0,0,1\n0,0,0,0,0,0,1\n") + "'", "line 3: column time_s");
  expect_refused("'" + write("cut.session", "SQLite format 3 and no more") + "'", "cut.session");
  expect_refused("'" + good + "' --task none", "none", 2);
  expect_refused("'" + good + "' --patient nobody", "nobody", 2);
  expect_refused("'" + good + "' --expert '" + good + "'", "good.csv");
  expect_refused("'" + good + "' --transducer none", "none", 2);
  for (const char* depth_mm : {"-3", "9", "nan", "401"})
    expect_refused("'" + good + "' --depth " + depth_mm, "--depth", 2);
  expect_refused("'" + folder_->path().string() + "'", folder_->path().string());
}

}  // namespace
}  // namespace trocar::cli_test
