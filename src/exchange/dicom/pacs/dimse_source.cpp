#include "dicom/pacs/dimse_source.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "core/text.h"
#include "dicom/pacs/detail/association.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/dimse_command.h"

namespace trocar::dicom::detail {

/// Receives the object of a C-STORE request, passes it to `sink` and answers. Errors: those of the connection and of
/// the sink (the sender is told), another message than C-STORE.
Status store_object(Association& sender, const DimseMessage& request, ObjectSink& sink);

/// Answers C-ECHO, with which administrators test an entry of the PACS.
Status answer_echo(Association& sender, const DimseMessage& request);

}  // namespace trocar::dicom::detail

namespace trocar::dicom {
namespace {

using namespace detail;

// Study root information model (PS3.4, C.6.2).
constexpr const char* kFindModel = "1.2.840.10008.5.1.4.1.2.2.1";
constexpr const char* kMoveModel = "1.2.840.10008.5.1.4.1.2.2.2";
constexpr const char* kGetModel = "1.2.840.10008.5.1.4.1.2.2.3";
constexpr std::size_t kMaxAnswers = 10'000;
constexpr std::size_t kMaxAnswerBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxSenders = 16;
constexpr std::chrono::milliseconds kGrace{500};

// Status codes (PS3.4, C.4.1.1.4 and C.4.2.1.5).
constexpr std::uint16_t kSuccess = 0x0000;
constexpr std::uint16_t kCannotSend = 0xa702;
constexpr std::uint16_t kUnknownDestination = 0xa801;

/// Encodings of queries.
std::vector<ContextOffer> offer(const char* model) {
  return {{model, {"1.2.840.10008.1.2.1", "1.2.840.10008.1.2"}}};
}

class DimseSource final : public PacsSource {
 public:
  explicit DimseSource(DimseOptions options) : options_(std::move(options)) {}

  Result<std::vector<StudyEntry>> list_studies(const std::string& patient_id) override {
    std::vector<StudyEntry> studies;
    const auto take = [&](const DataSet& answer) { studies.push_back(study_of(answer)); };
    TROCAR_TRY_STATUS(find([&](Encoding encoding) { return study_query(patient_id, encoding); }, take));
    return studies;
  }

  Result<std::vector<SeriesEntry>> list_series(const std::string& study_uid) override {
    std::vector<SeriesEntry> series;
    const auto take = [&](const DataSet& answer) { series.push_back(series_of(answer)); };
    TROCAR_TRY_STATUS(find([&](Encoding encoding) { return series_query(study_uid, encoding); }, take));
    return series;
  }

  Status retrieve(const std::string& study_uid, const std::string& series_uid, ObjectSink& sink) override {
    const BrokenPipesIgnored guard;
    senders_.clear();
    if (!network_) {
      TROCAR_TRY(network_, Network::open(options_.uses_get ? 0 : options_.listen_port, options_.timeout_s));
    }
    const char* model = options_.uses_get ? kGetModel : kMoveModel;
    TROCAR_TRY(Association pacs,
               Association::request(*network_, options_, offer(model),
                                    options_.uses_get ? storage_offers() : std::vector<ContextOffer>()));
    pacs.cancel_by([&sink] { return sink.is_cancelled(); });
    const auto context = pacs.find_context(model);
    if (!context)
      return fail(fmt::format("the PACS does not offer {}", options_.uses_get ? "C-GET" : "C-MOVE"), place_of(options_),
                  options_.uses_get ? "retrieve with --via move" : "retrieve with --via get or --dicomweb");
    DimseCommand request;
    request.field = options_.uses_get ? DimseField::kGet : DimseField::kMove;
    request.sop_class = model;
    request.message_id = 1;
    request.has_data = true;
    if (!options_.uses_get) request.destination = options_.calling_title;
    TROCAR_TRY(const Encoding encoding, encoding_of(pacs.transfer_syntax(*context)));
    TROCAR_TRY_STATUS(pacs.send(*context, request, retrieve_query(study_uid, series_uid, encoding)));
    TROCAR_TRY_STATUS(receive_until_done(pacs, series_uid, sink));
    TROCAR_TRY_STATUS(close_senders(pacs, sink));
    pacs.release();
    return {};
  }

