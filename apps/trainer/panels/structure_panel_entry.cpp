#include "panels/structure_panel_entry.h"

#include <QGuiApplication>

#include "core/result.h"
#include "panels/structure_panel.h"

namespace trocar::trainer {
namespace {

class StructurePanelEntry final : public View {
 public:
  explicit StructurePanelEntry(PatientView& view) : panel_(new StructurePanel(view)) {}

  QWidget& widget() override { return *panel_; }
  bool open(const CaseContext&) override {
    panel_->rebuild();
    return true;
  }
  void show_help(TrainingMode) override { panel_->refresh(); }
  void update(const FrameContext& frame) override {
    if (!panel_->isVisible()) return;
    if (!panel_->is_outdated()) return panel_->refresh();
    // Surfaces arrive one by one. A list that is being clicked stays.
    if (frame.now_s - rebuilt_s_ < kRebuildAfter_s || QGuiApplication::mouseButtons() != Qt::NoButton) return;
    rebuilt_s_ = frame.now_s;
    panel_->rebuild();
  }

 private:
  static constexpr double kRebuildAfter_s = 0.5;
  double rebuilt_s_ = 0.0;
  StructurePanel* panel_;
};

}  // namespace

ViewDescription structure_panel_entry() {
  ViewDescription view;
  view.id = QStringLiteral("structures");
  view.title = StructurePanel::tr("Structures");
  view.is_panel = true;
  view.make = [](ViewContext& context) {
    TROCAR_CHECK(context.main_3d_view != nullptr);
    return std::make_unique<StructurePanelEntry>(*context.main_3d_view);
  };
  return view;
}

}  // namespace trocar::trainer
