#include "link/detail/allowed_clients.h"

#include <array>
#include <system_error>
#include <vector>

#include "core/log.h"

namespace trocar::detail {
namespace {

constexpr const char* kQuestionsAddress = "inproc://zeromq.zap.01";  // RFC 27
constexpr const char* kQuestionVersion = "1.0";
// Frames of a question: version, request, domain, address, identity, mechanism, then the credentials: one key.
constexpr std::size_t kMechanismFrame = 5, kKeyFrame = 6, kFrames = 7;
constexpr std::size_t kKeyBytes = 32, kKeyTextBytes = 40;
constexpr int kMostLogLines = 10;  // A stranger who tries for ever does not fill the log.

std::vector<std::string> read_question(ZmqSocket& questions) {
  std::vector<std::string> frames;
  bool has_more = true;
  while (has_more) {
    ZmqFrame frame;
    if (!questions.receive(frame, 0)) return {};
    frames.emplace_back(frame.text());
    has_more = frame.has_more();
  }
  return frames;
}

std::string key_text(const std::string& key) {
  std::array<char, kKeyTextBytes + 1> text{};
  zmq_z85_encode(text.data(), reinterpret_cast<const std::uint8_t*>(key.data()), key.size());
  return text.data();
}

void send_answer(ZmqSocket& questions, std::string_view request, bool is_allowed) {
  questions.send(kQuestionVersion, ZMQ_SNDMORE);
  questions.send(request, ZMQ_SNDMORE);
  questions.send(is_allowed ? "200" : "400", ZMQ_SNDMORE);
  questions.send(is_allowed ? "OK" : "not allowed", ZMQ_SNDMORE);
  questions.send("", ZMQ_SNDMORE);  // user
  questions.send("", 0);            // metadata
}

}  // namespace

Result<std::unique_ptr<AllowedClients>> AllowedClients::start(ZmqContext& context, std::set<std::string> keys) {
  ZmqSocket questions(context, ZMQ_REP);
  if (!questions.is_open() || !questions.set(ZMQ_LINGER, 0) || zmq_bind(questions.get(), kQuestionsAddress) != 0) {
    return fail("the list of allowed clients cannot be used", kQuestionsAddress, zmq_strerror(zmq_errno()));
  }
  std::unique_ptr<AllowedClients> clients(new AllowedClients(context, std::move(keys)));
  try {
    clients->thread_ =
        std::thread([self = clients.get()](ZmqSocket socket) { self->answer(socket); }, std::move(questions));
  } catch (const std::system_error& error) {
    return fail("no thread for the list of allowed clients", {}, error.what());
  }
  return clients;
}

AllowedClients::~AllowedClients() {
  context_.shut_down();
  if (thread_.joinable()) thread_.join();
}

void AllowedClients::answer(ZmqSocket& questions) const {
  int refused = 0;
  while (true) {
    const std::vector<std::string> frames = read_question(questions);
    if (frames.empty()) return;  // the context was shut down
    if (frames.size() < 2) continue;
    const bool has_key =
        frames.size() == kFrames && frames[kMechanismFrame] == "CURVE" && frames[kKeyFrame].size() == kKeyBytes;
    const std::string key = has_key ? key_text(frames[kKeyFrame]) : std::string();
    const bool is_allowed = has_key && keys_.contains(key);
    if (!is_allowed && refused++ < kMostLogLines) log_warning("client refused: its key is not allowed: {}", key);
    send_answer(questions, frames[1], is_allowed);
  }
}

}  // namespace trocar::detail
