#include "panels/structure_panel_entry.h"

#include "core/check.h"
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
  void show_help(Difficulty) override { panel_->refresh(); }
  void update(const FrameContext&) override {
    if (panel_->isVisible()) panel_->refresh();
  }

 private:
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
