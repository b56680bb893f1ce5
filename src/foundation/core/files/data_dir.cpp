#include "core/files/data_dir.h"

#include <cstdlib>

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;

fs::path data_dir() {
  if (const char* named = std::getenv("TROCAR_DATA_DIR"); named != nullptr && *named != '\0') return named;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    for (const fs::path& candidate : {folder / "data", folder / "share" / "trocar"}) {
      if (fs::exists(candidate / "tissues.toml", ignored)) return candidate;
    }
  }
  return {};
}

Result<fs::path> checked_data_dir() {
  fs::path folder = data_dir();
  if (folder.empty())
    return fail("the folder with Trocar's tables was not found", "TROCAR_DATA_DIR", "set it to the folder data");
  return folder;
}

}  // namespace core
}  // namespace trocar
