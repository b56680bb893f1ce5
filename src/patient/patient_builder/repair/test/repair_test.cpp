#include <gtest/gtest.h>

#include <algorithm>

#include "patient_builder/repair/repair_segmentation.h"
#include "patient_builder/test/labelled_box.h"

namespace trocar::patient_builder {
namespace {

/// Labels of a segmentation: what is not labelled has id 0.
LabelledBox make_segmentation(const volume::Index3& size = {101, 61, 101}) {
  LabelledBox box(size, {-50.0, -30.0, -50.0});
  box.paint("", [](const Vec3&) { return true; });
  box.patient.label_table.labels.clear();
  return box;
}

auto ball(const Vec3& middle, double radius_mm) {
  return [=](const Vec3& p) { return (p - middle).norm() <= radius_mm; };
}

std::vector<std::string> repair(LabelledBox& box) {
  std::vector<std::string> texts;
  for (const anatomy::Finding& finding :
       repair_segmentation(box.patient.ct, box.patient.labels, box.patient.label_table))
    texts.push_back(finding.text);
  return texts;
}

std::vector<std::string> findings(const LabelledBox& box) {
  std::vector<std::string> texts;
  for (const anatomy::Finding& finding : segmentation_findings(box.patient)) texts.push_back(finding.text);
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Repair, KeepsASoundSegmentation) {
  LabelledBox box = make_segmentation();
  box.paint("kidney_left", ball({30.0, 0.0, 0.0}, 10.0));
  box.paint("kidney_right", ball({-30.0, 0.0, 0.0}, 10.0));
  box.paint("colon", ball({0.0, 0.0, 30.0}, 8.0));
  box.paint("colon", ball({0.0, 0.0, -30.0}, 3.0));  // a bowel has several parts
  const auto before = box.patient.labels.voxels;
  EXPECT_EQ(repair(box), Texts{});
  EXPECT_EQ(box.patient.labels.voxels, before);
  EXPECT_EQ(findings(box), Texts{});
}

TEST(Repair, FillsHolesAndReportsTheirVolume) {
  LabelledBox box = make_segmentation();
  box.paint("sacrum", ball(Vec3::Zero(), 20.0));
  const std::size_t whole = box.count("sacrum");
  const auto cube = [](const Vec3& middle) {
    return [=](const Vec3& p) { return (p - middle).cwiseAbs().maxCoeff() <= 2.0; };  // 125 mm3
  };
  box.paint("", cube({8.0, 0.0, 0.0}));
  box.paint("", cube({-8.0, 0.0, 0.0}));
  box.paint("", cube({0.0, 0.0, 8.0}));
  EXPECT_EQ(repair(box), Texts{"filled 3 holes (0.4 ml) in sacrum"});
  EXPECT_EQ(box.count("sacrum"), whole);
}

TEST(Repair, LeavesALargeHoleOpenAndReportsIt) {
  LabelledBox box = make_segmentation();
  box.paint("liver", ball(Vec3::Zero(), 24.0));
  box.paint("", ball({0.0, 0.0, 3.0}, 9.0));  // a cyst of 3 ml without a label
  const std::size_t drawn = box.count("liver");
  EXPECT_EQ(repair(box), Texts{"left 1 hole (3.1 ml) in liver open"});
  EXPECT_EQ(box.count("liver"), drawn);
}

TEST(Repair, KeepsALesionInsideAnOrgan) {
  LabelledBox box = make_segmentation();
  box.paint("liver", ball(Vec3::Zero(), 20.0));
  box.paint("liver_tumor", ball(Vec3::Zero(), 5.0));
  const std::size_t tumour = box.count("liver_tumor");
  EXPECT_EQ(repair(box), Texts{});
  EXPECT_EQ(box.count("liver_tumor"), tumour);
}

TEST(Repair, RemovesIslandsFarFromTheStructure) {
  LabelledBox box = make_segmentation();
  box.paint("spleen", ball({-20.0, 0.0, 0.0}, 15.0));
  const std::size_t spleen = box.count("spleen");
  box.paint("spleen", ball({40.0, 0.0, 0.0}, 3.0));
  const auto repairs = repair_segmentation(box.patient.ct, box.patient.labels, box.patient.label_table);
  ASSERT_EQ(repairs.size(), 1U);
  EXPECT_EQ(repairs[0].text, "removed 1 island (0.1 ml) of spleen, up to 42 mm from it");  // 60 - 15 - 3
  EXPECT_EQ(repairs[0].label, "spleen");
  ASSERT_TRUE(repairs[0].place_P);
  EXPECT_LT((*repairs[0].place_P - Vec3(40.0, 0.0, 0.0)).norm(), 1.0);
  EXPECT_EQ(box.count("spleen"), spleen);
}

// A tumour at the surface of its liver leaves specks of the liver's mask on its far side.
TEST(Repair, KeepsTheRimOfALesion) {
  LabelledBox box = make_segmentation();
  box.paint("liver", ball({0.0, 0.0, 0.0}, 20.0));
  box.paint("liver_tumor", ball({20.0, 0.0, 0.0}, 12.0));
  box.paint("liver", ball({34.0, 0.0, 0.0}, 2.0));
  const std::size_t liver = box.count("liver");
  EXPECT_EQ(repair(box), Texts{});
  EXPECT_EQ(box.count("liver"), liver);
}

TEST(Repair, RelabelsAnIslandInsideAnotherVertebra) {
  LabelledBox box = make_segmentation();
  box.paint("vertebrae_L3", ball({0.0, 0.0, 25.0}, 15.0));
  box.paint("vertebrae_L4", ball({0.0, 0.0, -25.0}, 15.0));
  const std::size_t l4 = box.count("vertebrae_L4");
  box.paint("vertebrae_L3", ball({0.0, 0.0, -25.0}, 4.0));
  EXPECT_EQ(repair(box), Texts{"relabelled 1 island (0.3 ml) of vertebrae_L3 as vertebrae_L4"});
  EXPECT_EQ(box.count("vertebrae_L4"), l4);
}

TEST(Repair, ExchangesSwappedSides) {
  LabelledBox box = make_segmentation();
  box.paint("kidney_right", ball({30.0, 0.0, 0.0}, 10.0));  // +x is the patient's left
  box.paint("kidney_left", ball({-30.0, 0.0, 0.0}, 10.0));
  EXPECT_EQ(repair(box), Texts{"exchanged the names kidney_right and kidney_left: each was on the other side"});
  EXPECT_EQ(box.name_at({30.0, 0.0, 0.0}), "kidney_left");
  EXPECT_EQ(box.name_at({-30.0, 0.0, 0.0}), "kidney_right");
}

TEST(Repair, DoesNotExchangeNamesForAFewVoxels) {
  LabelledBox box = make_segmentation();
  box.paint("kidney_left", ball({20.0, 0.0, 0.0}, 12.0));
  box.paint("kidney_right", ball({40.0, 0.0, 20.0}, 3.0));
  EXPECT_EQ(repair(box), Texts{});
}

TEST(Repair, RelabelsAPartOnTheOtherSide) {
  LabelledBox box = make_segmentation();
  box.paint("kidney_left", ball({30.0, 0.0, 0.0}, 10.0));
  box.paint("kidney_right", ball({-30.0, 0.0, 0.0}, 10.0));
  box.paint("kidney_left", ball({-30.0, 0.0, 20.0}, 5.0));
  const auto texts = repair(box);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0], "relabelled 1 part (0.5 ml) of kidney_left as kidney_right");
  EXPECT_EQ(box.name_at({-30.0, 0.0, 20.0}), "kidney_right");
}

