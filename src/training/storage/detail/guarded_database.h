#pragma once

#include <cstdint>
#include <filesystem>

#include "storage/detail/database.h"

namespace trocar::storage::detail {

/// Longest text or row that is read from a session; a longer one is an error before it is loaded.
inline constexpr int kMaxTextBytes = 4 << 20;
/// Limit of all text together that is read from the table `info`.
inline constexpr std::size_t kMaxInfoBytes = std::size_t{16} << 20;
inline constexpr std::size_t kMaxInfoRows = 1024;
inline constexpr std::size_t kMaxNames = 1024;  ///< Names of tissues, layers, labels.
inline constexpr std::size_t kMaxNameBytes = 4096;
inline constexpr std::size_t kMaxShapeRows = 1'000'000;
inline constexpr std::size_t kMaxTransducerRows = 1'000'000;               ///< 2.8 hours at 100 Hz.
inline constexpr std::size_t kMaxParameterBytes = std::size_t{256} << 20;  ///< Each change holds a tissue table.
inline constexpr std::size_t kMaxChanges = 100'000;  ///< Changes of parameters, and interruptions.
inline constexpr std::size_t kMaxBlocks = 50'000;    ///< Blocks of ticks; 7 hours of half seconds.

/// A session that is opened for reading; its contents are not trusted. Nothing can be changed. Views, triggers and the
/// schema's own functions are off. Texts are bounded by kMaxTextBytes. The total work is bounded by a number of
/// SQLite's virtual machine steps that grows with the size of the file. A statement beyond these bounds fails.
class GuardedDatabase {
 public:
  /// Throws soci::soci_error.
  explicit GuardedDatabase(const std::filesystem::path& path);
  GuardedDatabase(const GuardedDatabase&) = delete;
  GuardedDatabase& operator=(const GuardedDatabase&) = delete;

  soci::session& session() noexcept { return session_; }
  /// Throws unless the name is an ordinary table: no view, no virtual table, no computed column.
  void require_table(const std::string& name);
  bool has_table(const std::string& name);
  bool is_exhausted() const noexcept { return steps_left_ <= 0; }  ///< The bound of work was reached.

 private:
  static int count_steps(void* self) noexcept;

  std::int64_t steps_left_;
  soci::session session_;
};

}  // namespace trocar::storage::detail
