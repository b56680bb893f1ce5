#include "phantom/phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/random.h"
#include "volume/morphology.h"
#include "volume/sampling.h"

namespace trocar::phantom {
namespace {

constexpr PhantomResolution kCoarse{{96, 76, 60}};
constexpr PhantomResolution kMedium{{190, 150, 120}};

anatomy::VirtualPatient generate(std::uint64_t seed, const PhantomResolution& resolution) {
  auto patient = generate_phantom("abdomen", seed, resolution);
  EXPECT_TRUE(patient) << patient.error().text();
  return patient ? *std::move(patient) : anatomy::VirtualPatient{};
}

/// One patient for all tests that only look.
const anatomy::VirtualPatient& medium_patient() {
  static const anatomy::VirtualPatient kPatient = generate(1, kMedium);
  return kPatient;
}

std::map<std::string, double> volumes_ml(const anatomy::VirtualPatient& patient) {
  std::map<std::string, double> volumes;
  const double voxel_ml = patient.labels.geometry.voxel_volume_mm3() / 1000.0;
  for (const std::uint8_t id : patient.labels.voxels)
    if (const anatomy::Label* label = patient.label_table.find(id)) volumes[label->name] += voxel_ml;
  return volumes;
}

volume::MaskGrid mask_of(const anatomy::VirtualPatient& patient, const std::set<std::string>& names) {
  volume::MaskGrid mask(patient.labels.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    const anatomy::Label* label = patient.label_table.find(patient.labels.voxels[n]);
    mask.voxels[n] = label != nullptr && names.contains(label->name);
  }
  return mask;
}

/// Names of the labels that touch a structure by a voxel's face.
std::set<std::string> neighbours_of(const anatomy::VirtualPatient& patient, const std::string& name) {
  std::set<std::string> neighbours;
  const volume::GridGeometry& geometry = patient.labels.geometry;
  const std::uint8_t id = patient.label_table.find(name)->id;
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    if (patient.labels.voxels[n] != id) continue;
    const volume::Index3 at = geometry.index_of(n);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const std::int64_t step : {-1, 1}) {
        volume::Index3 next = at;
        next[axis] += step;
        if (!geometry.contains(next)) continue;
        const anatomy::Label* label = patient.label_table.find(patient.labels[next]);
        neighbours.insert(label == nullptr ? "nothing" : label->name);
      }
  }
  return neighbours;
}

TEST(Phantom, DependsOnlyOnItsSeed) {
  const anatomy::VirtualPatient first = generate(7, kCoarse);
  const anatomy::VirtualPatient again = generate(7, kCoarse);
  const anatomy::VirtualPatient other = generate(8, kCoarse);
  EXPECT_EQ(first.ct.voxels, again.ct.voxels);
  EXPECT_EQ(first.labels.voxels, again.labels.voxels);
  EXPECT_EQ(first.content_hash, again.content_hash);
  EXPECT_NE(first.content_hash, other.content_hash);
}

TEST(Phantom, ShowsEveryLabelOfItsTable) {
  const auto volumes = volumes_ml(medium_patient());
  for (const anatomy::Label& label : medium_patient().label_table.labels)
    EXPECT_TRUE(volumes.contains(label.name)) << label.name << " has no voxel";
}

TEST(Phantom, HasOrgansOfPlausibleSize) {
  // The liver lies whole in the box; lungs, heart, great vessels, bowel and spine are cut by it.
  const std::map<std::string, std::pair<double, double>> limits{
      {"liver", {1100.0, 1900.0}},     {"spleen", {100.0, 320.0}},      {"kidney_right", {110.0, 220.0}},
      {"kidney_left", {110.0, 220.0}}, {"gallbladder", {15.0, 60.0}},   {"pancreas", {40.0, 120.0}},
      {"liver_lesion_1", {1.5, 15.0}}, {"liver_lesion_2", {0.8, 15.0}}, {"liver_lesion_3", {0.8, 15.0}},
      {"portal_vein", {8.0, 45.0}},    {"hepatic_veins", {8.0, 45.0}},  {"vertebrae_L2", {30.0, 80.0}},
      {"stomach", {100.0, 600.0}}};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const anatomy::VirtualPatient patient = generate(seed, kCoarse);
    auto volumes = volumes_ml(patient);
    for (const auto& [name, range] : limits) {
      EXPECT_GT(volumes[name], range.first) << name << ", seed " << seed;
      EXPECT_LT(volumes[name], range.second) << name << ", seed " << seed;
    }
  }
}

TEST(Phantom, KeepsEveryOrganInOnePiece) {
  const anatomy::VirtualPatient& patient = medium_patient();
  const std::vector<std::set<std::string>> wholes{
      {"liver", "portal_vein", "hepatic_veins", "liver_lesion_1", "liver_lesion_2", "liver_lesion_3"},
      {"spleen"},
      {"kidney_right"},
      {"kidney_left"},
      {"gallbladder"},
      {"aorta"},
      {"inferior_vena_cava"},
      {"stomach", "gas"},
      {"pancreas"},
      {"liver_lesion_1"},
      {"vertebrae_L1"},
      {"rib_right_9"},
      {"spinal_cord"}};
  for (const auto& names : wholes) {
    const volume::Components components = volume::connected_components(mask_of(patient, names));
    ASSERT_FALSE(components.voxel_counts.empty()) << *names.begin();
    std::size_t total = 0;
    for (const std::size_t count : components.voxel_counts) total += count;
    // Bits of wall that partial volume cuts off are no second organ; gas of the bowel is counted with the stomach's.
    const double least = names.contains("gas") ? 0.5 : 0.985;
    EXPECT_GT(static_cast<double>(components.voxel_counts.front()), least * static_cast<double>(total))
        << *names.begin();
  }
}