TEST(Repair, DoesNotExchangeSidesOfAMirroredImage) {
  LabelledBox box = make_segmentation();
  for (const char* name : {"kidney", "adrenal_gland", "hip", "gluteus_maximus"}) {
    const double z = 20.0 * static_cast<double>(name[0] - 'i') / 3.0;
    box.paint(std::string(name) + "_right", ball({30.0, 0.0, z}, 5.0));
    box.paint(std::string(name) + "_left", ball({-30.0, 0.0, z}, 5.0));
  }
  EXPECT_EQ(repair(box), Texts{});
  EXPECT_EQ(findings(box), Texts{"left and right are exchanged in 4 of 4 pairs: the image may be mirrored"});
}

/// A rib along x at y = 0, from x = 10 to the left, and its vertebra around x = -15; bone in the CT in between.
LabelledBox make_rib(double gap_mm, std::int16_t hu) {
  LabelledBox box = make_segmentation();
  box.paint("vertebrae_T9", ball({-25.0, 0.0, 0.0}, 12.0));
  const double start = -13.0 + gap_mm;
  box.paint("rib_left_9",
            [=](const Vec3& p) { return p.x() >= start && p.x() <= 40.0 && std::hypot(p.y(), p.z()) <= 4.0; });
  for (std::int16_t& voxel : box.patient.ct.voxels) voxel = hu;
  return box;
}

