#pragma once

#include "phantom/phantom.h"

namespace trocar::slices {

/// The embedded abdomen on a coarse grid, for fast generation.
inline const anatomy::VirtualPatient& coarse_abdomen() {
  static const anatomy::VirtualPatient patient = phantom::generate_phantom("abdomen", 1, {{90, 72, 64}}).value();
  return patient;
}

}  // namespace trocar::slices
