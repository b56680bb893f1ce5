#pragma once

#include <string>
#include <vector>

#include "storage/session_file.h"

namespace trocar::report::detail {

/// Verdict in a word, whose icon and colour say the same on a page.
struct Verdict {
  const char* word;
  const char* style;  ///< Class of the style sheet.
  const char* icon;   ///< Path of an SVG in a square of 100.
};
/// A session of an older program has neither a pass nor a reason against it: "No verdict".
Verdict verdict_of(const scoring::Outcome& outcome);
/// Why it is not passed, or has no verdict.
std::vector<std::string> reasons_of(const scoring::Outcome& outcome);

struct Interruptions {
  std::size_t noticed = 0;                  ///< Not shorter than tasks::kNoticedInterruption_s.
  double noticed_s = 0.0;                   ///< Sum of their lengths.
  std::vector<tasks::Interruption> listed;  ///< At most five of them, the longest, in the order of time.
  std::size_t short_ones = 0;
  double short_s = 0.0;  ///< Sum of their lengths.

  /// "12, 3.40 s in total; the longest ones follow"; empty: all are listed.
  std::string many_text() const;
  /// "3 interruptions shorter than 0.1 s, 0.04 s in total".
  std::string short_text() const;
};
Interruptions interruptions_of(const storage::Session& session);

}  // namespace trocar::report::detail
