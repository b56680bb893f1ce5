#include "haptics/insertion/insertion_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptics/contact/contact_balance.h"
#include "volume/sampling.h"

namespace trocar::haptics {

void start_channel(InsertionPath& path, const Vec3& origin_P, const Vec3& direction_P) noexcept {
  path.channel.is_used = true;
  path.channel.origin_P = origin_P;
  path.channel.direction_P = direction_P;
  path.channel.nodes.count = 0;
  path.channel.pierced = 0;
  path.channel.cut_to_mm = 0.0;
  path.channel.forget_bins();
}

void open_path(InsertionPath& path, std::uint8_t skin_layer, const motion::PatientMotion& motion) noexcept {
  path.is_open = true;
  if (skin_layer != kNoLayer) path.channel.pierce(skin_layer);
  path.rest_mm = 0.0;
  path.channel.forget_bins();  // the line may have rotated while the skin was loaded
  begin_nodes(path.channel, motion);
}

EnteredLabels move_tip(InsertionPath& path, const PatientNow& now, double rest_mm, std::uint8_t loading) noexcept {
  const HapticScene& scene = now.scene;
  EnteredLabels entered;
  const auto is_held_back = [&](std::size_t bin) {
    return loading != kNoLayer && scene.tissues[path.channel.tissue[bin]].layer == loading;
  };
  std::size_t count = 0;
  const double low = std::min(path.rest_mm, rest_mm);
  const double high = std::max(path.rest_mm, rest_mm);
  const bool is_forward = rest_mm > path.rest_mm;
  const int end = bin_of(high);
  for (int bin = bin_of(low); bin <= end && high > low; ++bin) {
    const auto index = static_cast<std::size_t>(bin);
    const double length = std::min(high, (bin + 1) * Channel::kBin_mm) - std::max(low, bin * Channel::kBin_mm);
    if (length > 0.0) {
      double& inserted = path.inserted_mm[path.channel.tissue[index]];
      inserted = std::max(0.0, is_forward ? inserted + length : inserted - length);
    }
    const std::uint8_t label = path.channel.label[index];
    // A tip at the border of a bin is not in the next bin.
    if (!is_forward || length <= 0.0 || label == path.label || is_held_back(index)) continue;
    path.label = label;
    if (label != 0 && count < entered.labels.size())
      entered.labels[count++] = label;
    else if (label != 0)
      entered.is_overflown = true;
  }
  const auto last = static_cast<std::size_t>(bin_of(rest_mm));
  if (rest_mm < path.rest_mm && !is_held_back(last)) path.label = path.channel.label[last];
  path.travel_mm += high - low;
  path.rest_mm = rest_mm;
  path.channel.cut_to_mm = std::max(path.channel.cut_to_mm, rest_mm);
  extend_nodes(path.channel, now.motion);
  return entered;
}

void leave_body(InsertionPath& path) noexcept {
  if (path.is_open) path.memory.remember(path.channel);
  path.is_open = false;
  path.bed_out_n = path.bed_out_n_per_mm = 0.0;
  path.contact_to_puncture_P = Vec3::Zero();
  path.rest_mm = 0.0;
  path.label = 0;
  path.inserted_mm.fill(0.0);
}

namespace {

constexpr double kAtSurface_mm = 1e-6;

/// Distance (mm) back along the axis from a tip inside the body to the skin; the longest needle's length if there is
/// none.
double distance_to_skin_back_mm(const PatientNow& now, const Vec3& tip_P, const Vec3& axis_P) noexcept {
  constexpr double kStep_mm = 1.0;
  constexpr double kLongest_mm = (Channel::kBins - 1) * Channel::kBin_mm;
  double inside = -skin_distance_mm(now, tip_P);
  for (double back = kStep_mm; back < kLongest_mm; back += kStep_mm) {
    const double next = -skin_distance_mm(now, tip_P - back * axis_P);
    if (next <= 0.0) return back - kStep_mm * (-next) / (inside - next);
    inside = next;
  }
  return kLongest_mm;
}

std::uint8_t layer_at(const Channel& channel, const HapticScene& scene, int bin) noexcept {
  return scene.tissues[channel.tissue[static_cast<std::size_t>(bin)]].layer;
}

/// Depth of a tip that presses on bone: at its surface. A tip further in than any press is taken as it is.
double in_front_of_bone(const Channel& channel, const HapticScene& scene, double tip_mm) noexcept {
  constexpr int kDeepest = static_cast<int>(5.0 / Channel::kBin_mm);
  const auto is_bone = [&](int bin) {
    const std::uint8_t layer = layer_at(channel, scene, bin);
    return layer != kNoLayer && std::isinf(scene.layers[layer].puncture_force_n);
  };
  const int tip = bin_of(tip_mm);
  int bin = tip;
  while (bin > 0 && tip - bin <= kDeepest && is_bone(bin)) --bin;
  return bin == tip || is_bone(bin) ? tip_mm : (bin + 1) * Channel::kBin_mm - kAtSurface_mm;
}

}  // namespace

bool resume_inside(InsertionPath& path, const PatientNow& now, const Vec3& tip_P, const Vec3& axis_P) noexcept {
  if (!(skin_distance_mm(now, tip_P) < 0.0)) return false;
  const HapticScene& scene = now.scene;
  const double tip_mm = distance_to_skin_back_mm(now, tip_P, axis_P);
  start_channel(path, tip_P - tip_mm * axis_P, axis_P);
  open_path(path, scene.tissues[scene.skin].layer, now.motion);
  while (path.channel.known_bins <= bin_of(tip_mm)) look_ahead(path.channel, now, tip_mm, 0.0);
  const double depth_mm = in_front_of_bone(path.channel, scene, tip_mm);
  for (int bin = 0; bin <= bin_of(depth_mm); ++bin) {
    const std::uint8_t layer = layer_at(path.channel, scene, bin);
    if (layer != kNoLayer) path.channel.pierce(layer);
  }
  move_tip(path, now, depth_mm, kNoLayer);
  return true;
}

double skin_distance_mm(const PatientNow& now, const Vec3& p_P) noexcept {
  const volume::FloatGrid& distance = now.scene.patient->skin_distance_mm;
  const Vec3 p_A = now.motion.to_rest(p_P);
  const double at_rest_mm = volume::sample_linear(distance, p_A);
  if (now.motion.is_rest()) return at_rest_mm;
  // The unit gradient of the distance at rest, now: how much nearer the skin is now than at rest.
  const Vec3 gradient_A = volume::gradient_per_mm(distance, p_A).stableNormalized();
  const double per_mm = now.motion.gradient_to_now(p_A, gradient_A).norm();
  return per_mm > 0.0 ? at_rest_mm / per_mm : at_rest_mm;
}

Vec3 inward_normal(const PatientNow& now, const Vec3& p_P) noexcept {
  const Vec3 p_A = now.motion.to_rest(p_P);
  const Vec3 gradient_A = volume::gradient_per_mm(now.scene.patient->skin_distance_mm, p_A);
  return -now.motion.gradient_to_now(p_A, gradient_A).stableNormalized();
}

Vec3 nearest_skin(const PatientNow& now, const Vec3& p_P) noexcept {
  constexpr int kSteps = 3;
  Vec3 here_P = p_P;
  for (int i = 0; i < kSteps; ++i) here_P += skin_distance_mm(now, here_P) * inward_normal(now, here_P);
  return here_P;
}

Vec3 meet_skin(const PatientNow& now, const Vec3& outside_P, const Vec3& inside_P) noexcept {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.5 * (low + high);
    (skin_distance_mm(now, outside_P + t * (inside_P - outside_P)) > 0.0 ? low : high) = t;
  }
  return outside_P + low * (inside_P - outside_P);
}