 private:
  using MakeQuery = std::function<std::string(Encoding)>;
  using TakeAnswer = std::function<void(const DataSet&)>;

  Status find(const MakeQuery& make_query, const TakeAnswer& take) {
    const BrokenPipesIgnored guard;
    TROCAR_TRY(const Network network, Network::open(0, options_.timeout_s));
    TROCAR_TRY(Association pacs, Association::request(network, options_, offer(kFindModel), {}));
    const auto context = pacs.find_context(kFindModel);
    if (!context)
      return fail("the PACS permits no queries", place_of(options_),
                  fmt::format("ask its administrator to permit them for AE title {}", options_.calling_title));
    const std::string syntax = pacs.transfer_syntax(*context);
    TROCAR_TRY(const Encoding encoding, encoding_of(syntax));
    DimseCommand request;
    request.field = DimseField::kFind;
    request.sop_class = kFindModel;
    request.message_id = 1;
    request.has_data = true;
    TROCAR_TRY_STATUS(pacs.send(*context, request, make_query(encoding)));
    for (std::size_t n = 0; n < kMaxAnswers; ++n) {
      TROCAR_TRY(const bool is_last, receive_answer(pacs, syntax, take));
      if (!is_last) continue;
      pacs.release();
      return {};
    }
    return fail(fmt::format("the PACS sent more than {} answers", kMaxAnswers), place_of(options_),
                "ask for one study");
  }

  /// True: it was the last message of the query.
  Result<bool> receive_answer(Association& pacs, const std::string& syntax, const TakeAnswer& take) {
    TROCAR_TRY(const std::optional<DimseMessage> message, pacs.receive());
    if (!message || message->command.field != DimseField::kFindResponse || !message->command.status)
      return fail("the PACS does not answer the query", place_of(options_),
                  fmt::format("check that it permits queries for AE title {} (--aet)", options_.calling_title));
    const std::uint16_t status = *message->command.status;
    std::string bytes;
    if (message->command.has_data)
      TROCAR_TRY_STATUS(pacs.receive_data([&](std::string_view part) -> Status {
        if (bytes.size() + part.size() > kMaxAnswerBytes)
          return fail("the PACS sent too long an answer to the query", place_of(options_), "check its configuration");
        bytes += part;
        return {};
      }));
    if (status == kSuccess) return true;
    if (!is_pending(status))
      return fail(
          fmt::format("the PACS could not answer the query: status {:04X} {}", status, message->command.comment),
          place_of(options_), "ask its administrator");
    TROCAR_TRY(const DataSet answer, find_data_set(bytes, syntax));
    take(answer);
    return false;
  }

  /// Serves the PACS on our connection and on those that it opens, until the retrieval ends.
  Status receive_until_done(Association& pacs, const std::string& series_uid, ObjectSink& sink) {
    auto last_data = std::chrono::steady_clock::now();
    while (true) {
      if (sink.is_cancelled()) return fail("cancelled", series_uid, "fetch it again");
      TROCAR_TRY(const bool has_data, serve_senders(pacs, sink));
      if (pacs.has_buffered() || is_readable(pacs.socket(), 0)) {
        last_data = std::chrono::steady_clock::now();
        TROCAR_TRY(const bool is_done, serve_pacs(pacs, sink));
        if (is_done) return {};
      }
      const auto now = std::chrono::steady_clock::now();
      if (has_data) last_data = now;
      if (now - last_data > std::chrono::seconds(options_.timeout_s))
        return fail(fmt::format("the PACS sent nothing for {} s", options_.timeout_s), place_of(options_),
                    "try again, or allow more time with --timeout");
    }
  }

