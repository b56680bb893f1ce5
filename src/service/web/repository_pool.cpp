#include "web/repository_pool.h"

#include <utility>

#include "results/repository.h"

namespace trocar::web {

Result<std::unique_ptr<RepositoryPool>> RepositoryPool::open(const database::DatabaseUrl& url,
                                                             std::size_t connections) {
  std::unique_ptr<RepositoryPool> pool(new RepositoryPool);
  for (std::size_t n = 0; n < connections; ++n) {
    TROCAR_TRY(results::Repository repository, results::Repository::open(url));
    pool->all_.push_back(std::make_unique<results::Repository>(std::move(repository)));
    pool->free_.push_back(pool->all_.back().get());
  }
  return pool;
}

RepositoryPool::Loan RepositoryPool::borrow() {
  std::unique_lock lock(mutex_);
  is_returned_.wait(lock, [this] { return !free_.empty(); });
  results::Repository& repository = *free_.back();
  free_.pop_back();
  return {*this, repository};
}

void RepositoryPool::give_back(results::Repository& repository) {
  {
    const std::lock_guard lock(mutex_);
    free_.push_back(&repository);
  }
  is_returned_.notify_one();
}

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