SkinContact begin_contact(const PatientNow& now, const Vec3& anchor_P) noexcept {
  SkinContact contact;
  contact.anchor_P = anchor_P;
  contact.anchor_A = now.motion.to_rest(anchor_P);
  contact.slides_P = now.motion.velocity(contact.anchor_A);
  return contact;
}

void follow_skin(SkinContact& contact, const PatientNow& now, const Vec3& device_tip_P, double friction,
                 double dt_s) noexcept {
  constexpr int kMostSteps = 4;
  constexpr double kOnCone_mm = 1e-9;
  const Vec3 before_P = contact.anchor_P;
  if (!now.motion.is_rest()) contact.anchor_P = now.motion.to_now(contact.anchor_A);
  Vec3 normal_P = inward_normal(now, contact.anchor_P);
  Vec3 way = device_tip_P - contact.anchor_P;
  for (int i = 0; i < kMostSteps; ++i) {
    const double deep_mm = way.dot(normal_P);
    const Vec3 beside = way - deep_mm * normal_P;
    const double beyond_mm = beside.norm() - friction * std::max(0.0, deep_mm);
    if (!(beyond_mm > kOnCone_mm)) break;
    contact.anchor_P = nearest_skin(now, contact.anchor_P + beyond_mm * beside.normalized());
    normal_P = inward_normal(now, contact.anchor_P);
    way = device_tip_P - contact.anchor_P;
  }
  contact.anchor_A = now.motion.to_rest(contact.anchor_P);
  contact.slides_P += dt_s / (dt_s + kVelocitySmoothing_s) * ((contact.anchor_P - before_P) / dt_s - contact.slides_P);
  const double deep_mm = way.dot(normal_P);
  contact.to_device_mm = deep_mm > 0.0 ? way.norm() : deep_mm;
  contact.way_P = deep_mm > 0.0 ? Vec3(way.stableNormalized()) : normal_P;
}

