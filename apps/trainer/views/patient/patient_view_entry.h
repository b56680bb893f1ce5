#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The 3D view of the patient with guidance, tools and the live ultrasound image.
ViewDescription patient_view_entry();
/// A second 3D view, from the side. To reduce cost, it loads the patient when it is first visible.
ViewDescription side_view_entry();

}  // namespace trocar::trainer
