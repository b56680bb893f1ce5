#include "ultrasound/probe/probe_placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/files/folders.h"
#include "phantom/layered/layers.h"
#include "phantom/phantom.h"
#include "ultrasound/probe/probe_contact.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

const anatomy::VirtualPatient& abdomen() {
  static const anatomy::VirtualPatient kPatient = *phantom::generate_phantom("abdomen", 1, {{145, 114, 92}});
  return kPatient;
}

std::vector<ProbeView> views() {
  auto loaded = load_probe_views(data_dir() / "views.toml");
  EXPECT_TRUE(loaded.has_value()) << loaded.error().text();
  return *loaded;
}

struct Placed {
  ProbeView view;
  ScanGeometry scan;
  Pose X_PT;
  ViewVisibility visibility;
};

Placed place_named_view(const anatomy::VirtualPatient& patient, std::string_view name) {
  const auto view = choose_view(patient, views(), name);
  EXPECT_TRUE(view.has_value()) << view.error().text();
  const auto transducer = load_transducer(data_dir() / "transducers.toml", view->transducer);
  EXPECT_TRUE(transducer.has_value()) << transducer.error().text();
  const auto placed = place_probe(patient, *view, *transducer);
  EXPECT_TRUE(placed.has_value()) << placed.error().text();
  return {*view, make_scan_geometry(*transducer, view->depth_mm, 65, 64), placed->X_PT, placed->visibility};
}

Vec3 at(const Placed& placed, double line, double depth_mm) {
  const Vec2 p_T = placed.scan.to_cartesian({line, depth_mm});
  return placed.X_PT * Vec3(p_T.x(), p_T.y(), 0.0);
}

std::string label_at(const anatomy::VirtualPatient& patient, const Vec3& p_P) {
  const anatomy::Label* label = anatomy::find_label(patient, p_P);
  return label != nullptr ? label->name : "";
}

/// Depth of the first bone on a scanline; the picture's depth where there is none.
double bone_depth_mm(const anatomy::VirtualPatient& patient, const Placed& placed, double line) {
  for (double depth_mm = 0.0; depth_mm < placed.view.depth_mm; depth_mm += 0.5) {
    const anatomy::Label* label = anatomy::find_label(patient, at(placed, line, depth_mm));
    if (label != nullptr && label->tissue == "bone") return depth_mm;
  }
  return placed.view.depth_mm;
}

/// Share of the picture that a label takes.
double share_of(const anatomy::VirtualPatient& patient, const Placed& placed, std::string_view name) {
  int hits = 0;
  int all = 0;
  for (int line = 0; line < placed.scan.lines; line += 2) {
    for (double depth_mm = 1.0; depth_mm < placed.view.depth_mm; depth_mm += 2.0, ++all)
      hits += label_at(patient, at(placed, line, depth_mm)).starts_with(name);
  }
  return static_cast<double>(hits) / all;
}

/// What every view keeps: a rigid pose, the face on the skin along its width, the marker where the plane says.
void expect_on_skin(const anatomy::VirtualPatient& patient, const Placed& placed) {
  const std::string& name = placed.view.name;
  const Mat3& R_PT = placed.X_PT.R();
  EXPECT_LT((R_PT.transpose() * R_PT - Mat3::Identity()).norm(), 1e-9) << name;
  EXPECT_NEAR(R_PT.determinant(), 1.0, 1e-9) << name;
  const Vec3 marker = placed.view.plane == ScanPlane::kLongitudinal ? Vec3(0, 0, 1) : Vec3(-1, 0, 0);
  EXPECT_GT(R_PT.col(0).dot(marker), 0.7) << name;

  std::vector<LineContact> contact(static_cast<std::size_t>(placed.scan.lines));
  find_contact(patient.skin_distance_mm, placed.scan, placed.X_PT, contact);
  int touching = 0;
  for (const LineContact& line : contact) touching += line.coupling > 0.5F;
  EXPECT_GT(touching, 0.9 * placed.scan.lines) << name;
  const LineContact& middle = contact[contact.size() / 2];
  EXPECT_GT(middle.pressed_mm, placed.view.pressed_mm - 1.0) << name;
  EXPECT_LT(middle.pressed_mm, 16.0) << name;
}

