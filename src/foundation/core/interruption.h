#pragma once

#include <string>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// Installs handlers: SIGINT, SIGTERM and SIGHUP remove unfinished outputs, print one line with the command's name and
/// exit with status 1. Signals that the parent ignores stay ignored. Call once, in main. Errors: the thread that waits
/// for signals does not start.
Status handle_interruptions(std::string command);

/// True after such a signal. Real-time safe.
bool is_interrupted() noexcept;
/// The error of work that an interruption has ended: "interrupted".
Error interruption_error(const std::string& where);

/// While an object exists, an interrupted program has 5 s to end with its own error; the work polls is_interrupted(). A
/// second signal ends the program at once.
class InterruptibleWork {
 public:
  InterruptibleWork() noexcept;
  ~InterruptibleWork();
  InterruptibleWork(const InterruptibleWork&) = delete;
  InterruptibleWork& operator=(const InterruptibleWork&) = delete;
};

}  // namespace core
}  // namespace trocar
