#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The fluoroscope: image and controls.
ViewDescription xray_view_entry();

}  // namespace trocar::trainer
