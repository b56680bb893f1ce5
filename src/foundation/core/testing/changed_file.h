#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "core/files/folders.h"
#include "core/files/input_file.h"
#include "core/files/output_file.h"

namespace trocar::testing {

/// Result of `load` for a copy of a file in which the first occurrence of `from` is replaced by `to`.
template <class Load>
auto load_changed(const std::filesystem::path& file, std::string_view from, std::string_view to, const Load& load) {
  std::string text = *read_file(file);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  const TemporaryFolder folder;
  EXPECT_TRUE(write_file_atomically(folder / file.filename().string(), text));
  return load(folder / file.filename().string());
}

}  // namespace trocar::testing
