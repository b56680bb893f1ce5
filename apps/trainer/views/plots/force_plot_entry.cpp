#include "views/plots/force_plot_entry.h"

#include "views/plots/force_plot.h"
#include "views/view_strip.h"

namespace trocar::trainer {
namespace {

class ForcePlotEntry final : public View {
 public:
  ForcePlotEntry() : plot_(new ForcePlot) {}

  QWidget& widget() override { return *plot_; }
  QWidget* title_line() override { return &plot_->strip(); }
  void set_tip_hidden(bool is_hidden) override { plot_->set_depth_shown(!is_hidden); }

 private:
  ForcePlot* plot_;
};

}  // namespace

ViewDescription force_plot_entry() {
  ViewDescription view;
  view.id = QStringLiteral("forces");
  view.title = ForcePlot::tr("Resistance");
  view.make = [](ViewContext&) { return std::make_unique<ForcePlotEntry>(); };
  return view;
}

}  // namespace trocar::trainer
