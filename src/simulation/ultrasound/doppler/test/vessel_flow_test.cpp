#include "ultrasound/doppler/vessel_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "ultrasound/doppler/test/tube_patient.h"

namespace trocar::ultrasound {
namespace {

using testing::make_steady_table;
using testing::make_tube_patient;

constexpr double kArc_mm = 40.0;
constexpr double kTube_mm = 6.0;

FlowTable shipped_table() {
  const auto table = load_flow_table(data_dir() / "flow.toml");
  EXPECT_TRUE(table.has_value()) << table.error().text();
  return *table;
}

/// Half a ring about the x axis, open to the back: its ends at z = +-40.
bool is_in_half_ring(const Vec3& p) {
  const double from_axis = std::hypot(p.y(), p.z());
  return p.y() < 0.0 && std::hypot(p.x(), from_axis - kArc_mm) < kTube_mm;
}

std::shared_ptr<const VesselFlow> ring_flow(const Vec3& spacing_mm) {
  const anatomy::VirtualPatient patient =
      make_tube_patient(Vec3(30, 110, 110), spacing_mm, {{"tube", is_in_half_ring}});
  const auto flow = make_vessel_flow(patient, make_steady_table(50.0, 2.0));
  EXPECT_TRUE(flow.has_value()) << flow.error().text();
  return *flow;
}

const VesselFlow& abdomen_flow() {
  static const std::shared_ptr<const VesselFlow> kFlow =
      *make_vessel_flow(*phantom::generate_phantom("abdomen", 1, {{190, 150, 120}}), shipped_table(), {1.6, 100.0});
  return *kFlow;
}

/// Direction of what flows at a point of the abdomen, at the peak of its waveform.
Vec3 peak_flow(const Vec3& p_P) {
  Vec3 fastest = Vec3::Zero();
  for (double time_s = 0.0; time_s < 0.86; time_s += 0.02) {
    const Vec3 velocity = abdomen_flow().velocity_A(p_P, time_s, 0.0);
    if (velocity.norm() > fastest.norm()) fastest = velocity;
  }
  return fastest;
}

TEST(VesselFlow, FollowsTheMiddleOfABentTube) {
  for (const Vec3& spacing_mm : {Vec3(1, 1, 1), Vec3(0.8, 0.8, 2.5)}) {
    const auto flow = ring_flow(spacing_mm);
    ASSERT_EQ(flow->branches().size(), 1U);
    const std::vector<VesselPoint>& points = flow->branches()[0].points;
    // Half the ring less one radius at either end.
    EXPECT_GT(points.size(), 70U);
    for (const VesselPoint& point : points) {
      const double from_axis = std::hypot(point.p_P.y(), point.p_P.z());
      // Half a voxel, and what smoothing takes off the bend: sigma²/(2 R) = 0.2 mm.
      EXPECT_NEAR(std::hypot(point.p_P.x(), from_axis - kArc_mm), 0.0, 0.5 * spacing_mm.maxCoeff() + 0.25);
      const Vec3 tangent(0.0, -point.p_P.z() / from_axis, point.p_P.y() / from_axis);
      EXPECT_GT(tangent.dot(point.flow_P), std::cos(0.15)) << point.p_P.transpose();  // from the head round to the feet
      // The distance to a label's surface is short by up to half a voxel, and the middle lies between voxels.
      // Near the ends the nearest wall is the end's.
      if (point.p_P.y() < -8.0) {
        EXPECT_NEAR(point.radius_mm, kTube_mm, 0.5 * spacing_mm.maxCoeff() + 0.6);
      }
    }
  }
}

TEST(VesselFlow, HasAParabolaAcrossTheLumen) {
  const auto flow = ring_flow(Vec3(1, 1, 1));
  for (const double angle : {-0.8, 0.0, 0.7}) {
    const Vec3 outwards(0.0, -std::cos(angle), std::sin(angle));
    for (const double rho : {0.0, 0.5, 0.8}) {
      const double speed = flow->velocity_A((kArc_mm + rho * kTube_mm) * outwards, 0.0, 0.0).norm();
      // A voxel of 0.8 mm is a seventh of the radius.
      EXPECT_NEAR(speed, 500.0 * (1.0 - rho * rho), 60.0) << angle << " " << rho;
    }
    EXPECT_EQ(flow->velocity_A((kArc_mm + kTube_mm + 2.0) * outwards, 0.0, 0.0), Vec3::Zero());
  }
  EXPECT_EQ(flow->velocity_A(Vec3(0, 0, 0), 0.0, 0.0), Vec3::Zero());
  EXPECT_EQ(flow->velocity_A(Vec3(1e9, 0, 0), 0.0, 0.0), Vec3::Zero());
  EXPECT_EQ(flow->velocity_A(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), 0.0, 0.0), Vec3::Zero());
}

TEST(VesselFlow, JoinsTwoSourcesIntoOneSink) {
  // As the splenic and mesenteric veins make the portal vein: only the end at the liver is named.
  const auto is_near_line = [](const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
    return distance_mm(Segment{a, b}, p) < radius;
  };
  const Vec3 meet(0, 0, 0), left(40, 0, 5), below(0, 0, -40), liver(-35, 0, 20);
  const anatomy::VirtualPatient patient =
      make_tube_patient(Vec3(110, 30, 110), Vec3(1, 1, 1),
                        {{"portal_vein_and_splenic_vein",
                          [&](const Vec3& p) {
                            return is_near_line(p, meet, left, 4.0) || is_near_line(p, meet, below, 4.5) ||
                                   is_near_line(p, meet, liver, 5.5);
                          }},
                         {"liver", [&](const Vec3& p) { return (p - Vec3(-48, 0, 28)).norm() < 12.0; }}});
  const auto flow = make_vessel_flow(patient, shipped_table());
  ASSERT_TRUE(flow.has_value()) << flow.error().text();
  EXPECT_LT((*flow)->velocity_A(0.5 * left, 0.0, 0.0).x(), -50.0);
  EXPECT_GT((*flow)->velocity_A(0.5 * below, 0.0, 0.0).z(), 50.0);
  EXPECT_LT((*flow)->velocity_A(0.5 * liver, 0.0, 0.0).x(), -50.0);
}

TEST(VesselFlow, FlowsFromTheWideEnd) {
  const auto is_near_line = [](const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
    return distance_mm(Segment{a, b}, p) < radius;
  };
  const Vec3 fork(0, 0, -25), out(45, 0, -25), up(45, 0, 52);
  const anatomy::VirtualPatient patient = make_tube_patient(
      Vec3(130, 30, 120), Vec3(1, 1, 1), {{"artery", [&](const Vec3& p) {
                                             return is_near_line(p, {0, 0, 35}, {0, 0, -50}, 8.0) ||
                                                    is_near_line(p, fork, out, 2.5) || is_near_line(p, out, up, 2.5);
                                           }}});
  const auto flow = make_vessel_flow(patient, shipped_table());
  ASSERT_TRUE(flow.has_value()) << flow.error().text();
  const double systole_s = 0.17;
  EXPECT_LT((*flow)->velocity_A(Vec3(0, 0, 10), systole_s, 0.0).z(), -500.0);
  EXPECT_GT((*flow)->velocity_A(Vec3(45, 0, 20), systole_s, 0.0).z(), 500.0);
}

TEST(VesselFlow, HasCorrectDirectionsInTheEmbeddedPatient) {
  const Vec3 aorta = peak_flow(Vec3(4.0, -4.0, -60.0));
  EXPECT_LT(aorta.z(), -700.0);
  EXPECT_GT(peak_flow(Vec3(-22.0, 4.0, -60.0)).z(), 150.0);  // inferior vena cava, below the renal veins
  EXPECT_GT(peak_flow(Vec3(-25.0, 3.0, 35.0)).z(), 150.0);   // behind the liver
  const Vec3 splenic = peak_flow(Vec3(44.0, -3.0, 14.0));
  EXPECT_LT(splenic.x(), 0.0);  // from the spleen to the middle
  for (const VesselBranch& branch : abdomen_flow().branches()) {
    if (branch.rule != "hepatic_veins" && branch.rule != "portal_branches") continue;
    // Thick parts of the trees: to the vena cava, and away from the hilum.
    for (const VesselPoint& point : branch.points) {
      if (point.radius_mm < 3.0 || !point.is_in_own_tube) continue;
      const Vec3 from_cava = point.p_P - Vec3(-24.0, -8.0, 72.0);
      const Vec3 from_hilum = point.p_P - Vec3(-36.0, -8.0, 16.0);
      if (branch.rule == "hepatic_veins" && from_cava.norm() > 25.0) {
        EXPECT_LT(point.flow_P.dot(from_cava), 0.0) << point.p_P.transpose();
      }
      if (branch.rule == "portal_branches" && from_hilum.norm() > 15.0) {
        EXPECT_GT(point.flow_P.dot(from_hilum), 0.0) << point.p_P.transpose();
      }
    }
  }
}

TEST(VesselFlow, PulsesInArteriesAndIsSteadyInPortalVein) {
  const FlowTable table = shipped_table();
  const auto range = [&](const char* label) {
    const FlowRule* rule = table.find(label, anatomy::LabelTable{});
    EXPECT_NE(rule, nullptr) << label;
    double low = 1e9, high = -1e9;
    for (double time_s = 0.0; time_s < 20.0; time_s += 0.01) {
      const double value = table.waveforms[rule->waveform].at(time_s, table.heart_per_min, 0.0);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return std::pair(low, high);
  };
  EXPECT_LT(range("aorta").first, 0.0);  // reversed after systole
  EXPECT_NEAR(range("aorta").second, 1.0, 0.05);
  EXPECT_GT(range("portal_vein_and_splenic_vein").first, 0.7);
  EXPECT_LT(range("hepatic_veins").first, -0.2);  // the a-wave
  EXPECT_GT(range("renal_artery_left").first, 0.3);
}

TEST(FlowWaveform, IsPeriodicAndContinuous) {
  const FlowWaveform waveform{"saw", {0.0, 1.0, 0.5, 0.2}, 0.0};
  EXPECT_NEAR(waveform.at(0.25, 60.0, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(waveform.at(0.875, 60.0, 0.0), 0.1, 1e-12);  // on the way back to the first
  for (const double time_s : {0.1, 0.4, 0.99}) {
    EXPECT_NEAR(waveform.at(time_s, 60.0, 0.0), waveform.at(time_s + 3.0, 60.0, 0.0), 1e-9);
    EXPECT_NEAR(waveform.at(time_s, 60.0, 0.0), waveform.at(time_s - 2.0, 60.0, 0.0), 1e-9);
  }
}

TEST(FlowTable, SelectsARuleByAdjacentVessels) {
  const FlowTable table = shipped_table();
  anatomy::LabelTable with_trunk;
  with_trunk.labels = {{1, "portal_vein_and_splenic_vein", "vessel", {}}, {2, "portal_vein", "vessel", {}}};
  EXPECT_EQ(table.find("portal_vein", with_trunk)->name, "portal_branches");
  EXPECT_EQ(table.find("portalvein", anatomy::LabelTable{})->name, "portal_trunk");  // as 3D-IRCADb has it
  EXPECT_EQ(table.find("Inferior Vena-Cava", anatomy::LabelTable{})->name, "inferior_vena_cava");
  EXPECT_EQ(table.find("liver", anatomy::LabelTable{}), nullptr);
}

TEST(VesselFlow, NamesVesselsWithoutFlow) {
  const anatomy::VirtualPatient patient =
      make_tube_patient(Vec3(30, 110, 110), Vec3(1, 1, 1), {{"vitelline duct", is_in_half_ring}});
  const auto flow = make_vessel_flow(patient, shipped_table());
  ASSERT_FALSE(flow.has_value());
  EXPECT_NE(flow.error().text().find("vitelline duct"), std::string::npos);
}

}  // namespace
}  // namespace trocar::ultrasound
