#include "views/slices/slice_view_entry.h"

#include "slices/slice_geometry.h"
#include "views/slices/slice_marks.h"
#include "views/view_strip.h"

namespace trocar::trainer {
namespace {

class SliceViewEntry final : public View {
 public:
  SliceViewEntry(SliceKind kind, ViewContext& context)
      : view_(new SliceView(kind)), marks_(new SliceMarks(view_)), phase_(static_cast<std::size_t>(kind)) {
    QObject::connect(view_, &SliceView::focus_moved, &context, &ViewContext::focus_moved);
    QObject::connect(view_, &SliceView::window_changed, &context, &ViewContext::window_changed);
    QObject::connect(&context, &ViewContext::focus_moved, view_, &SliceView::set_focus);
    QObject::connect(&context, &ViewContext::window_changed, view_, &SliceView::set_window);
  }

  QWidget& widget() override { return *view_; }
  QWidget* title_line() override { return &view_->strip(); }

  bool open(const CaseContext& context) override {
    const cases::Case& the_case = context.open->the_case;
    body_P_ = slices::body_box(*the_case.patient);
    view_->show_patient(the_case.patient, body_P_);
    view_->set_paths(the_case.plan.line_P, {});
    view_->set_entry_zone(context.entry_zone);
    view_->set_focus(the_case.plan.line_P.b);
    return true;
  }

  void show_help(TrainingMode mode) override { view_->set_guidance(guidance_of(mode)); }

  void show_expert_paths(const ExpertPaths& paths) override { view_->set_paths(paths.path_P, paths.others_P); }

  void set_tip_hidden(bool is_hidden) override {
    view_->set_frame_at_skin(is_hidden);
    view_->set_needle({});
    if (is_hidden) view_->set_focus(body_P_.center());
  }

  void show_tools(const ToolContext& context) override {
    tools_ = context.visible;
    marks_->set_shot(tools_->stylet_P, tools_->core_P);
    marks_->set_throw(tools_->throw_P, tools_->notch_P);
    marks_->set_skin_marks(tools_->skin_marks_P);
    is_stale_ = true;
  }

  /// While tools move, half of the slices are updated in a frame: invisible, and it saves processor time.
  void update(const FrameContext& frame) override {
    if (!is_stale_ || (frame.are_tools_moving && (frame.number + phase_) % 2 != 0)) return;
    is_stale_ = false;
    view_->set_motion(tools_->motion);
    view_->set_needle(tools_->shaft_P);
    if (!tools_->shaft_P.empty()) view_->set_needle_frame(tools_->X_PN);
    if (tools_->focus_P) view_->set_focus(*tools_->focus_P);
  }

 private:
  SliceView* view_;
  SliceMarks* marks_;  ///< Over it.
  std::size_t phase_;
  slices::Box body_P_;
  std::shared_ptr<const ToolsShown> tools_ = std::make_shared<const ToolsShown>();
  bool is_stale_ = false;  ///< It does not show `tools_` yet.
};

}  // namespace

ViewDescription slice_view_entry(SliceKind kind, const char* id, const QString& title) {
  ViewDescription view;
  view.id = QString::fromLatin1(id);
  view.title = title;
  view.make = [kind](ViewContext& context) { return std::make_unique<SliceViewEntry>(kind, context); };
  return view;
}

}  // namespace trocar::trainer
