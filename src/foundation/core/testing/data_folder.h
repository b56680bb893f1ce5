#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::testing {

/// A copy of the data folder that data_dir() returns during the lifetime of this object. For single-threaded tests.
class OwnDataFolder {
 public:
  OwnDataFolder() : before_(data_dir()) {
    std::filesystem::copy(before_, folder_.path(), std::filesystem::copy_options::recursive);
    ::setenv("TROCAR_DATA_DIR", folder_.path().c_str(), 1);
  }
  ~OwnDataFolder() { ::setenv("TROCAR_DATA_DIR", before_.c_str(), 1); }
  OwnDataFolder(const OwnDataFolder&) = delete;
  OwnDataFolder& operator=(const OwnDataFolder&) = delete;

  /// Replaces the first occurrence of `from` in a file.
  void change(std::string_view file, std::string_view from, std::string_view to) const {
    std::string text = *read_file(folder_ / file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    ASSERT_TRUE(write_file_atomically(folder_ / file, text));
  }
  void remove(std::string_view file) const { std::filesystem::remove(folder_ / file); }

 private:
  std::filesystem::path before_;
  TemporaryFolder folder_;
};

}  // namespace trocar::testing
