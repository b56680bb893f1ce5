#include "haptics/insertion/insertion_path.h"

#include <algorithm>
#include <cmath>

#include "haptics/insertion/skin_contact.h"

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

}  // namespace trocar::haptics
