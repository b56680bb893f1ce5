#pragma once

#include <gtest/gtest.h>

#include <string_view>

#include "anatomy/tissue/tissue_table.h"
#include "core/files/folders.h"

namespace trocar::testing {

/// The table of the data folder.
inline anatomy::TissueTable shipped_tissues(std::string_view profile = {}) {
  auto table = anatomy::load_tissue_table(data_dir() / "tissues.toml", profile);
  EXPECT_TRUE(table) << (table ? "" : table.error().text());
  return table.value_or(anatomy::TissueTable{});
}

}  // namespace trocar::testing
