#include "ultrasound/probe/detail/view_anatomy.h"

#include <limits>

#include "core/text.h"
#include "ultrasound/tissue/detail/tissue_volume.h"
#include "volume/sampling.h"

namespace trocar::ultrasound::detail {
namespace {

constexpr double kSlope_mm = 6.0;  ///< The skin's normal is averaged over a patch of this size.
constexpr double kFacingSlab_mm = 8.0;

/// Calls use(point) for every voxel of a label.
template <class Use>
void for_voxels(const volume::LabelGrid& labels, std::uint8_t id, const Use& use) {
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if (labels.voxels[n] == id) use(labels.geometry.centre_mm(labels.geometry.index_of(n)));
  }
}

Vec3 centroid(const volume::LabelGrid& labels, std::uint8_t id) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for_voxels(labels, id, [&](const Vec3& p_P) {
    sum += p_P;
    count += 1.0;
  });
  return sum / count;
}

Vec3 nearest_voxel(const volume::LabelGrid& labels, std::uint8_t id, const Vec3& to_P) {
  Vec3 best_P = to_P;
  double least = std::numeric_limits<double>::infinity();
  for_voxels(labels, id, [&](const Vec3& p_P) {
    const double squared = (p_P - to_P).squaredNorm();
    if (squared < least) {
      least = squared;
      best_P = p_P;
    }
  });
  return best_P;
}

/// Centre of the part of a label nearest to a point.
Vec3 facing_point(const volume::LabelGrid& labels, std::uint8_t id, const Vec3& from_P) {
  const double nearest_mm = (nearest_voxel(labels, id, from_P) - from_P).norm();
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for_voxels(labels, id, [&](const Vec3& p_P) {
    if ((p_P - from_P).norm() > nearest_mm + kFacingSlab_mm) return;
    sum += p_P;
    count += 1.0;
  });
  return nearest_voxel(labels, id, sum / count);
}

}  // namespace

ViewAnatomy::ViewAnatomy(const anatomy::VirtualPatient& of, const ProbeView& view)
    : patient(of), ends(find_scan_ends(of)) {
  for (const anatomy::Label& label : of.label_table.labels) {
    is_bone[label.id] = label.tissue == "bone" || label.tissue == "cartilage";  // the cartilage of ribs
    is_lung[label.id] = label.tissue == "lung" || label.tissue == "gas";
  }
  if (const anatomy::Label* through = find_target(of, view.through)) is_through[through->id] = true;
}

double ViewAnatomy::skin_mm(const Vec3& p_P) const noexcept {
  return volume::sample_linear(patient.skin_distance_mm, p_P);
}

Vec3 ViewAnatomy::skin_normal(const Vec3& p_P) const noexcept {
  Vec3 slope;
  for (int a = 0; a < 3; ++a) {
    const Vec3 step = kSlope_mm * Vec3::Unit(a);
    slope[a] = skin_mm(p_P + step) - skin_mm(p_P - step);
  }
  return slope.norm() > 1e-9 ? Vec3(slope.normalized()) : Vec3(0, -1, 0);
}

Vec3 ViewAnatomy::on_skin(Vec3 p_P) const noexcept {
  for (int round = 0; round < 4; ++round) p_P -= skin_mm(p_P) * skin_normal(p_P);
  return p_P;
}

bool ViewAnatomy::contains(const Vec3& p_P) const noexcept {
  const Vec3 index = patient.labels.geometry.to_index(p_P);
  const volume::Index3& size = patient.labels.geometry.size;
  return (index.array() > -0.5).all() && index.x() < static_cast<double>(size[0]) - 0.5 &&
         index.y() < static_cast<double>(size[1]) - 0.5 && index.z() < static_cast<double>(size[2]) - 0.5;
}

std::uint8_t ViewAnatomy::label_at(const Vec3& p_P) const noexcept {
  return volume::sample_nearest<std::uint8_t>(patient.labels, p_P, 0);
}

bool ViewAnatomy::is_gas_at(const Vec3& p_P) const noexcept {
  return volume::sample_nearest<std::int16_t>(patient.ct, p_P, 0) < kGasBelow_hu;
}

Result<Vec3> find_target_point(const anatomy::VirtualPatient& patient, const ProbeView& view) {
  TROCAR_TRY_STATUS(check_view(patient, view));
  const anatomy::Label* target = find_target(patient, view.targets);
  const anatomy::Label* through = find_target(patient, view.through);
  const Vec3 p_P = view.point == TargetPoint::kFacing
                       ? facing_point(patient.labels, target->id, centroid(patient.labels, through->id))
                       : nearest_voxel(patient.labels, target->id, centroid(patient.labels, target->id));
  return Vec3(p_P + view.offset_mm);
}

std::string plain_name(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (ascii::is_letter_or_digit(c) || c == '*') text += ascii::to_lower(c);
  }
  return text;
}

bool matches_pattern(std::string_view pattern, std::string_view name) noexcept {
  if (pattern.ends_with('*')) return name.starts_with(pattern.substr(0, pattern.size() - 1));
  return pattern == name;
}

}  // namespace trocar::ultrasound::detail
