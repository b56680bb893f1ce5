#pragma once

#include <functional>
#include <stop_token>
#include <string_view>
#include <utility>

namespace trocar {
inline namespace core {

/// Callback of a long task: present step, and progress in 0..1. May be empty.
using Progress = std::function<void(std::string_view step, double fraction)>;

/// Calls `progress` unless it is empty.
inline void report(const Progress& progress, std::string_view step, double fraction) {
  if (progress) progress(step, fraction);
}

}  // namespace core
inline namespace core {

/// Progress of one part of a longer task: maps 0..1 of the part to from..to of the whole.
inline Progress part_of(const Progress& whole, double from, double to) {
  return [=](std::string_view step, double fraction) { report(whole, step, from + (to - from) * fraction); };
}

}  // namespace core
inline namespace core {

/// Unwinds the work of a cancelled job (ADR 31). Only cancellation_point() throws it, and only the owner of a
/// CancellationScope catches it: BackgroundJob, or a thread of its own. It is no std::exception, so that nobody who
/// catches those of a library takes it for an error.
struct Cancelled {};

/// While it lives, cancellation_point() on this thread, and in the parallel work that this thread starts, throws
/// Cancelled once a stop is requested. Scopes nest: the inner one counts.
class CancellationScope {
 public:
  explicit CancellationScope(std::stop_token stop) noexcept;
  ~CancellationScope();
  CancellationScope(const CancellationScope&) = delete;
  CancellationScope& operator=(const CancellationScope&) = delete;

 private:
  std::stop_token stop_;
  const std::stop_token* outer_;
};

/// Work that is done completely or not begun (a case being saved, a result being recorded): the owner waits for it.
class CompleteWork : CancellationScope {
 public:
  CompleteWork() noexcept : CancellationScope(std::stop_token()) {}
};

/// The token of the innermost scope on this thread; one that never stops outside of any. For work handed to a thread.
std::stop_token cancellation_token() noexcept;
/// A place where cancelled work may end: each part of parallel work, each report of progress, and loops that last
/// longer than 0.1 s without either. Outside of a scope it does nothing.
void cancellation_point();

}  // namespace core
}  // namespace trocar
