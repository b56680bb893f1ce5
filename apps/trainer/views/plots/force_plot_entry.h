#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The plot of the resistance. Attempt and replay set its contents.
ViewDescription force_plot_entry();

}  // namespace trocar::trainer
