#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "cases/prepare_case.h"
#include "io/patient/patient_cache.h"

namespace trocar::testing {

/// The usual case in an embedded patient, which is generated once for all tests (XDG_CACHE_HOME of ctest).
inline Result<cases::Case> phantom_case(std::string_view name) {
  TROCAR_TRY(anatomy::VirtualPatient patient, io::open_patient({std::string(name), 1, io::patient_cache_folder()}));
  return cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(patient)), {});
}

}  // namespace trocar::testing
