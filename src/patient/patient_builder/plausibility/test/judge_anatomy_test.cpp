// A body of simple shapes and its segmentation: as it is, and with one thing wrong.
#include "patient_builder/plausibility/judge_anatomy.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "anatomy/label_statistics.h"
#include "patient_builder/patient_findings.h"

namespace trocar::patient_builder {
namespace {

struct Ball {
  const char* name;
  int number;  ///< In TotalSegmentator 2.
  Vec3 middle_P;
  double radius_mm;
  std::int16_t hu;
};

/// Liver on the right, spleen and stomach on the left, spine behind: sizes as in an adult.
const std::vector<Ball>& balls() {
  static const std::vector<Ball> all = {
      {"liver", 5, {-60, -20, 60}, 55, 110},      {"spleen", 1, {70, 30, 70}, 28, 120},
      {"stomach", 6, {50, -50, 60}, 25, 30},      {"kidney_left", 3, {55, 45, 0}, 24, 160},
      {"kidney_right", 2, {-55, 45, 0}, 24, 160}, {"gallbladder", 4, {-40, -60, 0}, 14, 8},
      {"aorta", 52, {12, 25, 20}, 12, 180},       {"inferior_vena_cava", 63, {-14, 25, 20}, 12, 140},
      {"pancreas", 7, {5, -10, 20}, 14, 90},      {"urinary_bladder", 21, {0, -40, -85}, 24, 5},
      {"vertebrae_L1", 31, {0, 55, 40}, 16, 260}, {"vertebrae_L2", 30, {0, 55, 5}, 16, 250},
      {"vertebrae_L3", 29, {0, 55, -30}, 16, 255}};
  return all;
}

volume::GridGeometry body_grid() {
  volume::GridGeometry g;
  g.size = {72, 54, 60};
  g.spacing_mm = {4, 4, 4};
  g.origin_P = {-142, -106, -118};
  return g;
}

/// A CT and labels numbered as TotalSegmentator 2 does; each is drawn at where(p) instead of p.
using Where = std::function<Vec3(const Vec3&)>;
const Where kHere = [](const Vec3& p_P) { return p_P; };
const Where kMirroredHere = [](const Vec3& p_P) { return Vec3(-p_P.x(), p_P.y(), p_P.z()); };

volume::CtGrid ct_at(const Where& where) {
  volume::CtGrid ct(body_grid(), -1000);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const Vec3 p_P = ct.geometry.centre_mm(ct.geometry.index_of(n));
    if (std::hypot(p_P.x() / 130.0, p_P.y() / 95.0) < 1.0) ct.voxels[n] = -90;
    const Vec3 at = where(p_P);
    for (const Ball& ball : balls())
      if ((at - ball.middle_P).norm() < ball.radius_mm) ct.voxels[n] = ball.hu;
  }
  return ct;
}

LabelSource labels_at(const Where& where, const std::vector<std::string>& without = {}) {
  LabelSource source{"labels.nii.gz", volume::LabelGrid(body_grid()), {}, false, {}};
  for (std::size_t n = 0; n < source.labels.voxels.size(); ++n) {
    const Vec3 at = where(source.labels.geometry.centre_mm(source.labels.geometry.index_of(n)));
    for (const Ball& ball : balls())
      if ((at - ball.middle_P).norm() < ball.radius_mm && std::ranges::find(without, ball.name) == without.end())
        source.labels.voxels[n] = static_cast<std::uint8_t>(ball.number);
  }
  for (const Ball& ball : balls()) source.names.emplace_back(ball.number, ball.name);
  return source;
}

struct BodyOutcome {
  Result<anatomy::VirtualPatient> patient;
  std::vector<std::string> warnings;
  std::string text() const { return patient ? "built" : patient.error().text(); }
  bool warns_of(const std::string& words) const {
    return std::ranges::any_of(warnings, [&](const auto& w) { return w.find(words) != std::string::npos; });
  }
};

BodyOutcome build_body(const volume::CtGrid& ct, LabelSource source, std::vector<std::string> confirmed = {},
                       anatomy::Posture posture = anatomy::Posture::kSupine) {
  std::vector<std::string> warnings;
  BuildOptions options;
  options.name = "test";
  options.derive = {false, {}};
  options.confirmed = std::move(confirmed);
  options.posture = posture;
  auto patient = build_patient(ct, {std::move(source)}, options, warnings);
  return {std::move(patient), std::move(warnings)};
}

bool has_words(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(JudgeAnatomy, FindsNothingInACorrectSegmentation) {
  const BodyOutcome built = build_body(ct_at(kHere), labels_at(kHere));
  ASSERT_TRUE(built.patient) << built.text();
  EXPECT_FALSE(built.warns_of("--confirm")) << built.warnings.front();
}

TEST(JudgeAnatomy, DistinguishesMirroredLabelsFromAMirroredBody) {
  const BodyOutcome labels = build_body(ct_at(kHere), labels_at(kMirroredHere));
  EXPECT_TRUE(has_words(labels.text(), "the labels are mirrored")) << labels.text();
  EXPECT_TRUE(has_words(labels.text(), "--mirror labels")) << labels.text();
  const BodyOutcome both = build_body(ct_at(kMirroredHere), labels_at(kMirroredHere));
  EXPECT_TRUE(has_words(both.text(), "situs inversus")) << both.text();
  EXPECT_TRUE(has_words(both.text(), "--mirror both")) << both.text();
}

TEST(JudgeAnatomy, KeepsAConfirmedFindingInTheProvenance) {
  const BodyOutcome built = build_body(ct_at(kMirroredHere), labels_at(kMirroredHere), {kMirrored, kShifted});
  ASSERT_TRUE(built.patient) << built.text();
  EXPECT_TRUE(std::ranges::any_of(built.patient->provenance, [](const auto& line) {
    return has_words(line, "confirmed: mirrored: left and right");
  }));
  EXPECT_TRUE(built.warns_of("nothing to confirm: there is no finding \"shifted\""));
}

TEST(JudgeAnatomy, JudgesASavedPatient) {
  BodyOutcome built = build_body(ct_at(kMirroredHere), labels_at(kMirroredHere), {kMirrored});
  ASSERT_TRUE(built.patient) << built.text();
  const auto says_mirrored = [&] {
    const auto findings = all_patient_findings(*built.patient, anatomy::label_statistics(*built.patient));
    return std::ranges::any_of(
        findings, [](const anatomy::Finding& finding) { return finding.text.starts_with("mirrored: left"); });
  };
  EXPECT_FALSE(says_mirrored()) << "it is confirmed";
  built.patient->provenance.clear();
  EXPECT_TRUE(says_mirrored());
}

TEST(JudgeAnatomy, RefusesRotatedImages) {
  const Where half_turn = [](const Vec3& p_P) { return Vec3(-p_P.x(), -p_P.y(), p_P.z()); };
  const Where head_down = [](const Vec3& p_P) { return Vec3(p_P.x(), p_P.y(), -p_P.z()); };
  const BodyOutcome turned = build_body(ct_at(half_turn), labels_at(half_turn));
  EXPECT_TRUE(has_words(turned.text(), "left and right, front and back are exchanged")) << turned.text();
  const BodyOutcome down = build_body(ct_at(head_down), labels_at(head_down));
  EXPECT_TRUE(has_words(down.text(), "head and feet are exchanged")) << down.text();
}

TEST(JudgeAnatomy, RefusesShiftedLabelsWithTheOffset) {
  for (const Vec3& way_mm : {Vec3(16, 0, 0), Vec3(0, -12, 0), Vec3(0, 0, 20), Vec3(8, 8, 8)}) {
    const BodyOutcome built = build_body(ct_at(kHere), labels_at([&](const Vec3& p_P) { return Vec3(p_P - way_mm); }));
    ASSERT_TRUE(has_words(built.text(), "beside the structures in the CT")) << way_mm.transpose() << built.text();
    if (way_mm.x() == 16.0) {
      EXPECT_TRUE(has_words(built.text(), "16 mm to the right")) << built.text();
    }
    if (way_mm.z() == 20.0) {
      EXPECT_TRUE(has_words(built.text(), "20 mm to the feet")) << built.text();
    }
  }
}

TEST(JudgeAnatomy, RefusesNumbersOfAnotherVersionWithTheOption) {
  // The same file read as TotalSegmentator 2 and 1: numbers by version 1, names by version 2.
  const std::vector<std::pair<std::string, int>> numbers_1 = {{"spleen", 1},
                                                              {"kidney_right", 2},
                                                              {"kidney_left", 3},
                                                              {"gallbladder", 4},
                                                              {"liver", 5},
                                                              {"stomach", 6},
                                                              {"aorta", 7},
                                                              {"pancreas", 10},
                                                              {"inferior_vena_cava", 8},
                                                              {"vertebrae_L3", 20},
                                                              {"vertebrae_L2", 21},
                                                              {"vertebrae_L1", 22},
                                                              {"urinary_bladder", 104}};
  LabelSource right = labels_at(kHere);
  LabelSource wrong = right;
  for (std::uint8_t& voxel : wrong.labels.voxels) {
    if (voxel == 0) continue;
    const auto ball = std::ranges::find(balls(), static_cast<int>(voxel), &Ball::number);
    const auto number = std::ranges::find_if(numbers_1, [&](const auto& row) { return row.first == ball->name; });
    voxel = static_cast<std::uint8_t>(number->second);
  }
  wrong.names = {{1, "spleen"},
                 {2, "kidney_right"},
                 {3, "kidney_left"},
                 {4, "gallbladder"},
                 {5, "liver"},
                 {6, "stomach"},
                 {7, "pancreas"},
                 {8, "adrenal_gland_right"},
                 {10, "lung_upper_lobe_left"},
                 {20, "colon"},
                 {21, "urinary_bladder"},
                 {22, "prostate"},
                 {104, "rib_left_12"}};
  OtherReading version_1{"totalsegmentator:total_v1", "TotalSegmentator 1", {}};
  for (const auto& [name, number] : numbers_1) version_1.names.emplace_back(number, name);
  wrong.other_readings = {version_1};
  const BodyOutcome built = build_body(ct_at(kHere), wrong);
  EXPECT_TRUE(has_words(built.text(), "TotalSegmentator 1")) << built.text();
  EXPECT_TRUE(has_words(built.text(), "--label-map totalsegmentator:total_v1")) << built.text();
  // Right numbers are not doubted.
  right.other_readings = {version_1};
  EXPECT_TRUE(build_body(ct_at(kHere), right).patient);
}

TEST(JudgeAnatomy, TheSegmentationOfAnotherCtIsRefused) {
  // Another body: all organs elsewhere, so that no shift explains it.
  const Where elsewhere = [](const Vec3& p_P) { return Vec3(p_P.x(), p_P.y() * 0.6 - 30.0, p_P.z() * 1.5 + 25.0); };
  const BodyOutcome built = build_body(ct_at(elsewhere), labels_at(kHere));
  EXPECT_FALSE(built.patient);
  EXPECT_TRUE(has_words(built.text(), "another CT") || has_words(built.text(), "beside the structures"))
      << built.text();
}

TEST(JudgeAnatomy, WarnsOfAMissingSpleen) {
  const BodyOutcome built = build_body(ct_at(kHere), labels_at(kHere, {"spleen"}));
  ASSERT_TRUE(built.patient) << built.text();
  EXPECT_TRUE(built.warns_of("no label for: spleen (--confirm missing if it is right)"));
  const BodyOutcome confirmed = build_body(ct_at(kHere), labels_at(kHere, {"spleen"}), {kMissing});
  EXPECT_FALSE(confirmed.warns_of("no label for"));
}

/// The middle of the body: no air, no skin.
template <class T>
volume::Grid<T> cropped(const volume::Grid<T>& grid) {
  volume::GridGeometry g = grid.geometry;
  g.size = {44, 30, 60};
  g.origin_P = grid.geometry.to_mm({14, 12, 0});
  volume::Grid<T> part(g);
  for (std::size_t n = 0; n < part.voxels.size(); ++n) {
    const volume::Index3 ijk = g.index_of(n);
    part.voxels[n] = grid[{ijk[0] + 14, ijk[1] + 12, ijk[2]}];
  }
  return part;
}

TEST(JudgeAnatomy, DistinguishesReversedLabelsFromARotatedBody) {
  const struct {
    Vec3 signs;
    const char* words;
  } ways[] = {{{1, -1, 1}, "the labels are turned against the CT: front and back are exchanged"},
              {{1, 1, -1}, "the labels are turned against the CT: head and feet are exchanged"},
              {{-1, -1, 1}, "the labels are turned against the CT: left and right, front and back are exchanged"}};
  for (const auto& way : ways) {
    const Where turned = [&](const Vec3& p_P) { return Vec3(way.signs.cwiseProduct(p_P)); };
    const BodyOutcome built = build_body(ct_at(kHere), labels_at(turned));
    EXPECT_TRUE(has_words(built.text(), way.words)) << built.text();
  }
}

TEST(JudgeAnatomy, RefusesUnmirroredLabelsOnAMirroredCt) {
  const BodyOutcome built = build_body(ct_at(kMirroredHere), labels_at(kHere));
  EXPECT_TRUE(has_words(built.text(), "the labels are mirrored (steps of")) << built.text();
}

TEST(JudgeAnatomy, DoesNotAdviseARequestedMirroringAgain) {
  for (const auto mirroring : {Mirroring::kLabels, Mirroring::kBoth}) {
    std::vector<std::string> warnings;
    BuildOptions options;
    options.name = "test";
    options.derive = {false, {}};
    options.mirroring = mirroring;
    const Where ct = mirroring == Mirroring::kBoth ? kMirroredHere : kHere;
    const auto built = build_patient(ct_at(ct), {labels_at(kMirroredHere)}, options, warnings);
    ASSERT_FALSE(built);
    EXPECT_TRUE(has_words(built.error().text(), "build without --mirror")) << built.error().text();
  }
}

TEST(JudgeAnatomy, RefusesACtWithoutSkinUnlessConfirmedAsCropped) {
  const volume::CtGrid ct = cropped(ct_at(kHere));
  LabelSource labels = labels_at(kHere);
  labels.labels = cropped(labels.labels);
  const BodyOutcome refused = build_body(ct, labels);
  EXPECT_TRUE(has_words(refused.text(), "--confirm cropped")) << refused.text();
  // With gas in the bowel, as most have it.
  volume::CtGrid with_gas = ct;
  for (std::size_t n = 0; n < with_gas.voxels.size(); ++n)
    if ((with_gas.geometry.centre_mm(with_gas.geometry.index_of(n)) - Vec3(10, -30, -40)).norm() < 16.0)
      with_gas.voxels[n] = -900;
  const BodyOutcome sides = build_body(with_gas, labels);
  EXPECT_TRUE(has_words(sides.text(), "% of the sides of the CT lie inside the body")) << sides.text();
  for (const volume::CtGrid* told : {&ct, static_cast<const volume::CtGrid*>(&with_gas)}) {
    const BodyOutcome built = build_body(*told, labels, {kCropped});
    ASSERT_TRUE(built.patient) << built.text();
    for (const float mm : built.patient->skin_distance_mm.voxels) ASSERT_TRUE(std::isfinite(mm) && mm > -200.0F) << mm;
  }
}

/// A plate of 220 x 8 mm along the whole scan, `away_mm` from the axis of the body in the direction `down`.
void add_table(volume::CtGrid& ct, const Vec3& down, double away_mm, std::int16_t hu = -250) {
  const Vec3 across(down.y(), down.x(), 0.0);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const Vec3 p_P = ct.geometry.centre_mm(ct.geometry.index_of(n));
    if (std::abs(p_P.dot(down) - away_mm) < 4.0 && std::abs(p_P.dot(across)) < 110.0 && ct.voxels[n] == -1000)
      ct.voxels[n] = hu;
  }
}

TEST(JudgeAnatomy, DerivesThePostureFromTheTable) {
  const struct {
    Vec3 down;
    double away_mm;
    anatomy::Posture posture;
  } sides[] = {{{0, 1, 0}, 102, anatomy::Posture::kSupine},
               {{0, -1, 0}, 102, anatomy::Posture::kProne},
               {{1, 0, 0}, 138, anatomy::Posture::kLeftLateral},
               {{-1, 0, 0}, 138, anatomy::Posture::kRightLateral}};
  for (const auto& side : sides) {
    volume::CtGrid ct = ct_at(kHere);
    add_table(ct, side.down, side.away_mm);
    EXPECT_EQ(find_scanned_posture(ct, find_body(ct)), side.posture) << anatomy::posture_name(side.posture);
  }
}

TEST(JudgeAnatomy, FindsNoPostureWithoutAClearTable) {
  volume::CtGrid ct = ct_at(kHere);
  EXPECT_FALSE(find_scanned_posture(ct, find_body(ct)));
  // Something on both sides, as two arms, or only in a third of the slices, as a hand.
  volume::CtGrid arms = ct;
  add_table(arms, {1, 0, 0}, 138);
  add_table(arms, {-1, 0, 0}, 138);
  EXPECT_FALSE(find_scanned_posture(arms, find_body(arms)));
  volume::CtGrid hand = ct;
  add_table(hand, {0, -1, 0}, 102);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n)
    if (ct.geometry.index_of(n)[2] > ct.geometry.size[2] / 3) hand.voxels[n] = ct.voxels[n];
  EXPECT_FALSE(find_scanned_posture(hand, find_body(hand)));
}

