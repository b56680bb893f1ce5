#pragma once

#include <memory>
#include <string_view>

#include "anatomy/phantom/phantom.h"
#include "cases/prepare_case.h"

namespace trocar::testing {

/// The usual case in a generated patient.
inline Result<cases::Case> phantom_case(std::string_view name) {
  TROCAR_TRY(anatomy::VirtualPatient patient, anatomy::generate_phantom(name));
  return cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(patient)), {});
}

}  // namespace trocar::testing