TEST(Phantom, HidesLesionsAndVesselsInsideTheLiver) {
  const std::set<std::string> inside{"liver",          "portal_vein",    "hepatic_veins",
                                     "liver_lesion_1", "liver_lesion_2", "liver_lesion_3"};
  for (const std::string name : {"liver_lesion_1", "liver_lesion_2", "liver_lesion_3"})
    for (const std::string& neighbour : neighbours_of(medium_patient(), name))
      EXPECT_TRUE(inside.contains(neighbour)) << name << " touches " << neighbour;
  std::set<std::string> around_vessels = inside;
  around_vessels.insert({"bile_ducts", "hepatic_artery", "inferior_vena_cava", "portal_vein_and_splenic_vein", "fat",
                         "aorta"});  // at the gates
  for (const std::string name : {"portal_vein", "hepatic_veins"})
    for (const std::string& neighbour : neighbours_of(medium_patient(), name))
      EXPECT_TRUE(around_vessels.contains(neighbour)) << name << " touches " << neighbour;
}

TEST(Phantom, LabelsTheWholeBodyAndNothingOutside) {
  const anatomy::VirtualPatient& patient = medium_patient();
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const bool inside = patient.skin_distance_mm.voxels[n] < 0.0F;
    ASSERT_EQ(inside, patient.labels.voxels[n] != 0) << "voxel " << n;
  }
}

TEST(Phantom, MeasuresTheDistanceToTheSkin) {
  const anatomy::VirtualPatient& patient = medium_patient();
  // A distance field has a slope of 1; near the skin nothing else is nearer.
  Random random(5);
  int checked = 0;
  while (checked < 400) {
    const Vec3 p(random.uniform(-160.0, 160.0), random.uniform(-120.0, 120.0), random.uniform(-100.0, 100.0));
    const double distance = volume::sample_linear(patient.skin_distance_mm, p);
    if (std::abs(distance) > 12.0) continue;
    ++checked;
    const Vec3 slope = volume::gradient_per_mm(patient.skin_distance_mm, p);
    EXPECT_NEAR(slope.norm(), 1.0, 0.12) << p.transpose();
    // Walking the distance down the slope arrives at the skin.
    EXPECT_NEAR(volume::sample_linear(patient.skin_distance_mm, p - distance * slope.normalized()), 0.0, 0.6)
        << p.transpose();
  }
}

TEST(Phantom, IsConsistentAcrossResolutions) {
  auto fine = volumes_ml(medium_patient());
  auto flat = volumes_ml(generate(1, {{150, 130, 60}}));
  for (const std::string name : {"liver", "spleen", "kidney_left", "muscle", "fat", "aorta"})
    EXPECT_NEAR(flat[name] / fine[name], 1.0, 0.04) << name;
}

TEST(Phantom, HasTheHounsfieldUnitsOfThePortalVenousPhase) {
  const anatomy::VirtualPatient& patient = medium_patient();
  std::map<std::string, std::vector<std::int16_t>> values;
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n)
    if (const anatomy::Label* label = patient.label_table.find(patient.labels.voxels[n]))
      values[label->name].push_back(patient.ct.voxels[n]);
  // The median: borders mix two tissues in a voxel, and fat lies in thin layers.
  const auto median = [&](const std::string& name) {
    std::vector<std::int16_t>& of_label = values[name];
    const auto middle = of_label.begin() + static_cast<std::ptrdiff_t>(of_label.size() / 2);
    std::nth_element(of_label.begin(), middle, of_label.end());
    return static_cast<double>(*middle);
  };
  EXPECT_NEAR(median("liver"), 105.0, 6.0);
  EXPECT_NEAR(median("spleen"), 115.0, 8.0);
  EXPECT_NEAR(median("fat"), -95.0, 12.0);
  EXPECT_NEAR(median("aorta"), 150.0, 15.0);
  EXPECT_NEAR(median("lung_lower_lobe_right"), -840.0, 40.0);
  EXPECT_GT(median("vertebrae_L2"), 200.0);
  EXPECT_LT(median("liver_lesion_1"), median("liver") - 30.0);
}

TEST(Phantom, RefusesAnUnknownNameAndAnImpossibleSize) {
  const auto unknown = generate_phantom("knee");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().exit_status, 2);
  EXPECT_NE(unknown.error().text().find("abdomen"), std::string::npos);
  const auto tiny = generate_phantom("abdomen", 1, {{2, 76, 60}});
  ASSERT_FALSE(tiny);
  EXPECT_EQ(tiny.error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::phantom