TEST(Repair, JoinsARibThatEndsBeforeTheSpine) {
  LabelledBox box = make_rib(10.0, 300);
  EXPECT_EQ(repair(box), Texts{"joined rib_left_9 and vertebrae_T9 across a gap of 10 mm"});
  for (double x = -13.0; x <= 0.0; x += 1.0)
    EXPECT_TRUE(box.name_at({x, 0.0, 0.0}) == "rib_left_9" || box.name_at({x, 0.0, 0.0}) == "vertebrae_T9") << x;
  EXPECT_EQ(findings(box), Texts{});
}

TEST(Repair, ReportsLongOrBonelessRibGaps) {
  LabelledBox soft = make_rib(10.0, 20);
  EXPECT_EQ(repair(soft), Texts{});
  EXPECT_EQ(findings(soft), Texts{"rib_left_9 ends 10 mm from vertebrae_T9"});
  LabelledBox far = make_rib(28.0, 300);
  EXPECT_EQ(repair(far), Texts{});
  EXPECT_EQ(findings(far), Texts{"rib_left_9 ends 28 mm from vertebrae_T9"});
}

TEST(Repair, JoinsThePiecesOfARib) {
  LabelledBox box = make_rib(0.5, 300);
  box.paint("", [](const Vec3& p) { return p.x() >= 10.0 && p.x() <= 15.0 && std::hypot(p.y(), p.z()) <= 5.0; });
  EXPECT_EQ(repair(box), Texts{"joined two pieces of rib_left_9 across a gap of 7 mm"});
  EXPECT_EQ(box.name_at({12.0, 0.0, 0.0}), "rib_left_9");
}

TEST(SegmentationFindings, NameVertebraeThatMayBeMixed) {
  LabelledBox box = make_segmentation({61, 61, 141});
  const auto disc = [](double low, double high) {
    return [=](const Vec3& p) { return std::hypot(p.x() + 20.0, p.y()) <= 15.0 && p.z() >= low && p.z() <= high; };
  };
  box.paint("vertebrae_L1", disc(50.0, 70.0));
  box.paint("vertebrae_L2", disc(0.0, 45.0));  // two vertebrae in one label
  box.paint("vertebrae_L3", disc(-20.0, -4.0));
  box.paint("vertebrae_L5", disc(-45.0, -25.0));
  const auto texts = findings(box);
  ASSERT_FALSE(texts.empty());
  EXPECT_TRUE(std::any_of(texts.begin(), texts.end(), [](const std::string& text) {
    return text.starts_with("vertebrae_L2 has 2") && text.find("labels of vertebrae may be mixed") != std::string::npos;
  })) << texts.front();
}

TEST(SegmentationFindings, NameMisorderedVertebraeAndSplitStructures) {
  LabelledBox box = make_segmentation();
  box.paint("vertebrae_L2", ball({-30.0, 0.0, -25.0}, 10.0));
  box.paint("vertebrae_L3", ball({-30.0, 0.0, 25.0}, 10.0));
  box.paint("spleen", ball({20.0, 0.0, 25.0}, 12.0));
  box.paint("spleen", ball({20.0, 0.0, -25.0}, 11.0));
  EXPECT_EQ(findings(box), (Texts{"vertebrae_L3 lies above vertebrae_L2", "spleen has 2 parts, the second of 5.6 ml"}));
}

}  // namespace
}  // namespace trocar::patient_builder
