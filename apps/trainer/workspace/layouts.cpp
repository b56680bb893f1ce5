#include "workspace/layouts.h"

#include <algorithm>

namespace trocar::trainer {
namespace {

LayoutCell cell(std::initializer_list<const char*> views, int share) {
  LayoutCell result;
  for (const char* view : views) result.views.push_back(QString::fromLatin1(view));
  result.share = share;
  return result;
}

void place(std::vector<Layout>& layouts, const QString& view, const LayoutPlace& place) {
  const LayoutCell cell{{view}, place.share};
  const auto layout =
      std::find_if(layouts.begin(), layouts.end(), [&](const Layout& l) { return l.name == place.layout; });
  if (layout == layouts.end()) {
    layouts.push_back({place.layout, {{{cell}, 1}}});
  } else if (place.column < static_cast<int>(layout->columns.size())) {
    layout->columns[static_cast<std::size_t>(std::max(0, place.column))].cells.push_back(cell);
  } else {
    layout->columns.push_back({{cell}, place.share});
  }
}

}  // namespace

const std::vector<Layout>& built_in_layouts() {
  static const std::vector<Layout> layouts = {
      {QString::fromLatin1(QT_TRANSLATE_NOOP("Table", "Puncture")),
       {{{cell({"3d"}, 62), cell({"axial", "sagittal"}, 38)}, 56},
        {{cell({"ultrasound"}, 62), cell({"forces"}, 38)}, 44}}},
      {QString::fromLatin1(QT_TRANSLATE_NOOP("Table", "Ultrasound")),
       {{{cell({"ultrasound"}, 1)}, 62}, {{cell({"3d"}, 40), cell({"along"}, 32), cell({"forces"}, 28)}, 38}}},
      {QString::fromLatin1(QT_TRANSLATE_NOOP("Table", "Navigation")),
       {{{cell({"3d"}, 66), cell({"side", "forces"}, 34)}, 46},
        {{cell({"structures"}, 1)}, 27},
        {{cell({"axial"}, 1), cell({"coronal"}, 1), cell({"sagittal"}, 1)}, 27}}},
      {QString::fromLatin1(QT_TRANSLATE_NOOP("Table", "Slices")),
       {{{cell({"axial"}, 1), cell({"along"}, 1)}, 1},
        {{cell({"coronal"}, 1), cell({"across"}, 1)}, 1},
        {{cell({"sagittal"}, 1), cell({"3d"}, 1)}, 1}}},
      {QString::fromLatin1(QT_TRANSLATE_NOOP("Table", "X-ray")),
       {{{cell({"xray"}, 1)}, 64}, {{cell({"3d"}, 44), cell({"ultrasound"}, 32), cell({"forces"}, 24)}, 36}}},
  };
  return layouts;
}

std::vector<Layout> layouts_of(const ViewRegistry& registry) {
  std::vector<Layout> layouts = built_in_layouts();
  for (const ViewDescription& view : registry.views())
    for (const LayoutPlace& at : view.places) place(layouts, view.id, at);
  return layouts;
}

}  // namespace trocar::trainer
