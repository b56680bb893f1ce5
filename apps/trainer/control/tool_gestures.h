#pragma once

#include <QObject>
#include <QPointF>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/vec.h"
#include "panels/puncture_panel.h"
#include "ui_kit/action_table.h"
#include "ui_kit/page_keys.h"

class QMouseEvent;
class QWheelEvent;
class QWidget;

namespace trocar::trainer {

/// Directions and scale of a view at the tools.
struct ViewScale {
  Vec3 right_P = Vec3::UnitX(), down_P = -Vec3::UnitZ();  ///< Unit vectors of the view.
  double mm_per_px = 0.0;                                 ///< 0: the view handles the mouse.
};

/// A user's gesture, converted to a tool motion.
struct Gesture {
  enum class Kind {
    kGlide,  ///< Motion on the skin; right, down in mm of the view.
    kTilt,   ///< right, down in rad.
    kTurn,   ///< About the tool's axis, rad in `right`.
    kPush,   ///< Along the tool's axis, mm in `right`: needle inward, transducer onto the skin.
  };
  Kind kind = Kind::kGlide;
  double right = 0.0, down = 0.0;
  ViewScale view;
};

/// Receives mouse, wheel and keys on views for the active tool. Without an active tool, or with Ctrl, the views handle
/// the mouse.
class ToolGestures : public QObject {
  Q_OBJECT

 public:
  explicit ToolGestures(QObject* parent = nullptr);

  /// Includes child widgets. Keys use the directions of the first view.
  void watch(QWidget& view, std::function<ViewScale()> scale);
  void unwatch();
  /// Selects or moves a tool. False for another action, or if the widget with the focus uses the key.
  bool handle_action(const FoundAction& found, const KeyPlace& place);
  ActiveTool active_tool() const noexcept { return active_tool_; }
  void take(ActiveTool tool);

  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void gestured(const trocar::trainer::Gesture& gesture);
  void taken(trocar::trainer::ActiveTool tool);

 private:
  struct Watched {
    QWidget* view;
    std::function<ViewScale()> scale;
  };
  const Watched* find(const QObject* object) const;
  bool press(const QMouseEvent& event);
  bool move(const Watched& watched, const QMouseEvent& event);
  bool turn(const Watched& watched, const QWheelEvent& event);
  bool take_by_key(ActiveTool tool);
  bool move_by_key(const FoundAction& found);
  bool has_focus() const;

  std::vector<Watched> watched_;
  ActiveTool active_tool_ = ActiveTool::kNone;
  std::optional<QPointF> from_px_;
};

}  // namespace trocar::trainer
