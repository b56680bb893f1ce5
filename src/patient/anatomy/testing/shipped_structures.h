#pragma once

#include <gtest/gtest.h>

#include "anatomy/known_structures.h"
#include "core/files/folders.h"

namespace trocar::testing {

/// The known structures of the data folder.
inline anatomy::KnownStructures shipped_structures() {
  auto known = anatomy::KnownStructures::load(data_dir());
  EXPECT_TRUE(known) << (known ? "" : known.error().text());
  return known.value_or(anatomy::KnownStructures{});
}

}  // namespace trocar::testing
