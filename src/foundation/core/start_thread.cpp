#include "core/start_thread.h"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace trocar {
inline namespace core {
namespace {

template <class Thread, class Body>
Result<Thread> started(std::string_view name, Body body) {
  try {
    return Thread(std::move(body));
  } catch (const std::exception& error) {  // std::system_error, or no memory for the body
    return fail(fmt::format("the {} thread does not start: {}", name, error.what()), {},
                "end other programs, or raise the limits on processes (ulimit -u) and memory (ulimit -v)");
  }
}

}  // namespace

Result<std::thread> start_thread(std::string_view name, std::function<void()> body) {
  return started<std::thread>(name, std::move(body));
}

Result<std::jthread> start_stoppable_thread(std::string_view name, std::function<void(const std::stop_token&)> body) {
  return started<std::jthread>(name, [body = std::move(body)](const std::stop_token& stop) { body(stop); });
}

Status check_threads_can_start(std::string_view name, int count) {
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  std::vector<std::thread> threads;
  Status status;
  for (int n = 0; n < count && status; ++n) {
    auto thread = start_thread(name, [ended] { ended.wait(); });
    thread ? threads.push_back(*std::move(thread)) : void(status = tl::unexpected(std::move(thread).error()));
  }
  end.set_value();
  for (std::thread& thread : threads) thread.join();
  return status;
}

}  // namespace core
}  // namespace trocar
