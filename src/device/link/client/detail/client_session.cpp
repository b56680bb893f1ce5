#include "link/client/detail/client_session.h"

#include <algorithm>
#include <utility>

namespace trocar::link::detail {

bool ClientSession::take(ServerMessage message, double now_s) {
  if (const auto* refusal = std::get_if<Refusal>(&message.body); refusal != nullptr && message.session == 0) {
    // The server does not know this session: send Hello again.
    mailbox_.put_refusal(refusal->text);
    if (is_welcomed()) lose();
    return false;
  }
  const auto* welcome = std::get_if<Welcome>(&message.body);
  const bool is_new = welcome != nullptr && welcome->session != 0 && welcome->session != session_;
  const bool is_mine = is_new ? message.session == welcome->session : is_welcomed() && message.session == session_;
  if (!is_mine || (!is_new && message.sequence <= last_received_)) {
    refuse();
    return false;
  }
  if (is_new) {
    lose();
    session_ = message.session;
  }
  last_received_ = message.sequence;
  if (!std::visit([&](auto& body) { return take_body(body, now_s); }, message.body)) {
    refuse();
    return false;
  }
  if (welcome != nullptr) mailbox_.put_welcome(*welcome, is_new);
  mailbox_.put_heard();
  return true;
}

void ClientSession::refuse() {
  mailbox_.put_refused(++refused_);
}

ClientMessage ClientSession::message(ClientBody body) {
  return {session_, ++last_sent_, std::move(body)};
}

void ClientSession::lose() {
  for (const std::uint32_t request : std::exchange(waiting_, {})) {
    mailbox_.put_reply({request, false, "the server disconnected before it replied"});
  }
  session_ = 0;
  last_sent_ = last_received_ = 0;
  knows_next_tick_ = false;  // a restarted server counts from 0
  clock_.clear();
  mailbox_.put_lost();
}

bool ClientSession::take_body(const Welcome& welcome, double) {
  return welcome.session == session_;
}

bool ClientSession::take_body(StateBatch& batch, double) {
  std::uint64_t missing = 0;
  if (!batch.samples.empty()) {
    if (knows_next_tick_ && batch.first_tick < next_tick_) return false;
    if (knows_next_tick_) missing = batch.first_tick - next_tick_;
    next_tick_ = batch.first_tick + batch.samples.size();
    knows_next_tick_ = true;
    ticks_received_ += batch.samples.size();
  }
  mailbox_.put_batch(std::move(batch), missing);
  return true;
}

bool ClientSession::take_body(Reply& reply, double) {
  const auto found = std::ranges::find(waiting_, reply.request);
  if (found == waiting_.end()) return false;
  waiting_.erase(found);
  mailbox_.put_reply(std::move(reply));
  return true;
}

bool ClientSession::take_body(const Pong& pong, double now_s) {
  if (!clock_.add(pong.client_time_s, pong.server_time_s, now_s)) return false;
  const auto best = clock_.best();
  mailbox_.put_clock(best->offset_s, best->round_trip_s);
  return true;
}

bool ClientSession::take_body(const Refusal& refusal, double) {
  mailbox_.put_refusal(refusal.text);
  return true;
}

namespace {

/// Quartz clocks drift by about 50 ppm [assumed]: 0.25 ms in this time, below the jitter of a loaded link.
constexpr double kRemembered_s = 5.0;

}  // namespace

bool ClockOffset::add(double sent_s, double their_s, double received_s) {
  const double round_trip_s = received_s - sent_s;
  if (!(round_trip_s >= 0.0)) return false;
  while (!pings_.empty() && received_s - pings_.front().received_s > kRemembered_s) pings_.pop_front();
  while (!pings_.empty() && pings_.back().estimate.round_trip_s >= round_trip_s) pings_.pop_back();
  pings_.push_back({received_s, {their_s - (sent_s + round_trip_s / 2.0), round_trip_s}});
  return true;
}

std::optional<ClockOffset::Estimate> ClockOffset::best() const {
  if (pings_.empty()) return {};
  return pings_.front().estimate;
}

}  // namespace trocar::link::detail
