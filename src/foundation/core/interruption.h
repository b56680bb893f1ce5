#pragma once

#include <string>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// From now on SIGINT, SIGTERM and SIGHUP end the program in order: unfinished outputs are removed, one line on
/// standard error says so with the name of the command, the exit status is 1. A signal that the parent process ignores
/// stays ignored. Call it once, in main.
void handle_interruptions(std::string command);

/// Whether such a signal has come. Real-time safe.
bool is_interrupted() noexcept;
/// The error of work that an interruption has ended: "interrupted".
Error interruption_error(const std::string& where);

/// While one exists, an interrupted program is given 5 s to end by itself, with its own error: the work polls
/// is_interrupted(). A second signal ends it at once.
class InterruptibleWork {
 public:
  InterruptibleWork() noexcept;
  ~InterruptibleWork();
  InterruptibleWork(const InterruptibleWork&) = delete;
  InterruptibleWork& operator=(const InterruptibleWork&) = delete;
};

}  // namespace core
}  // namespace trocar
