#pragma once

#include <memory>

#include "cases/open_case.h"
#include "core/files/user_folders.h"

namespace trocar::testing {

/// A case as the programs open it: an embedded patient is generated once for all tests (XDG_CACHE_HOME of ctest).
inline Result<std::shared_ptr<const cases::OpenCase>> open_cached_case(const cases::CaseChoice& choice = {}) {
  return cases::make_open_case(choice, {nullptr, user_cache_folder() / "patients"});
}

}  // namespace trocar::testing
