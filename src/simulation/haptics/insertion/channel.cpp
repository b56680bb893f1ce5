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

void Channel::forget_bins_from(int bin, const HapticScene& scene) noexcept {
  forget_bins();
  while (known_bins < bin) {
    wall_at_next_bin(*this, walled_layer(scene, tissue[static_cast<std::size_t>(known_bins)]), known_bins);
    ++known_bins;
  }
}

ChannelLine needle_line(const Channel& channel, const motion::PatientMotion& motion, double tip_mm,
                        double ahead_s) noexcept {
  constexpr double kStiff_mm = 20.0;  // length (4 EI/k)^(1/4) of a needle of 22 G in a bed of 0.05 N/mm² [assumed]
  constexpr double kGuide_mm = 10.0;  // so far before the tip its old hole guides the needle [assumed]
  constexpr int kEvery = 2;           // nodes
  const ChannelNodes& nodes = channel.nodes;
  double w = 0.0, wx = 0.0, wxx = 0.0;  // x: s from the tip
  Vec3 wp = Vec3::Zero(), wxp = Vec3::Zero();
  const auto add = [&](int node) {
    const double x = ChannelNodes::kNode_mm * node - tip_mm;
    const double weight = std::exp(-std::abs(x) / kStiff_mm) * std::clamp(1.0 - x / kGuide_mm, 0.0, 1.0);
    if (!(weight > 0.0)) return;
    const Vec3& p_A = nodes.p_A[static_cast<std::size_t>(node)];
    Vec3 p_P = motion.to_now(p_A);
    if (ahead_s != 0.0) p_P += ahead_s * motion.velocity(p_A);
    w += weight;
    wx += weight * x;
    wxx += weight * x * x;
    wp += weight * p_P;
    wxp += weight * x * p_P;
  };
  const int every = nodes.count > kEvery * kEvery ? kEvery : 1;
  for (int node = 0; node < nodes.count; node += every) add(node);
  constexpr double kOnePlace_mm2 = 1.0;
  const double spread = w * wxx - wx * wx;
  if (spread > kOnePlace_mm2 * w * w) {
    const Vec3 slope_P = (w * wxp - wx * wp) / spread;
    const Vec3 direction_P = slope_P.normalized();
    return {(wp - wx * slope_P) / w - tip_mm * direction_P, direction_P};
  }
  const Vec3& first_A = nodes.p_A[0];
  const Vec3 direction_P = motion.line_to_now(first_A, nodes.onward_A).normalized();
  return {motion.to_now(first_A) + ahead_s * motion.velocity(first_A), direction_P};
}

Vec3 ChannelNow::node_tangent_P(int node) const noexcept {
  if (node + 1 >= channel_.nodes.count) return channel_.direction_P;
  return (node_P(node + 1) - node_P(std::max(0, node - 1))).normalized();
}

Vec3 ChannelNow::point_P(double s_mm) const noexcept {
  if (channel_.nodes.count == 0 || s_mm >= channel_.nodes.end_mm())
    return channel_.origin_P + s_mm * channel_.direction_P;
  return motion_.to_now(rest_A(s_mm));
}

Vec3 ChannelNow::tangent_P(double s_mm) const noexcept {
  if (channel_.nodes.count == 0) return channel_.direction_P;
  const double at = std::clamp(s_mm, 0.0, channel_.nodes.end_mm()) / ChannelNodes::kNode_mm;
  const int node = static_cast<int>(at);
  const Vec3 before_P = node_tangent_P(node);
  return (before_P + (at - node) * (node_tangent_P(node + 1) - before_P)).normalized();
}

Vec3 ChannelNow::rest_A(double s_mm) const noexcept {
  const ChannelNodes& nodes = channel_.nodes;
  if (nodes.count == 0 || s_mm >= nodes.end_mm()) return motion_.to_rest(point_P(s_mm));
  const double at = s_mm / ChannelNodes::kNode_mm;
  const auto node = static_cast<std::size_t>(std::max(0.0, at));
  return nodes.p_A[node] + (at - static_cast<double>(node)) * (nodes.p_A[node + 1] - nodes.p_A[node]);
}

void begin_nodes(Channel& channel, const motion::PatientMotion& motion) noexcept {
  channel.nodes.count = 0;
  if (motion.is_rest()) return;
  channel.nodes.count = 1;
  channel.nodes.p_A[0] = motion.to_rest(channel.origin_P);
  channel.nodes.onward_A = motion.line_to_rest(channel.nodes.p_A[0], channel.direction_P);
}