/// And its target is in the picture.
void expect_target_in_picture(const anatomy::VirtualPatient& patient, const Placed& placed) {
  if (placed.view.name == "spine-laminae") return;  // its target is the ligament in the midline, beside the picture
  const anatomy::Label* target = find_target(patient, placed.view.targets);
  ASSERT_NE(target, nullptr);
  EXPECT_GT(share_of(patient, placed, target->name), 0.001) << placed.view.name;
}

TEST(ProbePlacement, EveryAbdomenViewShowsItsTarget) {
  const std::vector<std::string> names = possible_views(abdomen(), views());
  EXPECT_GE(names.size(), 9U);
  for (const std::string& name : names) {
    const Placed placed = place_named_view(abdomen(), name);
    expect_on_skin(abdomen(), placed);
    expect_target_in_picture(abdomen(), placed);
    EXPECT_GE(placed.visibility.visible, kEnoughVisible) << name << ": " << hidden_causes(placed.visibility);
  }
}

TEST(ProbePlacement, LayeredScenesHaveTheirViews) {
  const std::pair<const char*, const char*> kViews[] = {{"layers-lumbar", "spine-longitudinal"},
                                                        {"layers-lumbar", "spine-laminae"},
                                                        {"layers-ascites", "ascites"},
                                                        {"layers-liver", "intercostal"},
                                                        {"layers-liver", "bile-duct"}};
  for (const auto& [scene, name] : kViews) {
    const auto patient = phantom::make_layered_scene(scene, 1, {{50, 88, 50}});
    ASSERT_TRUE(patient.has_value());
    const Placed placed = place_named_view(*patient, name);
    expect_on_skin(*patient, placed);
    if (placed.view.offset_mm.isZero())
      expect_target_in_picture(*patient, placed);
    else  // beside the midline, on the laminae
      EXPECT_LT(bone_depth_mm(*patient, placed, 45), 65.0);
  }
}

TEST(ProbePlacement, KidneyViewCrossesLiverButNoBone) {
  const Placed placed = place_named_view(abdomen(), "liver-right-kidney");
  EXPECT_GT(share_of(abdomen(), placed, "kidney_right"), 0.08);
  EXPECT_GT(share_of(abdomen(), placed, "liver"), 0.1);
  EXPECT_LT(placed.X_PT.p().x(), -80.0);  // from the right flank
  const double middle = placed.scan.middle_line();
  for (const double line : {middle - 12, middle - 6, middle, middle + 6})
    EXPECT_GT(bone_depth_mm(abdomen(), placed, line), 70.0) << line;
}

TEST(ProbePlacement, IntercostalViewLiesBetweenTwoRibs) {
  const auto liver = phantom::make_layered_scene("layers-liver", 1, {{100, 175, 100}});
  for (const anatomy::VirtualPatient* patient : {&abdomen(), &*liver}) {
    const Placed placed = place_named_view(*patient, "intercostal");
    const double middle = placed.scan.middle_line();
    EXPECT_GT(bone_depth_mm(*patient, placed, middle), 70.0) << patient->name;
    for (const double side : {-1.0, 1.0}) {
      double shallowest_mm = placed.view.depth_mm;
      for (double off = 4.0; off <= middle; off += 1.0)
        shallowest_mm = std::min(shallowest_mm, bone_depth_mm(*patient, placed, middle + side * off));
      EXPECT_LT(shallowest_mm, 50.0) << patient->name << side;
    }
  }
}

