#pragma once

#include <span>

#include "volume/image.h"

namespace trocar::scene {

/// Preset of the CT volume rendering.
enum class VolumePreset { kNone, kBone, kSoftTissue, kVessels, kSkinAndBone };

/// A point of a transfer function, which is linear between points and constant outside.
struct TransferPoint {
  double hu;
  volume::Rgb color;
  double opacity;  ///< Opacity of a path of 1 mm, 0..1.
};

/// Points by rising HU; empty for kNone.
std::span<const TransferPoint> transfer_function(VolumePreset preset) noexcept;

}  // namespace trocar::scene
