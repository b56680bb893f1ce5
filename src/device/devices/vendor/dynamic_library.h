#pragma once

#include <chrono>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::devices {

/// Search places of a vendor's library, and the advice in the error message if it is missing.
struct LibraryPlace {
  const char* variable = nullptr;      ///< Environment variable that names another path: "TROCAR_LIBHD".
  std::span<const char* const> names;  ///< File names, tried in this order by the system's search rules: "libHD.so".
  std::string_view package;            ///< Name of the missing package: "the OpenHaptics toolkit".
  std::string_view advice;             ///< How to get the package.
  std::chrono::milliseconds timeout{10'000};  ///< Longest time of loading. [assumed: drivers load within a second]
};

/// A shared library loaded at run time. It stays loaded until the process ends: vendors' drivers cannot be unloaded
/// safely (CHAI3D, src/devices/CPhantomDevices.cpp, on the PHANTOM driver).
class DynamicLibrary {
 public:
  /// Binds all symbols at once, so that the first call of a function needs no symbol search. A child process loads the
  /// library first. Errors: no library, with package, driver and variable; a file that is no
  /// regular one; a library whose loading hangs or ends the program.
  static Result<DynamicLibrary> open(const LibraryPlace& place);

  /// Looks up `name` and sets `function`. The error names the missing function of an old library.
  template <class Function>
  Status find(const char* name, Function*& function) const {
    TROCAR_TRY(void* const symbol, find_symbol(name));
    function = reinterpret_cast<Function*>(symbol);
    return {};
  }
  /// Like find(), for a function that older releases lack: sets nullptr if it is missing.
  template <class Function>
  void find_optional(const char* name, Function*& function) const {
    const auto symbol = find_symbol(name);
    function = symbol ? reinterpret_cast<Function*>(*symbol) : nullptr;
  }

  const std::string& path() const noexcept { return path_; }

 private:
  DynamicLibrary(void* handle, std::string path) : handle_(handle), path_(std::move(path)) {}
  Result<void*> find_symbol(const char* name) const;

  void* handle_;
  std::string path_;  ///< Path or name passed to the loader.
};

}  // namespace trocar::devices