TEST(ProbePlacement, SpineViewShowsTheProcessesFromTheBack) {
  const Placed placed = place_named_view(abdomen(), "spine-longitudinal");
  EXPECT_LT(placed.X_PT.R()(1, 1), -0.9);
  EXPECT_GT(placed.X_PT.p().y(), 60.0);
  // Near the skin bone comes and goes along the scan.
  int changes = 0;
  bool was_bone = false;
  for (int line = 0; line < placed.scan.lines; ++line) {
    const bool is_bone = bone_depth_mm(abdomen(), placed, line) < 45.0;
    changes += is_bone != was_bone;
    was_bone = is_bone;
  }
  EXPECT_GE(changes, 3);
}

TEST(ProbePlacement, DiaphragmViewCrossesTheLiver) {
  const Placed placed = place_named_view(abdomen(), "diaphragm");
  bool was_liver = false;
  bool has_border = false;
  for (double depth_mm = 10.0; depth_mm < placed.view.depth_mm; depth_mm += 1.0) {
    const std::string name = label_at(abdomen(), at(placed, placed.scan.middle_line(), depth_mm));
    was_liver |= name == "liver";
    has_border |= was_liver && name.starts_with("lung");
  }
  EXPECT_TRUE(has_border);
}

TEST(ProbePlacement, AngleTurnsThePlaneAboutTheBeam) {
  const auto transducer = load_transducer(data_dir() / "transducers.toml", "C5-2");
  ProbeView view = *choose_view(abdomen(), views(), "aorta");
  view.search_mm = 0.0;
  const auto straight = place_probe(abdomen(), view, *transducer);
  view.angle_rad = 0.5 * std::numbers::pi;
  const auto turned = place_probe(abdomen(), view, *transducer);
  ASSERT_TRUE(straight.has_value() && turned.has_value());
  // Right-handed about y, which points to the back: from the head to the patient's left.
  EXPECT_GT(turned->X_PT.R().col(0).x(), 0.9);
  EXPECT_GT(straight->X_PT.R().col(0).z(), 0.9);
}

TEST(ProbePlacement, NamesMissingTargetsAndPossibleViews) {
  const auto lacking = choose_view(abdomen(), views(), "ascites");
  ASSERT_FALSE(lacking.has_value());
  EXPECT_EQ(lacking.error().exit_status, 2);
  EXPECT_NE(lacking.error().text().find("liver-right-kidney"), std::string::npos) << lacking.error().text();
  EXPECT_EQ(lacking.error().text().find("available views: ascites"), std::string::npos);
  const auto unknown = choose_view(abdomen(), views(), "toe");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_NE(unknown.error().text().find("ascites"), std::string::npos) << unknown.error().text();

  const auto transducer = load_transducer(data_dir() / "transducers.toml", "C5-2");
  ProbeView view;
  view.targets = {"tail"};
  EXPECT_FALSE(place_probe(abdomen(), view, *transducer).has_value());
  EXPECT_FALSE(place_probe(anatomy::VirtualPatient{}, view, *transducer).has_value());
}

TEST(ProbeView, SelectsTheLargestLabelOfTheFirstMatchingPattern) {
  anatomy::VirtualPatient patient;
  patient.labels.geometry.size = {10, 10, 1};
  patient.labels.voxels.assign(100, 0);
  const char* const names[] = {"livertumor1", "livertumor2", "Right Kidney", "speck"};
  for (std::uint8_t id = 1; id <= 4; ++id) patient.label_table.labels.push_back({id, names[id - 1], "organ", {}});
  for (std::size_t n = 0; n < 100; ++n)
    patient.labels.voxels[n] = static_cast<std::uint8_t>(n < 20 ? 1 : n < 60 ? 2 : n < 95 ? 3 : 4);
  const auto found = [&](std::vector<std::string> patterns) {
    const anatomy::Label* label = find_target(patient, patterns);
    return label != nullptr ? label->name : "";
  };
  EXPECT_EQ(found({"liver_tumor*"}), "livertumor2");
  EXPECT_EQ(found({"liver", "right_kidney", "livertumor*"}), "Right Kidney");
  EXPECT_EQ(found({"speck"}), "");  // five voxels
  EXPECT_EQ(found({"livertumor"}), "");
}

}  // namespace
}  // namespace trocar::ultrasound
