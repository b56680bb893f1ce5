#pragma once

#include <QString>
#include <QStringList>
#include <vector>

#include "views/view_registry.h"

namespace trocar::trainer {

/// A layout as columns of views, each with its share of the width; a column's rows with their shares of its height.
/// Views in one cell lie side by side.
struct LayoutCell {
  std::vector<QString> views;  ///< Dock names, side by side.
  int share = 1;
};
struct LayoutColumn {
  std::vector<LayoutCell> cells;
  int share = 1;
};
struct Layout {
  QString name;
  std::vector<LayoutColumn> columns;
};

/// The built-in layouts, the first one is where a task begins.
const std::vector<Layout>& built_in_layouts();

/// The same with the places of registered views: rows at the foot of columns, new columns and new layouts.
std::vector<Layout> layouts_of(const ViewRegistry& registry);

}  // namespace trocar::trainer
