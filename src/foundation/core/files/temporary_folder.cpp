#include "core/files/temporary_folder.h"

#include <unistd.h>

#include <cstdlib>
#include <string>

#include "core/check.h"
#include "core/files/unfinished_output.h"

namespace trocar {
inline namespace core {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "trocar-XXXXXX").string();
  TROCAR_CHECK(::mkdtemp(pattern.data()) != nullptr);
  path_ = pattern;
  register_unfinished_output(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  unregister_unfinished_output(path_);
}

}  // namespace core
}  // namespace trocar
