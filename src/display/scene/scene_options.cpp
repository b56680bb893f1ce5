#include "scene/scene_options.h"

namespace trocar::scene {
namespace {

constexpr image::Rgb kSkin = {224, 178, 150};
constexpr image::Rgb kFlesh = {176, 84, 66};
constexpr image::Rgb kBlood = {206, 44, 36};
constexpr image::Rgb kBloodBright = {232, 96, 74};
constexpr image::Rgb kMarrow = {216, 172, 138};
constexpr image::Rgb kBone = {236, 226, 202};
constexpr image::Rgb kBoneWhite = {250, 246, 236};

// Opacities are assumed, tuned by eye on an abdomen in the portal venous phase.
constexpr TransferPoint kBoneRamp[] = {
    {180, kMarrow, 0.0}, {250, kMarrow, 0.12}, {330, kBone, 0.5}, {700, kBoneWhite, 0.9}};
constexpr TransferPoint kSoftTissueRamp[] = {{-20, kFlesh, 0.0},  {40, kFlesh, 0.015}, {110, kFlesh, 0.10},
                                             {180, kBlood, 0.25}, {260, kBone, 0.4},   {900, kBoneWhite, 0.85}};
// Bone has been removed: everything denser than blood is contrast agent or calcified.
constexpr TransferPoint kVesselRamp[] = {
    {140, kBlood, 0.0}, {190, kBlood, 0.25}, {260, kBlood, 0.5}, {450, kBloodBright, 0.7}, {700, kBoneWhite, 0.9}};
// The HU band of the skin is wide enough that a ray does not step over it.
constexpr TransferPoint kSkinAndBoneRamp[] = {{-900, kSkin, 0.0}, {-600, kSkin, 0.11},   {-300, kSkin, 0.11},
                                              {-130, kSkin, 0.0}, {200, kMarrow, 0.0},   {260, kMarrow, 0.14},
                                              {350, kBone, 0.5},  {700, kBoneWhite, 0.9}};

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

}  // namespace trocar::scene
