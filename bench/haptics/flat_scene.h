#pragma once

#include <memory>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"
#include "link/messages.h"

namespace trocar::bench {

/// A layer of tissue that begins at this depth (mm) below the skin.
struct FlatLayer {
  double from_mm;
  std::string tissue;
};

/// A flat patient of layers: skin at z = 0, inside at z > 0, 1 mm voxels, 100 mm deep, CT with a typical HU of every
/// tissue, everything labelled. Errors: more than 255 layers.
Result<std::shared_ptr<const anatomy::VirtualPatient>> make_flat_patient(const std::vector<FlatLayer>& layers);

/// Request of a flat patient below the room: z of the room points up, the needle points down at the skin, its tip 20 mm
/// below it when the stylus is at the room's origin.
link::LoadScene flat_request();

/// Typical HU of a tissue of the table, plain CT. [assumed] textbook values; unknown: 40.
double typical_hu(std::string_view tissue) noexcept;

}  // namespace trocar::bench
