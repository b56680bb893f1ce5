#include "ultrasound/probe/transducer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/changed_file.h"
#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {
namespace {

const std::filesystem::path kTransducersFile = data_dir() / "transducers.toml";

bool has_arc(TransducerKind kind) {
  return kind == TransducerKind::kConvex || kind == TransducerKind::kMechanicalConvex;
}

TEST(Transducers, ShippedOnesCoverEveryKindConsistently) {
  const auto transducers = load_transducers(kTransducersFile);
  ASSERT_TRUE(transducers) << transducers.error().text();
  std::set<TransducerKind> kinds;
  for (const Transducer& t : *transducers) {
    kinds.insert(t.kind);
    EXPECT_FALSE(t.description.empty()) << t.name;
    EXPECT_LE(t.active_elements, t.elements) << t.name;
    EXPECT_LT(t.focus_mm, t.depth_mm) << t.name;
    EXPECT_EQ(t.kind == TransducerKind::kLinear, t.field_of_view_rad == 0.0) << t.name;
    EXPECT_EQ(t.kind == TransducerKind::kMechanicalConvex, t.sweep_rad > 0.0) << t.name;
    EXPECT_EQ(has_arc(t.kind), t.radius_mm > 0.0) << t.name;
    // An array's scanlines cover its face: figures from different sources must agree.
    if (has_arc(t.kind)) {
      EXPECT_NEAR(t.field_of_view_rad * t.radius_mm, t.face_width_mm(), 0.03 * t.face_width_mm()) << t.name;
    }
    // The motor's axis lies inside the probe, not before its face.
    if (t.kind == TransducerKind::kMechanicalConvex) {
      EXPECT_GT(t.sweep_radius_mm, 0.0);
    }
  }
  EXPECT_EQ(kinds.size(), 4u);
}

TEST(Transducers, LiverSweepMatchesTheRecordedFan) {
  const auto transducer = load_transducer(kTransducersFile, "liver-sweep");
  ASSERT_TRUE(transducer) << transducer.error().text();
  const ScanGeometry::Extent extent = make_scan_geometry(*transducer, transducer->depth_mm, 256, 1024).extent();
  // The recorded pictures are cut out to their fan: 739 x 593 pixels of 0.3148 mm, of which the fan leaves a few free.
  constexpr double kPixel_mm = 0.3148;
  EXPECT_NEAR((extent.x1 - extent.x0) / kPixel_mm, 739.0, 5.0);
  EXPECT_NEAR((extent.y1 - extent.y0) / kPixel_mm, 593.0, 5.0);
}

TEST(Transducers, UnknownNameIsRefusedWithTheKnownOnes) {
  const auto transducer = load_transducer(kTransducersFile, "C5-3");
  ASSERT_FALSE(transducer);
  EXPECT_EQ(transducer.error().exit_status, 2);
  EXPECT_NE(transducer.error().text().find("\"C5-3\""), std::string::npos);
  for (const char* known : {"C5-2", "L14-5", "P4-2"})
    EXPECT_NE(transducer.error().advice.find(known), std::string::npos) << transducer.error().text();
}

/// Loads the shipped file with one text replaced.
Result<std::vector<Transducer>> load_changed_transducers(const std::string& from, const std::string& to) {
  return testing::load_changed(kTransducersFile, from, to, [](const auto& file) { return load_transducers(file); });
}

TEST(Transducers, WrongEntryNamesFileTransducerAndKey) {
  struct Case {
    std::string from, to, named;
  };
  const std::vector<Case> cases = {
      {"radius_mm = {value = 61, source", "radius_cm = {value = 61, source", "radius_"},
      {"radius_mm = {value = 61, source", "colour = \"gray\"\nradius_mm = {value = 61, source", "colour"},
      {"radius_mm = {value = 61, source", "radius_mm = {value = 6100, source", "value"},
      {"elements = {value = 128,", "elements = {value = 128.5,", "elements"},
      {"elements = {value = 128,", "elements = {value = 4,", "value"},
      {"active_elements = {value = 64,", "active_elements = {value = 129,", "value"},
      {"kind = \"convex\"", "kind = \"curved\"", "mechanical_convex"},
      {"highest_mhz = {value = 5, source = \"its name\"}", "highest_mhz = {value = 5}", "source"},
      {"highest_mhz = {value = 5,", "highest_mhz = {value = 1,", "value"},
      {"kind = \"convex\"", "kind = \"convex\"\nsweep_deg = {value = 60, source = \"x\"}", "sweep_deg"},
      {"kind = \"convex\"", "kind = \"linear\"", "radius_mm"},
      {"frequency_mhz = {value = 3.5,", "frequency_mhz = {value = nan,", "value"}};
  for (const Case& wrong : cases) {
    const auto transducers = load_changed_transducers(wrong.from, wrong.to);
    ASSERT_FALSE(transducers) << wrong.to;
    const std::string text = transducers.error().text();
    EXPECT_NE(text.find("transducers.toml"), std::string::npos) << text;
    EXPECT_NE(text.find("C5-2"), std::string::npos) << text;
    EXPECT_NE(text.find(wrong.named), std::string::npos) << text;
    EXPECT_EQ(transducers.error().exit_status, 1);
  }
}

TEST(Transducers, AssumedNumberNeedsItsRange) {
  const auto transducers =
      load_changed_transducers("source = \"Ultrasonix data sheet", "source = \"assumed, not the data sheet");
  ASSERT_FALSE(transducers);
  EXPECT_NE(transducers.error().text().find("range"), std::string::npos) << transducers.error().text();
}

TEST(Transducers, MissingFileIsAnError) {
  EXPECT_FALSE(load_transducers("/nowhere/transducers.toml"));
}

}  // namespace
}  // namespace trocar::ultrasound
