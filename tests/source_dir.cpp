// The one file that is told where the sources lie: the objects of all others serve another checkout, too.
#include "core/testing/source_dir.h"

namespace trocar::testing {

std::filesystem::path source_dir() {
  return TROCAR_SOURCE_DIR;
}

}  // namespace trocar::testing
