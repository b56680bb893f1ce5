#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "core/result.h"
#include "results/repository.h"

namespace trocar::web {

/// A few connections to one database, lent to one thread at a time. Thread-safe.
class RepositoryPool {
 public:
  /// Opens them all. Errors: those of Repository::open.
  static Result<std::unique_ptr<RepositoryPool>> open(const database::DatabaseUrl& url, std::size_t connections);

  /// A borrowed connection; the destructor gives it back.
  class Loan {
   public:
    Loan(RepositoryPool& pool, results::Repository& repository) : pool_(pool), repository_(repository) {}
    ~Loan() { pool_.give_back(repository_); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    results::Repository& operator*() const noexcept { return repository_; }

   private:
    RepositoryPool& pool_;
    results::Repository& repository_;
  };
  /// Waits for a free one.
  Loan borrow();

 private:
  RepositoryPool() = default;
  void give_back(results::Repository& repository);

  std::vector<std::unique_ptr<results::Repository>> all_;
  std::vector<results::Repository*> free_;
  std::mutex mutex_;
  std::condition_variable is_returned_;
};

}  // namespace trocar::web
