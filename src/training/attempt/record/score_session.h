#pragma once

#include "cases/prepare_case.h"
#include "core/progress.h"
#include "scoring/score.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Scores a recorded attempt of a case, with every metric of it. Without an image plane in its description, what needs
/// one is not judged.
scoring::Outcome score_session(const cases::Case& the_case, const storage::Session& session,
                               const Progress& progress = {});

}  // namespace trocar::attempt
