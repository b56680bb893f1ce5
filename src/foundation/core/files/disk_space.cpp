#include "core/files/disk_space.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace trocar {
inline namespace core {
namespace {

constexpr const char* kAdvice = "choose a folder that you can write to";

}  // namespace

std::optional<std::uintmax_t> find_free_bytes(const std::filesystem::path& folder) noexcept {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error || space.available == static_cast<std::uintmax_t>(-1)) return std::nullopt;
  return space.available;
}

Status make_writable_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(error.message(), folder.string(), kAdvice);
  std::string trial = (folder / ".trial-XXXXXX").string();
  const int file = ::mkostemp(trial.data(), O_CLOEXEC);
  if (file < 0) return fail(std::strerror(errno), folder.string(), kAdvice);
  ::close(file);
  ::unlink(trial.c_str());
  return {};
}

}  // namespace core
}  // namespace trocar