double piercing_share(const SkinContact& contact, const PatientNow& now, const Vec3& axis_P) noexcept {
  const double share = axis_P.dot(contact.way_P);
  return share > kGrazing && axis_P.dot(inward_normal(now, contact.anchor_P)) > kGrazing ? share : 0.0;
}

namespace {

double young_kpa(const HapticScene& scene, const Vec3& p_A) noexcept {
  const TissueAt here = tissue_at(scene, p_A);
  if (is_read_from_ct(scene, here) && scene.transfer.knot_count > 0 && !scene.patient->ct.empty())
    return scene.transfer.at(volume::sample_linear(scene.patient->ct, p_A)).young_kpa;
  return scene.tissues[here.tissue].young_kpa;
}

}  // namespace

double SoftColumn::depression_mm(double force_n) const noexcept {
  if (!(force_n > 0.0)) return 0.0;
  const double pressure = force_n / area_mm2;
  double depression_mm = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(cells); ++i) {
    const double load = pressure * share[i];
    depression_mm += thickness_mm[i] * load / (plane_n_per_mm2[i] + load);
  }
  return depression_mm;
}

SoftColumn soft_column(const PatientNow& now, const Vec3& surface_P, const Vec3& inward_P, double radius_mm,
                       double least_kpa) noexcept {
  SoftColumn column;
  column.area_mm2 = std::numbers::pi * radius_mm * radius_mm;
  for (std::size_t i = 0; i < kColumnCells; ++i) {
    const double from_mm = kCellBorder_mm[i];
    const double to_mm = kCellBorder_mm[i + 1];
    const double young = young_kpa(now.scene, now.motion.to_rest(surface_P + 0.5 * (from_mm + to_mm) * inward_P));
    if (young >= kRigid_kpa || !(young > 0.0)) break;
    column.thickness_mm[i] = to_mm - from_mm;
    column.share[i] = (settlement_mm(to_mm, radius_mm) - settlement_mm(from_mm, radius_mm)) / (to_mm - from_mm);
    column.plane_n_per_mm2[i] =
        kNPerMm2PerKpa * std::max({young, least_kpa, kSoftest_kpa}) / (1.0 - kPoisson * kPoisson);
    ++column.cells;
  }
  return column;
}

}  // namespace trocar::haptics
