#pragma once

#include <memory>

#include "cases/open_case.h"
#include "io/patient/patient_cache.h"

namespace trocar::testing {

/// A case as the programs open it: an embedded patient is generated once for all tests (XDG_CACHE_HOME of ctest).
inline Result<std::shared_ptr<const cases::OpenCase>> open_cached_case(const cases::CaseChoice& choice = {}) {
  return cases::make_open_case(choice, {nullptr, io::patient_cache_folder()});
}

}  // namespace trocar::testing
