#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "anatomy/phantom/phantom.h"

namespace trocar::anatomy::phantom {

/// Layered test scenes: a block of 80 x 140 x 80 mm with flat skin, the layers of one kind of puncture as slabs,
/// structures next to the path, and one straight expert path. For force curves and tests. The needle enters
/// "layers-lumbar" from the back (+y), the others from the front (-y).
const std::vector<PhantomInfo>& layered_scenes();

/// The scene of that name, 0.8 mm voxels where the resolution says nothing. The seed changes texture and noise alone:
/// the same anatomy for every seed. Error: unknown name.
Result<VirtualPatient> make_layered_scene(std::string_view name, std::uint64_t seed,
                                          const PhantomResolution& resolution = {});

/// Depths below the skin on the expert path (mm), for tests and docs. Those without a source are assumed.
namespace lumbar {
inline constexpr float kSupraspinous = 13.0F;  ///< assumed: skin 2 mm and fat.
inline constexpr float kInterspinous = 17.0F;  ///< assumed.
inline constexpr float kFlavum = 48.0F;        ///< assumed.
inline constexpr float kEpidural = 51.2F;      ///< The flavum is 3.2 mm thick (doi 10.5603/FM.a2021.0120, L2-L3).
inline constexpr float kDura = 57.2F;          ///< The epidural space is about 6 mm deep (Senac 2019).
inline constexpr float kSacEnd = 72.0F;        ///< assumed.
}  // namespace lumbar
namespace ascites {
inline constexpr float kMuscle = 8.0F;       ///< assumed.
inline constexpr float kMuscleEnd = 17.0F;   ///< assumed.
inline constexpr float kPeritoneum = 18.0F;  ///< Wall 18 mm, left lower quadrant (PMID 16162157).
inline constexpr float kBowel = 47.0F;       ///< Fluid 29 mm deep (PMID 16162157).
}  // namespace ascites
namespace liver {
inline constexpr float kMuscle = 14.0F;      ///< assumed.
inline constexpr float kPeritoneum = 23.0F;  ///< assumed.
inline constexpr float kCapsule = 24.2F;     ///< assumed.
inline constexpr float kDuct = 58.0F;        ///< Centre of the bile duct, assumed.
inline constexpr float kDuctRadius = 3.0F;   ///< assumed: dilated.
inline constexpr float kVein = 74.0F;        ///< Centre of the portal vein's branch behind it, assumed.
inline constexpr float kVeinRadius = 4.5F;   ///< assumed.
}  // namespace liver

}  // namespace trocar::anatomy::phantom
