#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Kinds of files that the programs read. Each kind has one limit of size.
enum class FileKind { kToml, kJson, kMarkups, kTransform, kXml, kMesh, kVolume, kDicom, kSequence, kSession, kOther };

struct FileLimit {
  FileKind kind;
  std::string_view name;    ///< For messages: "TOML file".
  std::uint64_t max_bytes;  ///< A larger file is refused before it is read.
};

/// The one table of size limits; docs/patient_files.md lists the same numbers.
std::span<const FileLimit> file_limits() noexcept;
const FileLimit& limit_of(FileKind kind);

/// An open regular file. Opening never blocks and never has a side effect on the named file: a FIFO, socket, device or
/// folder is refused, whether named directly or through a symbolic link.
class InputFile {
 public:
  /// With `inside`, the file must lie in that folder or below it after all symbolic links are resolved. This is checked
  /// on the open file, so that a path which changes meanwhile cannot pass. Errors: no such file, not a regular file,
  /// no permission, above the limit of size, outside of the folder.
  static Result<InputFile> open(const std::filesystem::path& path, FileKind kind,
                                const std::filesystem::path& inside = {});
  static Result<InputFile> open(const std::filesystem::path& path, const FileLimit& limit,
                                const std::filesystem::path& inside = {});

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  ~InputFile();

  const std::filesystem::path& path() const noexcept { return path_; }  ///< The path passed to open(), for messages.
  std::uint64_t size() const noexcept { return size_; }                 ///< In bytes, at the time of open().

  /// A path that refers to the open file during the lifetime of this object ("/proc/self/fd/5"), for libraries that
  /// open files by name. It has no ending.
  std::filesystem::path pinned_path() const;

  /// Reads the whole file. Errors: the file cannot be read, or it has grown above the limit.
  Result<std::string> read_all() const;

 private:
  InputFile(std::filesystem::path path, int descriptor, FileLimit limit);
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  FileLimit limit_;
};

/// Reads the whole file of a kind. Errors: those of InputFile.
Result<std::string> read_input(const std::filesystem::path& path, FileKind kind,
                               const std::filesystem::path& inside = {});

}  // namespace core
}  // namespace trocar