TEST(JudgeAnatomy, WarnsOfAProneScanUntilConfirmedOrBuiltProne) {
  volume::CtGrid ct = ct_at(kHere);
  add_table(ct, {0, -1, 0}, 102);
  const BodyOutcome told = build_body(ct, labels_at(kHere));
  ASSERT_TRUE(told.patient) << told.text();
  EXPECT_TRUE(told.warns_of("the table lies in front of the body: the CT was taken lying on the belly (prone)"));
  EXPECT_TRUE(told.warns_of("--posture prone"));
  EXPECT_FALSE(build_body(ct, labels_at(kHere), {}, anatomy::Posture::kProne).warns_of("table"));
  EXPECT_FALSE(build_body(ct, labels_at(kHere), {kPosture}).warns_of("table"));
}

/// Exchanges the names of two structures.
LabelSource with_exchanged(const std::string& a, const std::string& b) {
  LabelSource labels = labels_at(kHere);
  for (auto& [number, name] : labels.names) name = name == a ? b : name == b ? a : name;
  return labels;
}

TEST(JudgeAnatomy, RefusesOrReportsExchangedNames) {
  const BodyOutcome refused = build_body(ct_at(kHere), with_exchanged("liver", "spleen"));
  EXPECT_TRUE(has_words(refused.text(), "liver on the left, spleen on the right")) << refused.text();
  EXPECT_TRUE(has_words(refused.text(), "--confirm places")) << refused.text();
  EXPECT_TRUE(build_body(ct_at(kHere), with_exchanged("liver", "spleen"), {kPlaces}).patient);
  const BodyOutcome told = build_body(ct_at(kHere), with_exchanged("aorta", "inferior_vena_cava"));
  ASSERT_TRUE(told.patient) << told.text();
  EXPECT_TRUE(told.warns_of("aorta right of the inferior vena cava"));
}

