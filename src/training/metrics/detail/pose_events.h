#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trocar::metrics::detail {

/// What the event field of a row says; the texts are parts of the field.
struct PoseEvents {
  bool is_paused = false;  ///< An interruption was before this row.
  std::vector<std::string_view> punctures;
  std::string fault;  ///< "'interruption:abc': the length is no number of seconds"; empty: none.
};

/// Reads "puncture:skin;interruption:0.5". Every event has to be one of those that `trocar session export` writes
/// (storage/session_file.h); a field without events is empty.
PoseEvents read_pose_events(std::string_view field);

}  // namespace trocar::metrics::detail
