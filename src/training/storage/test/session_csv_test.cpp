#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "core/files/output_file.h"
#include "core/text.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

using testing::example_info;
using testing::example_sample;

/// The columns as promised to scripts: spelled out here on purpose.
constexpr const char* kHeader =
    "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,axial_velocity_mm_s,depth_mm,tissue,phase,"
    "layer_displacement_mm,f_prepuncture_n,f_friction_n,f_cutting_n,f_constraint_x_n,f_constraint_y_n,f_constraint_z_n,"
    "f_weight_x_n,f_weight_y_n,f_weight_z_n,f_total_x_n,f_total_y_n,f_total_z_n,tau_x_nmm,tau_y_nmm,tau_z_nmm,event,"
    "limited,breathing,f_tip_proxy_x_n,f_tip_proxy_y_n,f_tip_proxy_z_n,f_body_axial_n,f_stick_n,device_x_mm,"
    "device_y_mm,device_z_mm,device_f_x_n,device_f_y_n,device_f_z_n,device_tau_x_nmm,device_tau_y_nmm,device_tau_z_nmm,"
    "gate_mode,gate_fault,gate_scale,coupling_share,rest_tip_x_mm,rest_tip_y_mm,rest_tip_z_mm,rest_axis_x,rest_axis_y,"
    "rest_axis_z,breath_held";

Session example_session(std::size_t ticks) {
  Session session;
  session.info = example_info();
  for (std::size_t n = 0; n < ticks; ++n) session.samples.push_back(example_sample(n));
  return session;
}

std::vector<std::vector<std::string>> exported_rows(const Session& session) {
  const TemporaryFolder folder;
  EXPECT_TRUE(export_csv(session, folder / "s.csv"));
  std::istringstream text(*read_file(folder / "s.csv"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(text, line);) {
    std::istringstream fields(line);
    auto& row = rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
  }
  return rows;
}

TEST(SessionCsv, HasTheDocumentedHeaderAndOneRowPerTick) {
  const TemporaryFolder folder;
  ASSERT_TRUE(export_csv(example_session(321), folder / "s.csv"));
  const std::string text = *read_file(folder / "s.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), kHeader);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 322);
  EXPECT_TRUE(text.ends_with('\n'));
}

/// A session of somebody else: its names are no formulas of a spreadsheet.
TEST(SessionCsv, HasNoFormulas) {
  Session session = example_session(2);
  for (std::string& name : session.info.tissue_names) name = "=1+1;@x";
  const TemporaryFolder folder;
  ASSERT_TRUE(export_csv(session, folder / "s.csv"));
  const std::string text = *read_file(folder / "s.csv");
  EXPECT_NE(text.find(",'=1+1;'@x,"), std::string::npos) << text;
  EXPECT_EQ(text.find(",=1"), std::string::npos);
}

TEST(SessionCsv, PutsEachFieldUnderItsName) {
  const Session session = example_session(4);
  const auto rows = exported_rows(session);
  ASSERT_EQ(rows.size(), 5u);
  const telemetry::TickSample& s = session.samples[3];
  const auto field = [&](const std::string& name) {
    for (std::size_t c = 0; c < rows[0].size(); ++c)
      if (rows[0][c] == name) return rows[4][c];
    return "no column " + name;
  };
  const auto number = [&](const std::string& name) { return parse_number<double>(field(name)).value_or(std::nan("")); };
  EXPECT_EQ(number("time_s"), s.time_s);
  EXPECT_EQ(number("tip_z_mm"), s.tip_mm.z());
  EXPECT_EQ(number("axis_y"), s.axis.y());
  EXPECT_EQ(number("axial_velocity_mm_s"), s.axial_velocity_mm_s);
  EXPECT_EQ(number("depth_mm"), s.depth_mm);
  EXPECT_EQ(field("tissue"), "muscle");
  EXPECT_EQ(field("phase"), "retracting");
  EXPECT_EQ(number("layer_displacement_mm"), s.layer_displacement_mm);
  EXPECT_EQ(number("f_prepuncture_n"), s.f_prepuncture_n);
  EXPECT_EQ(number("f_friction_n"), s.f_friction_n);
  EXPECT_EQ(number("f_cutting_n"), s.f_cutting_n);
  EXPECT_EQ(number("f_constraint_x_n"), s.f_constraint_n.x());
  EXPECT_EQ(number("f_weight_y_n"), s.f_weight_n.y());
  EXPECT_EQ(number("f_total_z_n"), s.f_total_n.z());
  EXPECT_EQ(number("tau_x_nmm"), s.tau_nmm.x());
  EXPECT_EQ(field("event"), "puncture:liver_capsule;enter:liver;limit:torque");
  EXPECT_EQ(field("limited"), "0");
  EXPECT_EQ(number("breathing"), s.breathing);
  EXPECT_EQ(number("f_tip_proxy_x_n"), s.f_tip_proxy_n.x());
  EXPECT_EQ(number("f_body_axial_n"), s.f_body_axial_n);
  EXPECT_EQ(number("f_stick_n"), s.f_stick_n);
  EXPECT_EQ(number("device_y_mm"), s.device_mm.y());
  EXPECT_EQ(number("device_f_z_n"), s.device_f_n.z());
  EXPECT_EQ(number("device_tau_x_nmm"), s.device_tau_nmm.x());
  EXPECT_EQ(field("gate_mode"), "on");
  EXPECT_EQ(field("gate_fault"), "device_silent");
  EXPECT_EQ(number("gate_scale"), s.gate_scale);
  EXPECT_EQ(number("coupling_share"), s.coupling_share);
}

TEST(SessionCsv, RoundTripsNumbers) {
  Session session = example_session(1);
  session.samples[0].tip_mm = {0.1, 1e-310, 123456789.123456789};
  session.samples[0].depth_mm = std::numeric_limits<double>::quiet_NaN();
  session.samples[0].f_stick_n = -std::numeric_limits<double>::infinity();
  const auto rows = exported_rows(session);
  EXPECT_EQ(rows[1][1], "0.1");
  EXPECT_EQ(parse_number<double>(rows[1][2]), 1e-310);
  EXPECT_EQ(parse_number<double>(rows[1][3]), 123456789.123456789);
  EXPECT_EQ(rows[1][8], "nan");
  EXPECT_EQ(rows[1][34], "-inf");
}

TEST(SessionCsv, QuotesNamesWithCommas) {
  Session session = example_session(1);
  session.info.tissue_names[0] = "air, \"dry\"";
  const TemporaryFolder folder;
  ASSERT_TRUE(export_csv(session, folder / "s.csv"));
  EXPECT_NE(read_file(folder / "s.csv")->find(",\"air, \"\"dry\"\"\","), std::string::npos);
}

TEST(SessionCsv, WritesTheNumberOfAnUnknownId) {
  SessionInfo info = example_info();
  telemetry::TickSample sample;
  sample.events[0] = {telemetry::EventKind::kPuncture, 200};
  EXPECT_EQ(event_text(info, sample), "puncture:#200");
}

TEST(SessionCsv, LeavesNoPartialFile) {
  const TemporaryFolder folder;
  EXPECT_FALSE(export_csv(example_session(3), folder.path()));  // A folder stands in the way.
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace trocar::storage