void extend_nodes(Channel& channel, const motion::PatientMotion& motion) noexcept {
  ChannelNodes& nodes = channel.nodes;
  if (nodes.count == 0 || channel.cut_to_mm < nodes.end_mm() + ChannelNodes::kNode_mm) return;
  while (nodes.count < ChannelNodes::kMost && channel.cut_to_mm >= nodes.end_mm() + ChannelNodes::kNode_mm) {
    // A needle cuts where it points.
    const Vec3 p_P = channel.origin_P + (nodes.end_mm() + ChannelNodes::kNode_mm) * channel.direction_P;
    nodes.p_A[static_cast<std::size_t>(nodes.count)] = motion.to_rest(p_P);
    ++nodes.count;
  }
}

void carry(Channel& channel, const PatientNow& now, double tip_mm) noexcept {
  if (channel.nodes.count == 0) return;
  constexpr double kMoved_mm = 0.5 * Channel::kBin_mm;
  const ChannelLine line = needle_line(channel, now.motion, tip_mm);
  channel.origin_P = line.origin_P;
  channel.direction_P = line.direction_P;
  const ChannelNow course(channel, now.motion);
  const int cut = bin_of(channel.cut_to_mm) + 1;
  if (channel.known_bins <= cut) return;
  for (std::size_t i = 0; i < channel.nodes.seen_mm.size(); ++i) {
    if ((course.rest_A(channel.nodes.seen_mm[i]) - channel.nodes.seen_A[i]).norm() < kMoved_mm) continue;
    channel.forget_bins_from(cut, now.scene);
    return;
  }
}

void look_ahead(Channel& channel, const PatientNow& now, double s_mm, double ahead_mm) noexcept {
  const HapticScene& scene = now.scene;
  const int wanted = bin_of(s_mm + ahead_mm) + 1;
  const int last = std::min(wanted, channel.known_bins + kMaxBinsPerLook);
  if (last <= channel.known_bins) return;
  const bool reads_ct = scene.options.force_model != ForceModel::kInsertion;
  const ChannelNow course(channel, now.motion);
  for (int bin = channel.known_bins; bin < last; ++bin) {
    const double middle_mm = (bin + 0.5) * Channel::kBin_mm;
    const Vec3 middle_A = course.rest_A(middle_mm);
    const TissueAt here = tissue_at(scene, middle_A);
    const auto index = static_cast<std::size_t>(bin);
    channel.tissue[index] = here.tissue;
    channel.label[index] = here.label;
    channel.wall[index] = wall_at_next_bin(channel, walled_layer(scene, here.tissue), bin);
    if (reads_ct)
      channel.hu[index] = static_cast<std::int16_t>(std::lround(volume::sample_linear(scene.patient->ct, middle_A)));
  }
  channel.known_bins = last;
  if (channel.nodes.count == 0) return;
  channel.nodes.seen_mm = {0.5 * (channel.cut_to_mm + last * Channel::kBin_mm), last * Channel::kBin_mm};
  for (std::size_t i = 0; i < channel.nodes.seen_mm.size(); ++i)
    channel.nodes.seen_A[i] = course.rest_A(channel.nodes.seen_mm[i]);
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

const Channel* ChannelMemory::find(const Vec3& entry_P, const Vec3& axis_P,
                                   const motion::PatientMotion& motion) const noexcept {
  for (const Channel& channel : channels) {
    if (!channel.is_used) continue;
    const ChannelLine line = channel.nodes.count == 0 ? ChannelLine{channel.origin_P, channel.direction_P}
                                                      : needle_line(channel, motion, 0.0);
    if ((line.origin_P - entry_P).norm() < kSameHole_mm && angle_between_rad(line.direction_P, axis_P) < kSameHole_rad)
      return &channel;
  }
  return nullptr;
}

void ChannelMemory::remember(const Channel& channel) noexcept {
  const auto is_same = [&](const Channel& known) {
    if (channel.nodes.count > 0) return known.nodes.count > 0 && known.nodes.p_A[0] == channel.nodes.p_A[0];
    return known.origin_P == channel.origin_P && known.direction_P == channel.direction_P;
  };
  for (Channel& known : channels) {
    if (known.is_used && is_same(known)) {
      known = channel;
      return;
    }
  }
  channels[static_cast<std::size_t>(next)] = channel;
  next = (next + 1) % kCapacity;
}

}  // namespace trocar::haptics
