#include "core/available_memory.h"

#include <fmt/format.h>
#include <malloc.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace trocar {
inline namespace core {
namespace {

/// Reads the line "KEY: NUMBER kB" of a file in /proc.
std::optional<std::uint64_t> find_bytes(const char* path, std::string_view key) {
  constexpr std::uint64_t kBytesPerKiB = 1024;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) return std::strtoull(line.c_str() + key.size(), nullptr, 10) * kBytesPerKiB;
  return std::nullopt;
}

}  // namespace

std::uint64_t available_memory_bytes() {
  return find_bytes("/proc/meminfo", "MemAvailable:").value_or(std::numeric_limits<std::uint64_t>::max());
}

std::uint64_t resident_memory_bytes() {
  return find_bytes("/proc/self/status", "VmRSS:").value_or(0);
}

void release_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

Status check_memory_for_image(std::uint64_t bytes, std::uint64_t available_bytes, const std::string& where) {
  constexpr double kGB = 1e9;
  if (bytes <= available_bytes / 2) return {};
  return fail(fmt::format("not enough memory to read the image: {:.1f} GB are needed, {:.1f} GB are free",
                          2.0 * static_cast<double>(bytes) / kGB, static_cast<double>(available_bytes) / kGB),
              where, "close other programs or crop the image");
}

}  // namespace core
}  // namespace trocar
