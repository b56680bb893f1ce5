#include "patient_builder/repair/detail/repairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "anatomy/known_structures.h"
#include "volume/distance.h"

namespace trocar::patient_builder::detail {
namespace {

constexpr std::array<std::string_view, 20> kSeveral = {
    "bone",      "bones",         "boneother",      "ribs",    "spine", "vertebrae", "vertebraebody",
    "kidneys",   "lungs",         "muscle",         "muscles", "vein",  "veins",     "skeletalmuscle",
    "ligaments", "adrenalglands", "surrenalglands", "pelvis",  "discs", "ligament"};

}  // namespace

LabelParts find_parts(const volume::LabelGrid& labels, std::uint8_t id, const IndexBox& box) {
  LabelParts found{id, box, {}, {}, labels.geometry.voxel_volume_mm3() / 1000.0};
  found.parts = volume::connected_components(cut_mask(labels, box, [&](std::uint8_t other) { return other == id; }));
  std::vector<Vec3> sums(found.count(), Vec3::Zero());
  for_each_in(labels.geometry, box, [&](std::size_t, std::size_t in_box, const volume::Index3& ijk) {
    if (const auto part = found.parts.ids.voxels[in_box]; part != 0)
      sums[static_cast<std::size_t>(part - 1)] += volume::to_vec3(ijk);
  });
  std::vector<double> nearest(found.count(), std::numeric_limits<double>::infinity());
  found.middle.resize(found.count());
  for_each_in(labels.geometry, box, [&](std::size_t, std::size_t in_box, const volume::Index3& ijk) {
    const auto id_of_part = found.parts.ids.voxels[in_box];
    if (id_of_part == 0) return;
    const auto part = static_cast<std::size_t>(id_of_part - 1);
    const Vec3 centroid = sums[part] / static_cast<double>(found.parts.voxel_counts[part]);
    const double distance = (volume::to_vec3(ijk) - centroid).cwiseProduct(labels.geometry.spacing_mm).squaredNorm();
    if (distance >= nearest[part]) return;
    nearest[part] = distance;
    found.middle[part] = ijk;
  });
  return found;
}

std::vector<double> distances_to_main_mm(const LabelParts& parts) {
  volume::MaskGrid main(parts.parts.ids.geometry);
  for (std::size_t n = 0; n < main.voxels.size(); ++n) main.voxels[n] = parts.parts.ids.voxels[n] == 1 ? 1 : 0;
  const volume::FloatGrid to_main_mm = volume::distance_to_mask_mm(main);
  std::vector<double> nearest(parts.count(), std::numeric_limits<double>::infinity());
  for (std::size_t n = 0; n < main.voxels.size(); ++n) {
    if (const auto part = parts.parts.ids.voxels[n]; part != 0) {
      double& here = nearest[static_cast<std::size_t>(part - 1)];
      here = std::min(here, static_cast<double>(to_main_mm.voxels[n]));
    }
  }
  return nearest;
}

bool is_one_part(const anatomy::Label& label) {
  if (label.is_derived) return false;
  for (const char* tissue : {"vessel", "bowel", "liver_lesion", "cartilage", "adipose", "soft_tissue", "lung", "gas",
                             "ascites", "peritoneum", "bile_duct", "ligament", "ligamentum_flavum", "fluid"})
    if (label.tissue == tissue) return false;
  const std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
  return std::find(kSeveral.begin(), kSeveral.end(), plain) == kSeveral.end();
}

int rib_number(const anatomy::Label& label) {
  const std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
  if (label.tissue != "bone" || !plain.starts_with("rib") || plain.size() < 4 || plain.size() > 5) return 0;
  int number = 0;
  for (const char c : plain.substr(3)) {
    if (c < '0' || c > '9') return 0;
    number = 10 * number + (c - '0');
  }
  return number <= 12 ? number : 0;
}

std::string amount_text(std::size_t count, const char* one, const char* many, double volume_ml) {
  return fmt::format("{} {} ({:.{}f} ml)", count, count == 1 ? one : many, volume_ml, volume_ml < 0.1 ? 2 : 1);
}

}  // namespace trocar::patient_builder::detail
