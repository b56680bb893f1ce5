#pragma once

#include <string>

#include "storage/session_file.h"

namespace trocar::report::detail {

/// Resistance against needle depth of each insertion, tissues as stripes, punctures marked (paper A, figure 4b).
std::string force_depth_figure(const storage::Session& session);
/// Table of the punctured layers.
std::string puncture_table(const storage::Session& session);
/// The components of the force over time, phases shaded.
std::string force_time_figure(const storage::Session& session);
/// Depth and velocity over time.
std::string motion_figure(const storage::Session& session);

/// A class of the style sheet for a tissue's stripe.
std::string tissue_style(const std::string& tissue);

}  // namespace trocar::report::detail
