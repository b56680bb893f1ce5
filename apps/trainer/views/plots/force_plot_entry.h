#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The plot of the resistance. The attempt and the replay fill it.
ViewDescription force_plot_entry();

}  // namespace trocar::trainer
