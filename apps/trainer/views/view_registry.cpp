#include "views/view_registry.h"

#include <algorithm>
#include <utility>

#include "core/result.h"

namespace trocar::trainer {

void ViewRegistry::add(ViewDescription view) {
  TROCAR_CHECK(!view.id.isEmpty() && view.make);
  TROCAR_CHECK(std::none_of(views_.begin(), views_.end(), [&](const ViewDescription& v) { return v.id == view.id; }));
  views_.push_back(std::move(view));
}

}  // namespace trocar::trainer
