// One patient in every file format and frame: volumes, planned path and forces must not depend on how it is stored.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "anatomy/label_statistics.h"
#include "cases/force_curve.h"
#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "dicom/testing/segmentation_writer.h"
#include "haptics/haptic_scene.h"
#include "io/image/image_file.h"
#include "io/patient/build_from_files.h"
#include "patient_builder/build_patient.h"
#include "phantom/phantom.h"
#include "tasks/assess_path.h"
#include "tasks/plan.h"
#include "volume/resample.h"
#include "volume/test/make_grids.h"

namespace trocar::testing {
namespace {
namespace fs = std::filesystem;

/// The scan that all files are made from: the embedded abdomen at about 3 mm.
struct Scan {
  volume::CtGrid ct;
  volume::LabelGrid labels;
  anatomy::LabelTable table;
};

const Scan& scan() {
  static const Scan made = [] {
    const auto patient = phantom::generate_phantom("abdomen", 1, {{133, 105, 90}});
    TROCAR_CHECK(patient.has_value());
    return Scan{patient->ct, patient->labels, patient->label_table};
  }();
  return made;
}

/// What the user gets from a patient.
struct Outcome {
  std::map<std::string, double> volumes_ml;
  std::set<std::string> derived;
  std::set<std::string> cut;  ///< Structures at the border of the volume.
  cases::Case prepared;
  Segment path_P{Vec3::Zero(), Vec3::Zero()};
  Segment clear_P{Vec3::Zero(), Vec3::Zero()};  ///< Of several safe paths the one with the most room.
  std::shared_ptr<const haptics::HapticScene> scene;
  anatomy::TissueTable tissues;
  std::vector<std::string> warnings;
};

Result<Outcome> outcome_of(const fs::path& ct, const fs::path& labels, const fs::path& map) {
  Outcome outcome;
  TROCAR_TRY(anatomy::VirtualPatient built,
             io::build_from_files({ct, {labels}, map.string(), "stored"}, outcome.warnings));
  for (const anatomy::LabelStatistics& label : anatomy::label_statistics(built)) {
    const std::string& name = built.label_table.find(label.id)->name;
    outcome.volumes_ml[name] = label.volume_ml;
    if (built.label_table.find(label.id)->is_derived) outcome.derived.insert(name);
    if (label.touches_border) outcome.cut.insert(name);
  }
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(built));
  TROCAR_TRY(const cases::Case prepared, cases::prepare_case(patient, {}));
  outcome.path_P = prepared.plan.line_P;
  TROCAR_TRY(const auto paths, tasks::plan_paths(prepared.task, *patient, prepared.needle, {8, 1}));
  outcome.clear_P = std::ranges::max_element(paths, {}, &tasks::PlannedPath::spare_margin_mm)->line_P;
  outcome.prepared = prepared;
  outcome.tissues = prepared.tissues;
  haptics::HapticOptions options;
  options.has_weight_compensation = false;
  TROCAR_TRY(outcome.scene, haptics::make_haptic_scene(patient, prepared.tissues, {}, {}, options));
  return outcome;
}

class Invariance : public ::testing::Test {
 protected:
  static inline const TemporaryFolder* folder = nullptr;
  static inline const Outcome* expected = nullptr;

  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    std::ofstream map(*folder / "map.toml");
    map << "[labels]\n";
    for (const anatomy::Label& label : scan().table.labels) map << fmt::format("{} = \"{}\"\n", label.id, label.name);
    map.close();
    auto outcome = stored("lps.nrrd", scan().ct, scan().labels);
    ASSERT_TRUE(outcome.has_value()) << outcome.error().text();
    expected = new Outcome(*std::move(outcome));
  }
  static void TearDownTestSuite() {
    delete expected;
    delete folder;
    expected = nullptr;
    folder = nullptr;
  }

  static Result<Outcome> stored(const std::string& name, const volume::CtGrid& ct, const volume::LabelGrid& labels) {
    TROCAR_TRY_STATUS(io::write_image(ct, *folder / ("ct_" + name)));
    TROCAR_TRY_STATUS(io::write_image(labels, *folder / ("labels_" + name)));
    return outcome_of(*folder / ("ct_" + name), *folder / ("labels_" + name), *folder / "map.toml");
  }