  /// A message on our own connection. True: the retrieval is complete.
  Result<bool> serve_pacs(Association& pacs, ObjectSink& sink) {
    TROCAR_TRY(const std::optional<DimseMessage> message, pacs.receive());
    if (!message) return fail("the PACS has ended the retrieval early", place_of(options_), "try again");
    const DimseCommand& command = message->command;
    if (options_.uses_get && command.field == DimseField::kStore) {
      TROCAR_TRY_STATUS(store_object(pacs, *message, sink));
      return false;
    }
    const auto expected = options_.uses_get ? DimseField::kGetResponse : DimseField::kMoveResponse;
    if (command.field != expected || !command.status)
      return fail("the PACS does not answer the retrieval", place_of(options_), "check that it permits retrieval");
    if (command.has_data) TROCAR_TRY_STATUS(pacs.receive_data([](std::string_view) { return Status(); }));
    if (is_pending(*command.status)) return false;
    TROCAR_TRY_STATUS(check_end(command, pacs));
    return true;
  }

  /// Waits briefly for the connections that the PACS opened, and serves them. True: there was something.
  Result<bool> serve_senders(const Association& pacs, ObjectSink& sink) {
    std::vector<pollfd> sockets = {{pacs.socket(), POLLIN, 0}};
    if (!options_.uses_get) sockets.push_back({network_->listening_socket(), POLLIN, 0});
    for (const Association& sender : senders_) sockets.push_back({sender.socket(), POLLIN, 0});
    const bool is_buffered = pacs.has_buffered() || std::ranges::any_of(senders_, &Association::has_buffered);
    ::poll(sockets.data(), sockets.size(), is_buffered ? 0 : kPoll_ms);
    bool has_data = false;
    for (std::size_t n = senders_.size(); n-- > 0;) {
      if (!senders_[n].has_buffered() && sockets[n + 2].revents == 0) continue;
      has_data = true;
      TROCAR_TRY(const bool stays, serve_sender(senders_[n], sink));
      if (!stays) senders_.erase(senders_.begin() + static_cast<std::ptrdiff_t>(n));
    }
    if (!options_.uses_get && sockets[1].revents != 0) {
      auto sender = Association::accept(*network_, options_);
      has_data |= sender.has_value();
      if (sender) sender->cancel_by([&sink] { return sink.is_cancelled(); });
      if (sender && senders_.size() < kMaxSenders) senders_.push_back(*std::move(sender));
    }
    return has_data;
  }

  /// False: the sender has ended its connection. Between two objects, this is no error: the end of the retrieval tells
  /// whether all objects were sent.
  static Result<bool> serve_sender(Association& sender, ObjectSink& sink) {
    const auto message = sender.receive();
    if (!message || !*message) return false;
    TROCAR_TRY_STATUS((*message)->command.field == DimseField::kEcho ? answer_echo(sender, **message)
                                                                     : store_object(sender, **message, sink));
    return true;
  }

  /// Some PACS answer on our connection only after those that they opened were closed in the proper form.
  Status close_senders(const Association& pacs, ObjectSink& sink) {
    const auto until = std::chrono::steady_clock::now() + kGrace;
    while (!senders_.empty() && std::chrono::steady_clock::now() < until)
      TROCAR_TRY_STATUS(serve_senders(pacs, sink).map([](bool) {}));
    senders_.clear();
    return {};
  }

  Status check_end(const DimseCommand& command, const Association& pacs) const {
    const std::uint16_t status = *command.status;
    const int failed = command.failed.value_or(0);
    if (status == kSuccess && failed == 0) return {};
    const std::string place = place_of(options_);
    if (options_.uses_get)
      return fail(
          fmt::format("the PACS could not send: status {:04X}, {} images failed {}", status, failed, command.comment),
          place, "try again, or retrieve with --via move");
    const std::string enter = fmt::format("AE title {}, address {}, port {}", options_.calling_title,
                                          pacs.local_address(), options_.listen_port);
    if (status == kUnknownDestination)
      return fail(
          fmt::format("the PACS does not know where to send: it has no entry for AE title {}", options_.calling_title),
          place, fmt::format("ask its administrator to enter {}; or retrieve with --via get", enter));
    return fail(
        fmt::format("the PACS could not send to us: status {:04X}{}{}{}", status,
                    failed > 0 ? fmt::format(", {} images failed", failed) : std::string(),
                    command.comment.empty() ? "" : ", ", command.comment),
        place,
        fmt::format("check that its entry is {}, and that no firewall is between; or retrieve with --via get", enter));
  }

