#pragma once

#include <filesystem>
#include <string_view>

namespace trocar {
inline namespace core {

/// A new empty folder in the system's folder for temporary files. The destructor removes it with its contents. Aborts
/// if the folder cannot be created.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  bool is_empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

}  // namespace core
}  // namespace trocar
