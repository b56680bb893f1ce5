#pragma once

#include "views/slices/slice_view.h"
#include "views/view_registry.h"

namespace trocar::trainer {

/// A slice of the CT that follows the needle; all slices of the workspace share its crosshairs and HU window. `id`:
/// "axial".
ViewDescription slice_view_entry(SliceKind kind, const char* id, const QString& title);

}  // namespace trocar::trainer