TEST(JudgeAnatomy, WarnsOfAStructureOfGasOrBone) {
  volume::CtGrid gas = ct_at(kHere), bone = gas;
  for (std::size_t n = 0; n < gas.voxels.size(); ++n) {
    const Vec3 p_P = gas.geometry.centre_mm(gas.geometry.index_of(n));
    if ((p_P - Vec3(-80, -20, 60)).norm() < 38.0) gas.voxels[n] = -800;
    if ((p_P - Vec3(-60, -20, 90)).norm() < 38.0) bone.voxels[n] = 800;
  }
  EXPECT_TRUE(build_body(gas, labels_at(kHere), {kShifted}).warns_of("% of it is gas (--confirm hu"));
  EXPECT_TRUE(build_body(bone, labels_at(kHere), {kShifted}).warns_of("% of it is as dense as bone"));
}

TEST(JudgeAnatomy, WarnsOfImplausibleShapes) {
  LabelSource scattered = labels_at(kHere), ball = labels_at(kHere);
  for (std::size_t n = 0; n < scattered.labels.voxels.size(); ++n) {
    const Vec3 p_P = scattered.labels.geometry.centre_mm(scattered.labels.geometry.index_of(n));
    std::uint8_t& voxel = scattered.labels.voxels[n];
    if (voxel == 5) voxel = 0;
    const volume::Index3 ijk = scattered.labels.geometry.index_of(n);
    const bool is_picked = ijk[0] % 4 == 0 && ijk[1] % 3 == 0 && ijk[2] > 4 && ijk[2] < 55;
    if (voxel == 0 && is_picked && std::hypot(p_P.x() / 120.0, p_P.y() / 85.0) < 1.0) voxel = 5;
    if ((p_P - Vec3(12, 25, 20)).norm() < 26.0) ball.labels.voxels[n] = 52;
  }
  const BodyOutcome in_pieces = build_body(ct_at(kHere), scattered, {kMirrored, kShifted, kTurned});
  EXPECT_TRUE(in_pieces.warns_of("liver is scattered or hollow")) << in_pieces.text();
  const BodyOutcome as_ball = build_body(ct_at(kHere), ball, {kShifted});
  EXPECT_TRUE(as_ball.warns_of("aorta is no tube")) << as_ball.text();
}

