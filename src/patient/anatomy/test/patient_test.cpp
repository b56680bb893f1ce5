#include "anatomy/patient.h"

#include <gtest/gtest.h>

#include <limits>

namespace trocar::anatomy {
namespace {

VirtualPatient small_patient() {
  volume::GridGeometry geometry;
  geometry.size = {4, 5, 6};
  geometry.spacing_mm = {0.743, 0.8, 1.6};
  geometry.origin_P = {-100.25, 20.5, -7.0};
  VirtualPatient patient;
  patient.ct = volume::CtGrid(geometry, 40);
  patient.labels = volume::LabelGrid(geometry, 0);
  patient.labels[{1, 2, 3}] = 4;
  patient.label_table.labels = {{4, "liver", "liver", {150, 70, 50}}};
  return patient;
}

TEST(PatientHash, ChangesWithEveryPartOfTheContent) {
  const VirtualPatient patient = small_patient();
  const std::string hash = hash_patient(patient);
  EXPECT_EQ(hash.size(), 32u);
  EXPECT_EQ(hash_patient(small_patient()), hash);
  const auto changed = [&](auto&& change) {
    VirtualPatient other = small_patient();
    change(other);
    return hash_patient(other) != hash;
  };
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.ct.voxels.back() = 41; }));
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.labels.voxels.front() = 4; }));
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.ct.geometry.spacing_mm[2] = 1.61; }));
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.labels.geometry.origin_P[0] += 0.01; }));
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.label_table.labels[0].tissue = "spleen"; }));
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.label_table.labels[0].name = "Liver"; }));
  EXPECT_TRUE(changed([](VirtualPatient& p) { p.label_table.labels[0].color[1] = 71; }));
}

TEST(PatientHash, IgnoresTheNameAndDigitsLostInAFile) {
  const std::string hash = hash_patient(small_patient());
  VirtualPatient other = small_patient();
  other.name = "other";
  other.ct.geometry.spacing_mm[0] += 1e-15;
  other.ct.geometry.R_PV(0, 1) = -1e-17;
  EXPECT_EQ(hash_patient(other), hash);
}

TEST(PatientHash, SeparatesTexts) {
  VirtualPatient a = small_patient();
  VirtualPatient b = small_patient();
  a.label_table.labels[0].name = "liv";
  a.label_table.labels[0].tissue = "er";
  b.label_table.labels[0].name = "live";
  b.label_table.labels[0].tissue = "r";
  EXPECT_NE(hash_patient(a), hash_patient(b));
}

TEST(FindLabel, GivesTheNearestVoxelsLabel) {
  const VirtualPatient patient = small_patient();
  const volume::GridGeometry& geometry = patient.labels.geometry;
  const Label* label = find_label(patient, geometry.to_mm({1.4, 1.6, 3.4}));
  ASSERT_NE(label, nullptr);
  EXPECT_EQ(label->name, "liver");
  EXPECT_EQ(find_label(patient, geometry.to_mm({1.6, 2.0, 3.0})), nullptr);
  EXPECT_EQ(find_label(patient, geometry.to_mm({-3.0, 2.0, 3.0})), nullptr);
  EXPECT_EQ(find_label(patient, Vec3::Constant(std::numeric_limits<double>::quiet_NaN())), nullptr);
}

}  // namespace
}  // namespace trocar::anatomy