  /// The forces of a needle on the expected path. Interpolation moves the borders of tissues by a part of a voxel.
  static void expect_same_forces(const Outcome& outcome, double depth_mm, double share) {
    cases::PrescribedMotion motion;
    motion.line_P = expected->clear_P;
    motion.after_mm = 10.0;
    const auto want = cases::find_curve_events(cases::force_curve(*expected->scene, motion), expected->tissues);
    const auto got = cases::find_curve_events(cases::force_curve(*outcome.scene, motion), outcome.tissues);
    ASSERT_GE(want.size(), 3U);  // skin, muscle, capsule; a derived peritoneum before it
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t n = 0; n < want.size(); ++n) {
      EXPECT_EQ(got[n].layer, want[n].layer);
      const double layer_mm = want[n].layer == "peritoneum" ? 2.0 * depth_mm : depth_mm;  // derived: one voxel thick
      EXPECT_NEAR(got[n].way_mm, want[n].way_mm, layer_mm) << want[n].layer;
      EXPECT_NEAR(got[n].peak_n, want[n].peak_n, share * want[n].peak_n) << want[n].layer;
    }
  }

  /// The same voxels at the same places: rounding of the files only (NIfTI stores places as 32-bit floats).
  static void expect_equal(const Result<Outcome>& outcome) {
    ASSERT_TRUE(outcome.has_value()) << outcome.error().text();
    constexpr double kFloat_mm = 1e-3;
    for (const auto& [name, ml] : expected->volumes_ml) {
      ASSERT_TRUE(outcome->volumes_ml.contains(name)) << name;
      // Derived structures end at distances in mm: rounding moves some voxels of their ends.
      const double share = outcome->derived.contains(name) ? 0.01 : 1e-3;
      EXPECT_NEAR(outcome->volumes_ml.at(name), ml, share * ml) << name;
    }
    EXPECT_LT((outcome->path_P.a - expected->path_P.a).norm(), kFloat_mm);
    EXPECT_LT((outcome->path_P.b - expected->path_P.b).norm(), kFloat_mm);
    expect_same_forces(*outcome, kFloat_mm + 0.01, 1e-3);
  }
};

TEST_F(Invariance, RasAndLpsFilesGiveOnePatient) {
  expect_equal(stored("ras.nii.gz", scan().ct, scan().labels));  // NIfTI is RAS
  expect_equal(stored("lps.mha", scan().ct, scan().labels));
}

TEST_F(Invariance, PermutedAndFlippedFilesGiveOnePatient) {
  int number = 0;
  for (const auto& [axis, is_turned] :
       {std::pair<std::array<std::size_t, 3>, std::array<bool, 3>>{{0, 2, 1}, {false, true, false}},
        {{1, 2, 0}, {false, false, true}},
        {{0, 1, 2}, {true, false, true}}}) {
    const std::string ending = number++ % 2 == 0 ? "nrrd" : "nii";
    expect_equal(stored(fmt::format("order_{}.{}", number, ending), volume::stored_in_order(scan().ct, axis, is_turned),
                        volume::stored_in_order(scan().labels, axis, is_turned)));
  }
}

