#pragma once

#include <string_view>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {

/// Segment of the liver after Couinaud, "I" to "VIII", of a place inside the liver. Borders: the plane of the middle
/// hepatic vein from the vena cava to the gallbladder, that of the right hepatic vein, the fissure of the round
/// ligament, and the height of the portal vein's fork; the caudate lobe lies between vena cava and hilum.
std::string_view liver_segment(const Anatomy& anatomy, const Place& place);

}  // namespace trocar::anatomy::phantom