  static bool is_readable(int socket, int wait_ms) {
    pollfd one{socket, POLLIN, 0};
    return ::poll(&one, 1, wait_ms) > 0;
  }

  DimseOptions options_;
  std::optional<Network> network_;
  std::vector<Association> senders_;  ///< Connections that the PACS has opened to send objects.
};

}  // namespace

Status check_ae_title(const std::string& title, const std::string& option) {
  constexpr std::size_t kMaxTitle = 16;
  const bool is_printable = std::ranges::all_of(title, [](char c) { return c > ' ' && c < 0x7f && c != '\\'; });
  if (!title.empty() && title.size() <= kMaxTitle && is_printable) return {};
  return fail_usage(fmt::format("\"{}\" is no AE title", title), option, "an AE title has 1 to 16 letters and digits");
}

Result<DimseOptions> parse_pacs_address(const std::string& text) {
  constexpr std::size_t kMaxHost = 56;  // DCMTK keeps 63 characters of "HOST:PORT"
  const std::size_t at = text.find('@');
  const std::size_t colon = text.rfind(':');
  const bool has_parts = at != std::string::npos && colon != std::string::npos && at + 1 < colon;
  const int port = has_parts ? parse_number<int>(std::string_view(text).substr(colon + 1)).value_or(0) : 0;
  DimseOptions options;
  if (has_parts) options.host = text.substr(at + 1, colon - at - 1);
  const bool is_host = std::ranges::all_of(options.host, [](char c) { return c > ' ' && c < 0x7f && c != ':'; });
  if (port < 1 || port > 65535 || !is_host || options.host.size() > kMaxHost)
    return fail_usage(fmt::format("\"{}\" is no address of a PACS", text), "--pacs",
                      "write AET@HOST:PORT, for example ORTHANC@192.168.1.5:4242");
  options.port = port;
  options.called_title = text.substr(0, at);
  TROCAR_TRY_STATUS(check_ae_title(options.called_title, "--pacs"));
  return options;
}

std::unique_ptr<PacsSource> make_dimse_source(DimseOptions options) {
  return std::make_unique<DimseSource>(std::move(options));
}

}  // namespace trocar::dicom

namespace trocar::dicom::detail {
namespace {

// PS3.4, table B.2-1.
constexpr std::uint16_t kStored = 0x0000;
constexpr std::uint16_t kOutOfResources = 0xa700;

DimseCommand answer_of(const DimseMessage& request, DimseField field, std::uint16_t status) {
  DimseCommand answer;
  answer.field = field;
  answer.sop_class = request.command.sop_class;
  answer.sop_instance = request.command.sop_instance;
  answer.responded_id = request.command.message_id;
  answer.status = status;
  return answer;
}

Status receive_object(Association& sender, const DimseMessage& request, ObjectSink& sink) {
  TROCAR_TRY_STATUS(sink.begin());
  TROCAR_TRY_STATUS(sender.receive_data([&](std::string_view part) { return sink.append(part); }));
  return sink.end(sender.transfer_syntax(request.context));
}

}  // namespace

Status store_object(Association& sender, const DimseMessage& request, ObjectSink& sink) {
  if (request.command.field != DimseField::kStore || !request.command.has_data)
    return fail("the PACS sent a message that is no object", "C-STORE",
                "ask its administrator to check its destination");
  const Status received = receive_object(sender, request, sink);
  const DimseCommand answer = answer_of(request, DimseField::kStoreResponse, received ? kStored : kOutOfResources);
  const Status answered = sender.send(request.context, answer);
  return received ? answered : received;
}

Status answer_echo(Association& sender, const DimseMessage& request) {
  return sender.send(request.context, answer_of(request, DimseField::kEchoResponse, kStored));
}

}  // namespace trocar::dicom::detail