TEST(JudgeAnatomy, RefusesAMovedOrganWithTheOffset) {
  for (const char* name : {"liver", "spleen", "kidney_left", "vertebrae_L2"}) {
    LabelSource labels = labels_at(kHere, {name});
    const auto ball = std::ranges::find_if(balls(), [&](const Ball& b) { return name == std::string_view(b.name); });
    for (std::size_t n = 0; n < labels.labels.voxels.size(); ++n)
      if ((labels.labels.geometry.centre_mm(labels.labels.geometry.index_of(n)) - ball->middle_P - Vec3(0, 16, 0))
              .norm() < ball->radius_mm)
        labels.labels.voxels[n] = static_cast<std::uint8_t>(ball->number);
    const BodyOutcome built = build_body(ct_at(kHere), labels);
    EXPECT_TRUE(has_words(built.text(), fmt::format("{} would fit 16 mm to the front", name))) << built.text();
  }
}

TEST(JudgeAnatomy, DetectsAMirroredOrRotatedBodyFromFewStructures) {
  const std::vector<std::string> without{"stomach",         "gallbladder",  "aorta",        "inferior_vena_cava",
                                         "urinary_bladder", "vertebrae_L1", "vertebrae_L2", "vertebrae_L3"};
  const BodyOutcome mirrored = build_body(ct_at(kMirroredHere), labels_at(kMirroredHere, without));
  EXPECT_TRUE(has_words(mirrored.text(), "situs inversus")) << mirrored.text();
  const Where head_down = [](const Vec3& p_P) { return Vec3(p_P.x(), p_P.y(), -p_P.z()); };
  const BodyOutcome turned = build_body(ct_at(head_down), labels_at(head_down, without));
  EXPECT_TRUE(has_words(turned.text(), "head and feet are exchanged")) << turned.text();
  const Where face_down = [](const Vec3& p_P) { return Vec3(p_P.x(), -p_P.y(), p_P.z()); };
  const BodyOutcome prone = build_body(ct_at(face_down), labels_at(face_down, without));
  EXPECT_TRUE(has_words(prone.text(), "front and back are exchanged")) << prone.text();
  EXPECT_TRUE(build_body(ct_at(kHere), labels_at(kHere, without)).patient);
}

