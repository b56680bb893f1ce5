#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The ultrasound scanner: image and controls.
ViewDescription ultrasound_view_entry();

}  // namespace trocar::trainer
