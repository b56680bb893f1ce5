#pragma once

#include <string_view>
#include <vector>

#include "phantom/structure.h"

namespace trocar::phantom {

/// Of the bile duct's length: where the cystic duct joins.
inline constexpr float kCysticDuctShare = 0.35F;

/// The bile ducts of one liver, in the reference body.
struct DuctTree {
  Tube inside;   ///< In the liver: a duct beside each portal vein.
  Tube outside;  ///< From the hilum to the papilla, with the cystic duct.
};

/// Adds bile ducts and hepatic arteries beside the portal veins, and where the body has one the tumour that closes the
/// bile duct. Ducts have a share of their portal vein's radius, 0.3 normally and more when dilated; those thinner than
/// half a millimetre are left out. A normal intrahepatic duct is at most 2 mm wide and at most 40 % of the portal vein
/// beside it (Bressler et al., Radiology 164:21, 1987).
DuctTree add_bile_ducts(Anatomy& anatomy, const std::vector<Cone>& portal_veins);

/// Segment of the liver after Couinaud, "I" to "VIII", of a place inside the liver. Borders: the plane of the middle
/// hepatic vein from the vena cava to the gallbladder, that of the right hepatic vein, the fissure of the round
/// ligament, and the height of the portal vein's fork; the caudate lobe lies between vena cava and hilum.
std::string_view liver_segment(const Anatomy& anatomy, const Place& place);

}  // namespace trocar::phantom
