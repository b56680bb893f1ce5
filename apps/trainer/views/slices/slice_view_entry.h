#pragma once

#include "views/slices/slice_view.h"
#include "views/view_registry.h"

namespace trocar::trainer {

/// A slice of the CT that follows the needle; its crosshairs and HU window are those of all slices of the workspace.
/// `id`: "axial".
ViewDescription slice_view_entry(SliceKind kind, const char* id, const QString& title);

}  // namespace trocar::trainer
