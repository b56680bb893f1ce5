#include "workspace/standard_views.h"

#include "panels/structure_panel_entry.h"
#include "views/patient/patient_view_entry.h"
#include "views/plots/force_plot_entry.h"
#include "views/slices/slice_view_entry.h"
#include "views/ultrasound/ultrasound_view_entry.h"
#include "views/xray/xray_view_entry.h"

namespace trocar::trainer {

ViewRegistry standard_views() {
  ViewRegistry registry;
  registry.add(patient_view_entry());
  registry.add(side_view_entry());
  registry.add(ultrasound_view_entry());
  registry.add(xray_view_entry());
  registry.add(force_plot_entry());
  registry.add(structure_panel_entry());
  registry.add(slice_view_entry(SliceKind::kAxial, "axial", SliceView::tr("Axial")));
  registry.add(slice_view_entry(SliceKind::kCoronal, "coronal", SliceView::tr("Coronal")));
  registry.add(slice_view_entry(SliceKind::kSagittal, "sagittal", SliceView::tr("Sagittal")));
  registry.add(slice_view_entry(SliceKind::kAlongNeedle, "along", SliceView::tr("Along the needle")));
  registry.add(slice_view_entry(SliceKind::kAcrossNeedle, "across", SliceView::tr("Across the tip")));
  return registry;
}

}  // namespace trocar::trainer
