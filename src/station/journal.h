#pragma once

#include <filesystem>
#include <optional>

#include "core/result.h"
#include "station/open_case.h"

namespace trocar {

/// What a seat was doing, kept in a file so that a crash loses nothing: written before an attempt begins, taken away
/// when it has ended in order. What is found at the next start was cut off.
struct SeatState {
  CaseChoice choice;
  std::filesystem::path session;  ///< Of the attempt under way.
};

class Journal {
 public:
  /// Kept as `folder`/seat.json.
  explicit Journal(std::filesystem::path folder) : path_(std::move(folder) / "seat.json") {}

  /// Errors: the file cannot be written.
  Status begin(const SeatState& state) const;
  void clear() const noexcept;
  /// What was cut off, where its session is still there. A file that cannot be understood is taken as nothing.
  std::optional<SeatState> recover() const;

 private:
  std::filesystem::path path_;
};

}  // namespace trocar
