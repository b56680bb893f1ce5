#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
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

/// Sees once a second whether any program has deleted something, and takes it out of the write-ahead log as soon as
/// nobody reads by it. Thread-safe.
class DeletionWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// True for one thread a second.
  bool is_due(TimePoint now);
  /// Whether something was deleted since the last look.
  Result<bool> look(results::Repository& repository);

 private:
  std::mutex time_mutex_, look_mutex_;
  bool has_looked_ = false, has_to_erase_ = false;
  TimePoint looked_;
  std::string last_;  ///< results::last_deletion.
};

}  // namespace trocar::web
