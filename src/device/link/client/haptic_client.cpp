#include "link/client/haptic_client.h"

#include <fmt/format.h>

#include <utility>

#include "link/client/detail/client_thread.h"
#include "link/endpoint.h"

namespace trocar::link {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

milliseconds left_of(milliseconds timeout, Clock::time_point begin) {
  const auto spent = std::chrono::duration_cast<milliseconds>(Clock::now() - begin);
  return spent < timeout ? timeout - spent : milliseconds(0);
}

tl::unexpected<Error> no_server(const std::string& endpoint, milliseconds timeout, const std::string& refusal) {
  if (!refusal.empty()) {
    return fail(fmt::format("no session within {} ms: {}", timeout.count(), refusal), endpoint,
                "look at the log of trocar-hapticd");
  }
  return fail(fmt::format("no server responded within {} ms", timeout.count()), endpoint,
              "start trocar-hapticd there, or look at its log");
}

}  // namespace

struct HapticClient::Impl {
  std::unique_ptr<detail::ClientThread> thread;
  std::uint32_t last_request = 0;
};

Result<HapticClient> HapticClient::connect(const ClientOptions& options) {
  TROCAR_TRY(const Endpoint endpoint, parse_endpoint(options.endpoint));
  if (endpoint.needs_keys && !options.security) {
    return fail_usage("tcp:// needs keys", options.endpoint, "give this client's key and the server's public key");
  }
  TROCAR_TRY(auto thread, detail::ClientThread::start(options));
  auto impl = std::make_unique<Impl>();
  impl->thread = std::move(thread);
  return HapticClient(std::move(impl));
}

HapticClient::HapticClient(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HapticClient::HapticClient(HapticClient&&) noexcept = default;
HapticClient& HapticClient::operator=(HapticClient&&) noexcept = default;
HapticClient::~HapticClient() = default;

ClientView HapticClient::view() const {
  return impl_->thread->mailbox().view();
}

std::vector<NumberedSample> HapticClient::take_samples() {
  return impl_->thread->mailbox().take_samples();
}

std::optional<telemetry::TickSample> HapticClient::newest() const {
  return impl_->thread->mailbox().newest();
}

std::uint32_t HapticClient::send(decltype(Command::what) what) {
  const std::uint32_t request = ++impl_->last_request;
  impl_->thread->mailbox().post(Command{request, std::move(what)});
  impl_->thread->wake();
  return request;
}

std::vector<Reply> HapticClient::take_replies() {
  return impl_->thread->mailbox().take_replies();
}

Result<std::string> HapticClient::ask(decltype(Command::what) what, milliseconds timeout) {
  const Clock::time_point begin = Clock::now();
  TROCAR_TRY_STATUS(wait_connected(timeout));
  const std::uint32_t request = send(std::move(what));
  const auto reply = impl_->thread->mailbox().wait_reply(request, left_of(timeout, begin));
  const std::string& endpoint = impl_->thread->options().endpoint;
  if (!reply) {
    return fail(fmt::format("the server did not reply within {} ms", timeout.count()), endpoint, "look at its log");
  }
  if (!reply->is_done) return fail(reply->text, endpoint, "see the log of the server");
  return reply->text;
}

void HapticClient::set_hand(const HandTarget& target) {
  impl_->thread->mailbox().post(target);
  impl_->thread->wake();
}

void HapticClient::frame_drawn() {
  impl_->thread->frame_drawn();
}

Status HapticClient::wait_connected(milliseconds timeout) {
  if (impl_->thread->mailbox().wait_heard(timeout)) return {};
  return no_server(impl_->thread->options().endpoint, timeout, view().refusal);
}

}  // namespace trocar::link
