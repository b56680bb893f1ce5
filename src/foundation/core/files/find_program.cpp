#include "core/files/find_program.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

std::optional<fs::path> find_program(std::string_view name) {
  std::error_code ignored;
  const fs::path self = fs::read_symlink("/proc/self/exe", ignored);
  if (const fs::path beside = self.parent_path() / name; !self.empty() && is_program(beside)) return beside;
  const char* folder = std::getenv("TROCAR_BIN_DIR");
  if (folder != nullptr && *folder != '\0' && is_program(fs::path(folder) / name)) return fs::path(folder) / name;
  const char* path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path entry(rest.substr(0, end));
    if (!entry.empty() && is_program(entry / name)) return entry / name;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::nullopt;
}

}  // namespace core
}  // namespace trocar
