#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The views of the trainer. A new view is a file with its ViewDescription and a line here.
ViewRegistry standard_views();

}  // namespace trocar::trainer
