#pragma once

#include <QString>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ui_kit/action_table.h"
#include "views/view.h"

namespace trocar::trainer {

/// A row at the bottom of a column of a layout. A layout that does not exist is added with only this view.
struct LayoutPlace {
  QString layout;  ///< Name of the layout, "Ultrasound".
  int column = 0;  ///< From the left; one beyond the last adds a column.
  int share = 1;   ///< Of the column's height, relative to its other rows (or of the width for a new column).
};

/// Data for a workspace to create a view and to list it in menus and layouts.
struct ViewDescription {
  QString id;     ///< "ultrasound": names of the dock ("dock-ultrasound"), of the menu entry ("show-ultrasound") and in
                  ///< layouts.
  QString title;  ///< In the dock's title and in the menu Views.
  std::optional<Action> toggled_by;  ///< Action whose key shows or hides the view.
  bool is_panel = false;             ///< A panel of controls keeps its minimum size.
  std::vector<LayoutPlace> places;   ///< In layouts, in addition to built_in_layouts().
  std::function<std::unique_ptr<View>(ViewContext&)> make;
};

/// The list of views. A view that uses another one through ViewContext must come after it.
class ViewRegistry {
 public:
  /// The id must be new.
  void add(ViewDescription view);
  const std::vector<ViewDescription>& views() const noexcept { return views_; }

 private:
  std::vector<ViewDescription> views_;
};

}  // namespace trocar::trainer
