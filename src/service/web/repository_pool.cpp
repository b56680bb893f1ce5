#include "web/repository_pool.h"

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

}  // namespace trocar::web
