#include "haptics/insertion/channel.h"

#include <algorithm>
#include <cmath>

#include "volume/sampling.h"

namespace trocar::haptics {

int bin_of(double s_mm) noexcept {
  return std::clamp(static_cast<int>(std::max(0.0, s_mm) / Channel::kBin_mm), 0, Channel::kBins - 1);
}

namespace {

/// The wall at the border into a structure. Moving from a walled structure back into the one around it (a vessel in the
/// liver), or back after a short gap in its label, pierces nothing.
std::uint8_t wall_at_next_bin(Channel& channel, std::uint8_t layer, int bin) noexcept {
  if (layer == channel.wall_here) return kNoLayer;
  const bool is_gap = (bin - channel.wall_since) * Channel::kBin_mm < kSameStructure_mm;
  const bool is_return = layer == channel.wall_before && (channel.wall_here != kNoLayer || is_gap);
  channel.wall_before = channel.wall_here;
  channel.wall_here = layer;
  channel.wall_since = bin;
  return is_return ? kNoLayer : layer;
}

std::uint8_t walled_layer(const HapticScene& scene, std::uint8_t tissue) noexcept {
  const std::uint8_t layer = scene.tissues[tissue].layer;
  const bool is_walled = tissue != scene.skin && layer != kNoLayer && scene.layers[layer].is_wall;
  return is_walled ? layer : kNoLayer;  // the skin is pierced where the path starts
}

}  // namespace

void look_ahead(Channel& channel, const HapticScene& scene, double s_mm, double ahead_mm) noexcept {
  const int wanted = bin_of(s_mm + ahead_mm) + 1;
  const int last = std::min(wanted, channel.known_bins + kMaxBinsPerLook);
  const bool reads_ct = scene.options.force_model != ForceModel::kInsertion;
  for (int bin = channel.known_bins; bin < last; ++bin) {
    const double middle_mm = (bin + 0.5) * Channel::kBin_mm;
    const Vec3 middle_P = channel.origin_P + channel.direction_P * middle_mm;
    const TissueAt here = tissue_at(scene, middle_P);
    const auto index = static_cast<std::size_t>(bin);
    channel.tissue[index] = here.tissue;
    channel.label[index] = here.label;
    channel.wall[index] = wall_at_next_bin(channel, walled_layer(scene, here.tissue), bin);
    if (reads_ct)
      channel.hu[index] = static_cast<std::int16_t>(std::lround(volume::sample_linear(scene.patient->ct, middle_P)));
  }
  channel.known_bins = std::max(channel.known_bins, last);
}

LayerAhead next_layer(const Channel& channel, const HapticScene& scene, double from_mm, double to_mm) noexcept {
  const bool only_walls = scene.options.force_model == ForceModel::kCombined;
  const int end = std::min(channel.known_bins, bin_of(to_mm) + 1);
  for (int bin = bin_of(from_mm); bin < end; ++bin) {
    const std::uint8_t layer = scene.tissues[channel.tissue[static_cast<std::size_t>(bin)]].layer;
    if (layer == kNoLayer || channel.is_pierced(layer) || (only_walls && !scene.layers[layer].is_wall)) continue;
    return {layer, std::max(from_mm, bin * Channel::kBin_mm)};
  }
  return {};
}

LayerAhead next_wall(const Channel& channel, double from_mm, double to_mm) noexcept {
  const int end = std::min(channel.known_bins, bin_of(to_mm) + 1);
  for (int bin = bin_of(std::max(from_mm, channel.cut_to_mm)); bin < end; ++bin) {
    const std::uint8_t layer = channel.wall[static_cast<std::size_t>(bin)];
    const double surface_mm = bin * Channel::kBin_mm;
    // A tip that touched a wall may have come a rounding error further; a punctured one is half a bin further.
    if (layer != kNoLayer && surface_mm > channel.cut_to_mm - 0.25 * Channel::kBin_mm) return {layer, surface_mm};
  }
  return {};
}

const Channel* ChannelMemory::find(const Vec3& entry_P, const Vec3& axis_P) const noexcept {
  for (const Channel& channel : channels) {
    if (channel.is_used && (channel.origin_P - entry_P).norm() < kSameHole_mm &&
        angle_between_rad(channel.direction_P, axis_P) < kSameHole_rad)
      return &channel;
  }
  return nullptr;
}

void ChannelMemory::remember(const Channel& channel) noexcept {
  for (Channel& known : channels) {
    if (known.is_used && known.origin_P == channel.origin_P && known.direction_P == channel.direction_P) {
      known = channel;
      return;
    }
  }
  channels[static_cast<std::size_t>(next)] = channel;
  next = (next + 1) % kCapacity;
}

}  // namespace trocar::haptics
