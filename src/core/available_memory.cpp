#include "core/available_memory.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <string>

namespace trocar {

std::uint64_t available_memory_bytes() {
  constexpr std::uint64_t kBytesPerKiB = 1024;
  std::ifstream file("/proc/meminfo");
  std::string key;
  std::uint64_t kib = 0;
  for (std::string unit; file >> key >> kib; std::getline(file, unit))
    if (key == "MemAvailable:") return kib * kBytesPerKiB;
  return std::numeric_limits<std::uint64_t>::max();
}

Status check_memory_for_image(std::uint64_t bytes, std::uint64_t available_bytes, const std::string& where) {
  constexpr double kGB = 1e9;
  if (bytes <= available_bytes / 2) return {};
  return fail(fmt::format("not enough memory to read the image: {:.1f} GB are needed, {:.1f} GB are free",
                          2.0 * static_cast<double>(bytes) / kGB, static_cast<double>(available_bytes) / kGB),
              where, "close other programs or crop the image");
}

}  // namespace trocar
