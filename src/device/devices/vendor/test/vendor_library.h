#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "core/testing/source_dir.h"

namespace trocar::testing {

/// Tolerance of poses and forces: rotations by right angles are exact but for rounding.
inline constexpr double kTiny = 1e-9;

/// Loads the stand-in for a vendor's library from the test tree and sets the environment variable with which Trocar
/// finds it. Returns the controls of the stand-in.
template <class StandIn>
StandIn* use_stand_in(const char* variable, const char* file, const char* function) {
  const std::filesystem::path path = standin_dir() / file;
  setenv(variable, path.c_str(), 1);
  void* library = dlopen(path.c_str(), RTLD_NOW);
  if (library == nullptr) {
    ADD_FAILURE() << dlerror();
    return nullptr;
  }
  const auto stand_in = reinterpret_cast<StandIn* (*)()>(dlsym(library, function));
  return stand_in != nullptr ? stand_in() : nullptr;
}

}  // namespace trocar::testing