TEST_F(Invariance, DicomSlicesGiveOnePatient) {
  // Every slice as a file, and the labels as DICOM SEG with a frame for each slice of each structure.
  const volume::GridGeometry& g = scan().ct.geometry;
  const fs::path ct = *folder / "dicom";
  CtSeries series;
  series.columns = static_cast<int>(g.size[0]);
  series.rows = static_cast<int>(g.size[1]);
  ASSERT_NEAR(g.spacing_mm.x(), g.spacing_mm.y(), 1e-9);
  series.spacing_mm = g.spacing_mm.x();
  TestSeg seg;
  seg.columns = series.columns;
  seg.rows = series.rows;
  seg.spacing_mm = series.spacing_mm;
  for (const anatomy::Label& label : scan().table.labels) seg.segments.push_back(segment_item(label.id, label.name));
  std::vector<Vec3> origins_P;
  for (std::int64_t k = 0; k < g.size[2]; ++k) {
    origins_P.push_back(g.centre_mm({0, 0, k}));
    const std::uint8_t* slice = scan().labels.voxels.data() + g.offset({0, 0, k});
    for (const anatomy::Label& label : scan().table.labels)
      if (std::count(slice, slice + g.size[0] * g.size[1], label.id) > 0)
        seg.frames.push_back({label.id, origins_P.back(), [slice, &g, id = label.id](int i, int j) {
                                return slice[j * g.size[0] + i] == id ? 1 : 0;
                              }});
  }
  std::rotate(seg.frames.begin(), seg.frames.begin() + 17, seg.frames.end());  // in any order
  write_slices(ct, series, origins_P, [&](const Vec3& p_P) {
    const Vec3 index = g.to_index(p_P);
    return scan().ct[{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())}];
  });
  write_dicom(*folder / "labels.dcm", seg_elements(seg));
  expect_equal(outcome_of(ct, *folder / "labels.dcm", *folder / "map.toml"));
}

TEST_F(Invariance, ObliqueVolumeMatchesWithinInterpolation) {
  // The scan turned by 15 degrees about an oblique axis, on a grid of 2 mm that holds it.
  volume::GridGeometry oblique;
  oblique.R_PV = Eigen::AngleAxisd(radians(15.0), Vec3(1, 2, 3).normalized()).toRotationMatrix();
  oblique.spacing_mm.setConstant(2.0);
  const volume::GridGeometry& g = scan().ct.geometry;
  Vec3 low = Vec3::Constant(HUGE_VAL);
  Vec3 high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at =
        (Vec3(corner & 1, corner >> 1 & 1, corner >> 2).array() * volume::to_vec3(g.size).array() - 0.5).matrix();
    low = low.cwiseMin(oblique.R_PV.transpose() * g.to_mm(at));
    high = high.cwiseMax(oblique.R_PV.transpose() * g.to_mm(at));
  }
  oblique.origin_P = oblique.R_PV * low;
  for (int axis = 0; axis < 3; ++axis)
    oblique.size[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>((high - low)[axis] / 2.0);
  const auto outcome = stored("oblique.nrrd", volume::resample_linear(scan().ct, oblique, -1000),
                              volume::resample_nearest(scan().labels, oblique, 0));
  ASSERT_TRUE(outcome.has_value()) << outcome.error().text();
  // Borders of structures move by a part of a voxel. Those cut by the border of the scan lie beside padding here, and
  // fat and muscle are found in what is left.
  constexpr double kSmallest_ml = 5.0;
  constexpr double kVolume = 0.03;
  for (const auto& [name, ml] : expected->volumes_ml) {
    if (ml < kSmallest_ml || scan().table.find(name) == nullptr || expected->cut.contains(name)) continue;
    ASSERT_TRUE(outcome->volumes_ml.contains(name)) << name;
    EXPECT_NEAR(outcome->volumes_ml.at(name), ml, kVolume * ml) << name;
  }
  // The path of the scan is as good here, to a voxel; another one that costs almost the same may be chosen.
  constexpr double kVoxel_mm = 3.0;
  const cases::Case& here = outcome->prepared;
  const tasks::PlannedPath& wanted = expected->prepared.plan;
  const tasks::PlannedPath found = tasks::assess_path(here.task, *here.patient, here.needle, wanted.line_P).path;
  EXPECT_NEAR(found.length_mm, wanted.length_mm, kVoxel_mm);
  EXPECT_NEAR(found.organ_path_mm, wanted.organ_path_mm, kVoxel_mm);
  EXPECT_NEAR(found.spare_margin_mm, wanted.spare_margin_mm, kVoxel_mm);
  EXPECT_NEAR(here.plan.cost_mm, wanted.cost_mm, 3.8 * kVoxel_mm);  // what a voxel of room is worth: path_cost_mm
  // Half a voxel of the scan in depth, a whole one where a derived layer of one voxel begins; the peaks have 5 % of
  // friction in them, which depends on the depth.
  expect_same_forces(*outcome, 1.5, 0.05);
}

}  // namespace
}  // namespace trocar::testing
