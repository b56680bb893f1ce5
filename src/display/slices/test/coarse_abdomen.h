#pragma once

#include "anatomy/phantom/phantom.h"

namespace trocar {

/// The embedded abdomen on a grid coarse enough to be made in a moment.
inline const VirtualPatient& coarse_abdomen() {
  static const VirtualPatient patient = generate_phantom("abdomen", 1, {{90, 72, 64}}).value();
  return patient;
}

}  // namespace trocar
