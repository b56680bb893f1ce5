#pragma once

#include <QObject>
#include <QPointF>
#include <functional>
#include <optional>
#include <vector>

#include "control/page_keys.h"
#include "geometry/vec.h"
#include "panels/puncture_panel.h"

class QKeyEvent;
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
  /// A, S, P and V select a tool, arrows and page keys move it, H, X, E and Enter emit key_pressed, Enter in a
  /// choice key_refused. False for other keys, or if the widget with the focus uses the key.
  bool handle_key(const QKeyEvent& event, const KeyPlace& place);
  ActiveTool active_tool() const noexcept { return active_tool_; }
  void take(ActiveTool tool);

  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void gestured(const trocar::trainer::Gesture& gesture);
  void taken(trocar::trainer::ActiveTool tool);
  /// Keys of the attempt: H aim, X clamp, Enter fire, E end.
  void key_pressed(int key);
  /// Enter in a list, a choice or a slider that has no use for it: it does not fire.
  void key_refused();

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
  bool move_by_key(const QKeyEvent& event);
  bool has_focus() const;

  std::vector<Watched> watched_;
  ActiveTool active_tool_ = ActiveTool::kNone;
  std::optional<QPointF> from_px_;
};

}  // namespace trocar::trainer
