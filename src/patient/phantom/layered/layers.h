#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "phantom/phantom.h"

namespace trocar::phantom {

/// Layered test scenes: a block of 80 x 140 x 80 mm with flat skin, the layers of one kind of puncture as slabs,
/// structures next to the path, and one straight expert path. For force curves and tests. The needle enters
/// "layers-lumbar" from the back (+y), the others from the front (-y).
const std::vector<PhantomInfo>& layered_scenes();

/// Makes the scene of that name, with 0.8 mm voxels if the resolution is the default. The seed changes only texture and
/// noise: the anatomy is the same for every seed. Errors: unknown name; data of the folder data_dir() that are missing
/// or broken.
Result<anatomy::VirtualPatient> make_layered_scene(std::string_view name, std::uint64_t seed,
                                                   const PhantomResolution& resolution = {});

}  // namespace trocar::phantom
