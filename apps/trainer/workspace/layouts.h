#pragma once

#include <QString>
#include <QStringList>
#include <vector>

#include "views/view_registry.h"

namespace trocar::trainer {

/// A layout consists of columns, each with its share of the width; the rows of a column have shares of its height.
/// Views in one cell are side by side.
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

/// The built-in layouts; a task starts with the first one.
const std::vector<Layout>& built_in_layouts();

/// The built-in layouts with the places of registered views: rows at the bottom of columns, new columns and new
/// layouts.
std::vector<Layout> layouts_of(const ViewRegistry& registry);

}  // namespace trocar::trainer
