#include "scene/volume_preset.h"

namespace trocar {
namespace {

constexpr Rgb kSkin = {224, 178, 150};
constexpr Rgb kFlesh = {176, 84, 66};
constexpr Rgb kBlood = {206, 44, 36};
constexpr Rgb kBone = {236, 226, 202};
constexpr Rgb kBoneWhite = {250, 246, 236};

// Opacities are assumed, tuned by eye on an abdomen in the portal venous phase.
constexpr TransferPoint kBoneRamp[] = {
    {160, kBlood, 0.0}, {260, kBone, 0.12}, {450, kBone, 0.5}, {1200, kBoneWhite, 0.9}};
constexpr TransferPoint kSoftTissueRamp[] = {{-20, kFlesh, 0.0},  {40, kFlesh, 0.015}, {110, kFlesh, 0.10},
                                             {180, kBlood, 0.25}, {260, kBone, 0.4},   {900, kBoneWhite, 0.85}};
constexpr TransferPoint kVesselRamp[] = {{125, kBlood, 0.0}, {165, kBlood, 0.22}, {260, kBlood, 0.4},
                                         {340, kBone, 0.2},  {600, kBone, 0.4},   {1200, kBoneWhite, 0.8}};
constexpr TransferPoint kSkinAndBoneRamp[] = {{-700, kSkin, 0.0},     {-400, kSkin, 0.16}, {-170, kSkin, 0.0},
                                              {180, kBone, 0.0},      {300, kBone, 0.2},   {500, kBone, 0.5},
                                              {1200, kBoneWhite, 0.9}};

}  // namespace

std::span<const TransferPoint> transfer_function(VolumePreset preset) noexcept {
  switch (preset) {
    case VolumePreset::kNone:
      return {};
    case VolumePreset::kBone:
      return kBoneRamp;
    case VolumePreset::kSoftTissue:
      return kSoftTissueRamp;
    case VolumePreset::kVessels:
      return kVesselRamp;
    case VolumePreset::kSkinAndBone:
      return kSkinAndBoneRamp;
  }
  return {};
}

}  // namespace trocar
