#pragma once

#include <optional>

#include "cases/prepare_case.h"
#include "metrics/metric.h"
#include "scoring/score.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Scores a recorded attempt of a case, with every metric of it. `plane`: of the transducer; empty: what needs one is
/// not judged.
scoring::Outcome score_session(const cases::Case& the_case, const storage::Session& session,
                               const std::optional<metrics::ImagePlane>& plane);

}  // namespace trocar::attempt
