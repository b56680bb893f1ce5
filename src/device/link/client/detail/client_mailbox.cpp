#include "link/client/detail/client_mailbox.h"

#include <algorithm>
#include <utility>

namespace trocar::link::detail {
namespace {

constexpr double kBeat_s = 1e-9 * static_cast<double>(kBeat_ns);
constexpr int kConnectedBeats = 25;                  ///< Timeout for a connected server.
constexpr std::size_t kMostSamplesHeld = 60 * 4000;  ///< A minute at 4 kHz.
constexpr std::size_t kMostRepliesHeld = 1024;       ///< If replies are not taken, the oldest are dropped [assumed].

}  // namespace

void ClientMailbox::post(Command command) {
  const std::lock_guard lock(mutex_);
  outgoing_.commands.push_back(std::move(command));
}

void ClientMailbox::post(const HandTarget& hand) {
  const std::lock_guard lock(mutex_);
  outgoing_.hand = hand;
}

void ClientMailbox::leave() {
  const std::lock_guard lock(mutex_);
  outgoing_.is_leaving = true;
}

ClientView ClientMailbox::view() const {
  const std::lock_guard lock(mutex_);
  ClientView view = view_;
  view.silent_s = kBeat_s * silent_beats_;
  view.is_connected = is_connected();
  return view;
}

bool ClientMailbox::is_connected() const {
  return has_session_ && silent_beats_ <= kConnectedBeats;
}

std::vector<NumberedSample> ClientMailbox::take_samples() {
  std::deque<StateBatch> batches;
  std::size_t count = 0;
  {
    const std::lock_guard lock(mutex_);
    batches.swap(batches_);
    count = std::exchange(samples_held_, 0);
  }
  std::vector<NumberedSample> samples;
  samples.reserve(count);
  for (const StateBatch& batch : batches) {
    std::uint64_t tick = batch.first_tick;
    for (const telemetry::TickSample& sample : batch.samples) {
      samples.push_back({tick++, sample, batch.scene});
      if (batch.shape && batch.shape->time_s == sample.time_s)
        samples.back().shape = std::make_shared<const telemetry::NeedleShape>(*batch.shape);
    }
  }
  return samples;
}

std::optional<telemetry::TickSample> ClientMailbox::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::vector<Reply> ClientMailbox::take_replies() {
  std::deque<Reply> replies;
  {
    const std::lock_guard lock(mutex_);
    replies.swap(replies_);
  }
  return {std::make_move_iterator(replies.begin()), std::make_move_iterator(replies.end())};
}

std::optional<Reply> ClientMailbox::wait_reply(std::uint32_t request, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  const auto find = [&] { return std::ranges::find(replies_, request, &Reply::request); };
  if (!news_.wait_for(lock, timeout, [&] { return find() != replies_.end(); })) return {};
  const auto found = find();
  Reply reply = std::move(*found);
  replies_.erase(found);
  return reply;
}

bool ClientMailbox::wait_heard(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return news_.wait_for(lock, timeout, [&] { return is_connected(); });
}

Outgoing ClientMailbox::take_outgoing() {
  const std::lock_guard lock(mutex_);
  return std::exchange(outgoing_, {});
}

void ClientMailbox::put_welcome(const Welcome& welcome, bool is_new) {
  const std::lock_guard lock(mutex_);
  view_.welcome = welcome;
  if (is_new) {
    ++view_.welcomes;
    view_.refusal.clear();
    view_.status = {};  // the status of the previous server does not apply
    newest_.reset();
  }
  has_session_ = true;
}

void ClientMailbox::put_beat() {
  const std::lock_guard lock(mutex_);
  ++silent_beats_;
}

void ClientMailbox::put_heard() {
  {
    const std::lock_guard lock(mutex_);
    silent_beats_ = 0;
  }
  news_.notify_all();
}

void ClientMailbox::put_refused(std::uint64_t messages_refused) {
  const std::lock_guard lock(mutex_);
  view_.messages_refused = messages_refused;
}

void ClientMailbox::put_refusal(std::string text) {
  const std::lock_guard lock(mutex_);
  view_.refusal = std::move(text);
}

void ClientMailbox::put_clock(double offset_s, double round_trip_s) {
  const std::lock_guard lock(mutex_);
  view_.clock_offset_s = offset_s;
  view_.round_trip_s = round_trip_s;
}

void ClientMailbox::put_batch(StateBatch batch, std::uint64_t missing_before) {
  const std::lock_guard lock(mutex_);
  view_.ticks_missing += missing_before;
  view_.ticks_received += batch.samples.size();
  if (batch.status) view_.status = *std::exchange(batch.status, {});
  if (batch.samples.empty()) return;
  newest_ = batch.samples.back();
  samples_held_ += batch.samples.size();
  batches_.push_back(std::move(batch));
  while (samples_held_ > kMostSamplesHeld) {
    const std::size_t dropped = batches_.front().samples.size();
    batches_.pop_front();
    samples_held_ -= dropped;
    view_.ticks_missing += dropped;
  }
}

void ClientMailbox::put_reply(Reply reply) {
  {
    const std::lock_guard lock(mutex_);
    replies_.push_back(std::move(reply));
    if (replies_.size() > kMostRepliesHeld) replies_.pop_front();
  }
  news_.notify_all();
}

void ClientMailbox::put_lost() {
  const std::lock_guard lock(mutex_);
  has_session_ = false;
}

}  // namespace trocar::link::detail
