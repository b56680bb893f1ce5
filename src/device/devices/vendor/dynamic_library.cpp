#include "devices/vendor/dynamic_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <vector>

#include "core/files/input_file.h"
#include "devices/vendor/detail/library_trial.h"

namespace trocar::devices {
namespace {

constexpr FileLimit kLibraryFile{FileKind::kOther, "library", std::uint64_t{1} << 30};

std::string last_dl_error() {
  const char* text = dlerror();
  return text != nullptr ? text : "no reason given";
}

/// Only the path of the environment variable if it is set, else the usual names.
std::vector<std::string> candidates_of(const LibraryPlace& place) {
  const char* named = std::getenv(place.variable);
  if (named != nullptr && *named != '\0') return {named};
  return {place.names.begin(), place.names.end()};
}

}  // namespace

Result<DynamicLibrary> DynamicLibrary::open(const LibraryPlace& place) {
  std::vector<std::string> reasons;
  for (std::string& candidate : candidates_of(place)) {
    if (candidate.find('/') != std::string::npos) {
      if (const auto regular = InputFile::open(candidate, kLibraryFile); !regular) {  // a pipe would block
        reasons.push_back(fmt::format("{}: {}", candidate, regular.error().what));
        continue;
      }
    }
    TROCAR_TRY_STATUS(detail::try_library(candidate, place.timeout));
    void* const handle = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle != nullptr) return DynamicLibrary(handle, std::move(candidate));
    reasons.push_back(last_dl_error());
  }
  return fail(fmt::format("{} cannot be loaded", place.package), fmt::format("{}", fmt::join(reasons, "; ")),
              fmt::format("{}, or name the library in {}", place.advice, place.variable));
}

Result<void*> DynamicLibrary::find_symbol(const char* name) const {
  void* const symbol = dlsym(handle_, name);
  if (symbol != nullptr) return symbol;
  return fail(fmt::format("the library has no function {}", name), path_, "install a newer release of it");
}

}  // namespace trocar::devices
