// The order in which a CT and its labels are stored must not matter: not for the patient, the path or the forces.

#include <gtest/gtest.h>

#include "anatomy/label_statistics.h"
#include "attempt.h"
#include "core/testing/test_data.h"
#include "io/image/image_file.h"
#include "io/patient/label_sources.h"
#include "patient_builder/build_patient.h"
#include "patient_builder/test/make_torso.h"
#include "volume/test/make_grids.h"

namespace trocar::testing {
namespace {
namespace fs = std::filesystem;

/// A CT and its segmentation, and the two stored in another order.
struct Volumes {
  volume::CtGrid ct;
  std::vector<patient_builder::LabelSource> sources;

  Volumes stored(const std::array<std::size_t, 3>& axis, const std::array<bool, 3>& is_turned) const {
    Volumes other{stored_in_order(ct, axis, is_turned), sources};
    for (patient_builder::LabelSource& source : other.sources)
      source.labels = stored_in_order(source.labels, axis, is_turned);
    return other;
  }
};

Result<cases::Case> case_of(const Volumes& volumes) {
  std::vector<std::string> warnings;
  TROCAR_TRY(anatomy::VirtualPatient patient,
             patient_builder::build_patient(volumes.ct, volumes.sources, {"stored", {"test"}}, warnings));
  return cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(patient)), {});
}

constexpr double kRounding_mm = 1e-6;
constexpr double kRounding_n = 1e-6;

/// The same patient, path and forces as those of the axial volumes. An attempt that led the needle once.
void expect_same(const cases::Case& axial, const Attempt& expected, const Volumes& volumes) {
  const auto prepared = case_of(volumes);
  ASSERT_TRUE(prepared.has_value()) << prepared.error().text();
  EXPECT_EQ(prepared->patient->labels.voxels, axial.patient->labels.voxels);
  EXPECT_EQ(prepared->patient->skin_distance_mm.voxels, axial.patient->skin_distance_mm.voxels);
  EXPECT_LT((prepared->plan.line_P.a - axial.plan.line_P.a).norm(), kRounding_mm);
  EXPECT_LT((prepared->plan.line_P.b - axial.plan.line_P.b).norm(), kRounding_mm);
  const Attempt attempt = perform(*prepared, "constant-velocity:50");
  ASSERT_EQ(attempt.session.samples.size(), expected.session.samples.size());
  double largest_n = 0.0;
  for (std::size_t i = 0; i < expected.session.samples.size(); ++i)
    largest_n =
        std::max(largest_n, (attempt.session.samples[i].f_total_n - expected.session.samples[i].f_total_n).norm());
  EXPECT_LT(largest_n, kRounding_n);
}

TEST(StorageOrder, DoesNotMatterForPathAndForces) {
  const volume::CtGrid ct = patient_builder::Torso().ct(patient_builder::Torso::grid({6, 5, 8}));
  const patient_builder::LabelSource liver{
      "liver.nii.gz",
      patient_builder::Torso::mask(patient_builder::Torso::grid({6, 5, 8}), patient_builder::Torso::is_liver),
      {{1, "liver"}}};
  const Volumes volumes{ct, {liver}};
  const auto axial = case_of(volumes);
  ASSERT_TRUE(axial.has_value()) << axial.error().text();
  const Attempt expected = perform(*axial, "constant-velocity:50");
  EXPECT_FALSE(expected.result.punctures.empty());
  volume::for_each_storage_order(
      [&](const auto& axis, const auto& is_turned) { expect_same(*axial, expected, volumes.stored(axis, is_turned)); });
}

TEST(StorageOrder, DoesNotMatterForARealCt) {
  const fs::path data = test_data() / "ct-torso";
  if (!fs::exists(data)) GTEST_SKIP() << "no test data at " << data;
  auto ct = io::read_ct(data / "example_ct.nii.gz");
  auto sources = io::read_label_sources({data / "example_seg_fast_force_split.nii.gz"}, "totalsegmentator");
  ASSERT_TRUE(ct && sources);
  const Volumes volumes{*std::move(ct), *std::move(sources)};
  const auto axial = case_of(volumes);
  ASSERT_TRUE(axial.has_value()) << axial.error().text();
  double lung_ml = 0.0;
  for (const anatomy::LabelStatistics& statistics : anatomy::label_statistics(*axial->patient))
    if (axial->patient->label_table.find(statistics.id)->tissue == "lung") lung_ml += statistics.volume_ml;
  EXPECT_GT(lung_ml, 60.0);  // the scan shows the lower lobes
  const Attempt expected = perform(*axial, "constant-velocity:50");
  expect_same(*axial, expected, volumes.stored({0, 2, 1}, {false, true, false}));  // coronal
  expect_same(*axial, expected, volumes.stored({1, 2, 0}, {false, false, true}));  // sagittal, left-handed
}

}  // namespace
}  // namespace trocar::testing