TEST(JudgeAnatomy, RefusesAWrongVoxelSize) {
  volume::CtGrid ct = ct_at(kHere);
  LabelSource labels = labels_at(kHere);
  ct.geometry.spacing_mm *= 0.4;
  labels.labels.geometry = ct.geometry;
  const BodyOutcome small = build_body(ct, labels);
  EXPECT_TRUE(has_words(small.text(), "check the size of the voxels")) << small.text();
}

TEST(JudgeAnatomy, RefusesOrgansOutsideTheBody) {
  const BodyOutcome built =
      build_body(ct_at(kHere), labels_at([](const Vec3& p_P) { return Vec3(p_P - Vec3(0, 70, 0)); }));
  EXPECT_TRUE(has_words(built.text(), "of the labels lie outside the body")) << built.text();
}

TEST(JudgeAnatomy, FindingsHaveNamesThatCanBeConfirmed) {
  EXPECT_TRUE(check_confirmable(
      {kMirrored, kTurned, kShifted, kNumbers, kOtherCt, kCropped, kMissing, kSizes, kPlaces, kHu, kPosture}));
  const Status unknown = check_confirmable({"situs"});
  ASSERT_FALSE(unknown);
  EXPECT_TRUE(has_words(unknown.error().text(), "mirrored, turned, shifted")) << unknown.error().text();
}

}  // namespace
}  // namespace trocar::patient_builder
