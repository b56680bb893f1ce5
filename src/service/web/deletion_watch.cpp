#include "web/deletion_watch.h"

#include <utility>

#include "results/deletion.h"

namespace trocar::web {

bool DeletionWatch::is_due(TimePoint now) {
  constexpr std::chrono::seconds kInterval{1};
  const std::lock_guard lock(time_mutex_);
  if (has_looked_ && now < looked_ + kInterval && now >= looked_) return false;
  has_looked_ = true;
  looked_ = now;
  return true;
}

Result<bool> DeletionWatch::look(results::Repository& repository) {
  const std::lock_guard lock(look_mutex_);
  TROCAR_TRY(std::string last, results::last_deletion(repository));
  const bool has_deleted = last.compare(last_) != 0;
  last_ = std::move(last);
  has_to_erase_ = has_to_erase_ || has_deleted;
  if (has_to_erase_) has_to_erase_ = !results::erase_deleted(repository, std::chrono::milliseconds(0)).value_or(false);
  return has_deleted;
}

}  // namespace trocar::web
