#include "dicom/pacs/detail/association.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

// DCMTK's headers need this one first.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmnet/assoc.h>
#include <dcmtk/dcmnet/dcmtrans.h>

#include "dicom/pacs/detail/dimse_command.h"

namespace trocar::dicom::detail {
namespace {

constexpr long kMaxPdu = 1 << 17;                          ///< Bytes of one protocol unit that we accept.
constexpr std::size_t kMaxCommand = std::size_t{1} << 16;  ///< A command holds a few UIDs and numbers.
constexpr std::array<unsigned char, 10> kAbort{7, 0, 0, 0, 0, 4, 0, 0, 0, 0};  ///< A-ABORT (PS3.8, 9.3.8).
constexpr int kGreeting_s = 5;  ///< A caller that says nothing must not hold up the others.
constexpr const char* kVerification = "1.2.840.10008.1.1";

/// What to do if the PACS may not know this program.
std::string title_advice(const DimseOptions& options) {
  return fmt::format(
      "name the AE title that it knows with --aet, or ask its administrator to enter {} with the address of this "
      "computer and port {}",
      options.calling_title, options.listen_port);
}

tl::unexpected<Error> refused(const DimseOptions& options, T_ASC_Parameters* params) {
  T_ASC_RejectParameters reject{};
  ASC_getRejectParameters(params, &reject);
  const std::string place = place_of(options);
  if (reject.reason == ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED)
    return fail(fmt::format("the PACS refuses: its AE title is not {}", options.called_title), place,
                "ask its administrator for the AE title");
  if (reject.reason == ASC_REASON_SU_CALLINGAETITLENOTRECOGNIZED)
    return fail(fmt::format("the PACS refuses: it does not know our AE title {}", options.calling_title), place,
                title_advice(options));
  if (reject.result == ASC_RESULT_REJECTEDTRANSIENT)
    return fail("the PACS refuses for now: it is busy", place, "try again later");
  return fail("the PACS refuses the association", place,
              fmt::format("ask its administrator to permit AE title {} to query and retrieve", options.calling_title));
}

tl::unexpected<Error> not_connected(const DimseOptions& options, const OFCondition& condition,
                                    T_ASC_Parameters* params) {
  if (condition == DUL_ASSOCIATIONREJECTED) return refused(options, params);
  const std::string place = place_of(options);
  if (condition == DUL_READTIMEOUT)
    return fail(fmt::format("the PACS sent nothing for {} s", options.timeout_s), place,
                "check that this is the DICOM port of the PACS");
  if (condition.code() == DULC_UNKNOWNHOST)
    return fail("there is no computer of this name", place, "check the address of the PACS");
  if (condition.code() == DULC_TCPINITERROR)
    return fail("cannot connect to the PACS", place, "check address and port, and that the PACS is running");
  return fail("the computer there does not answer as a PACS", place,
              fmt::format("check that this is the DICOM port of the PACS, and that it knows AE title {} (--aet)",
                          options.calling_title));
}

/// DCMTK copies these values: strings of C, and an array of them.
OFCondition add_contexts(T_ASC_Parameters* params, const std::vector<ContextOffer>& offers, T_ASC_SC_ROLE role,
                         int& next_id) {
  OFCondition condition = EC_Normal;
  for (const ContextOffer& offer : offers) {
    std::vector<const char*> syntaxes = offer.transfer_syntaxes;
    const std::string sop_class(offer.sop_class);
    if (condition.good())
      condition =
          ASC_addPresentationContext(params, static_cast<T_ASC_PresentationContextID>(next_id), sop_class.c_str(),
                                     syntaxes.data(), static_cast<int>(syntaxes.size()), role);
    next_id += 2;  // odd numbers only
  }
  return condition;
}

/// DCMTK lends its sockets to derived classes only.
struct SocketAccess : DcmTransportConnection {
  using DcmTransportConnection::getSocket;
};

/// Small answers must not wait for the acknowledgement of earlier ones.
void send_at_once(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

std::string called_title(T_ASC_Parameters* params) {
  DIC_AE calling{}, called{}, responding{};
  const OFCondition condition =
      ASC_getAPTitles(params, calling, sizeof calling, called, sizeof called, responding, sizeof responding);
  return condition.good() ? called : "";
}

void answer_context(T_ASC_Parameters* params, const T_ASC_PresentationContext& context) {
  std::vector<std::string> offered;
  for (int n = 0; n < context.transferSyntaxCount; ++n) offered.emplace_back(context.proposedTransferSyntaxes[n]);
  const bool is_ours = is_storage_class(context.abstractSyntax) || std::string(context.abstractSyntax) == kVerification;
  const std::string chosen = preferred_transfer_syntax(offered);
  if (is_ours && !chosen.empty()) {
    ASC_acceptPresentationContext(params, context.presentationContextID, chosen.c_str(), context.proposedRole);
  } else {
    ASC_refusePresentationContext(params, context.presentationContextID,
                                  is_ours ? ASC_P_TRANSFERSYNTAXESNOTSUPPORTED : ASC_P_ABSTRACTSYNTAXNOTSUPPORTED);
  }
}

}  // namespace

std::string place_of(const DimseOptions& options) {
  return fmt::format("{}@{}:{}", options.called_title, options.host, options.port);
}

Result<Network> Network::open(int listen_port, int timeout_s) {
  configure_dcmtk(timeout_s);
  T_ASC_Network* network = nullptr;
  const OFCondition condition =
      ASC_initializeNetwork(listen_port == 0 ? NET_REQUESTOR : NET_ACCEPTORREQUESTOR, listen_port, timeout_s, &network);
  if (condition.bad())
    return fail("cannot listen for the images of the PACS", fmt::format("port {}", listen_port),
                "choose a free port with --listen-port and have it entered in the PACS");
  Network result;
  result.network_ = std::shared_ptr<void>(network, [](void* pointer) {
    auto* owned = static_cast<T_ASC_Network*>(pointer);
    ASC_dropNetwork(&owned);
  });
  return result;
}

int Network::listening_socket() const {
  return DUL_networkSocket(static_cast<T_ASC_Network*>(network_.get())->network);
}

struct Association::Handle {
  std::shared_ptr<void> network;  ///< Outlives its associations.
  T_ASC_Association* association = nullptr;
  DimseOptions options;
  std::function<bool()> is_cancelled;  ///< May be empty.
  std::optional<DUL_PDV> next;         ///< Arrived, not yet used.
  bool is_request = false;             ///< We have opened the association.
  bool has_answered = false;           ///< A message has arrived.

  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (association == nullptr) return;
    // ASC_abortAssociation would wait for the other end, which may be the one that does not answer.
    if (association->DULassociation != nullptr)
      ::send(socket(), kAbort.data(), kAbort.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    ASC_destroyAssociation(&association);
  }

  bool take_buffered() {
    DUL_PDV part{};
    if (!next && DUL_NextPDV(&association->DULassociation, &part).good()) next = part;
    return next.has_value();
  }

  tl::unexpected<Error> broken(const OFCondition& condition) const {
    const std::string place = place_of(options);
    if (condition == DUL_READTIMEOUT)
      return fail(fmt::format("the PACS sent nothing for {} s", options.timeout_s), place,
                  "try again, or allow more time with --timeout");
    const bool has_ended = condition == DUL_PEERABORTEDASSOCIATION || condition == DUL_NETWORKCLOSED;
    // Many PACS accept everybody and end the connection at the first request of an AE title that they do not know.
    if (has_ended && is_request && !has_answered)
      return fail(fmt::format("the PACS has ended the connection without an answer: it may not know our AE title {}",
                              options.calling_title),
                  place, title_advice(options));
    // DCMTK does not tell an abort from a closed connection.
    if (has_ended) return fail("the PACS has ended the connection in the middle", place, "try again");
    return fail("the PACS sent something that is no DICOM message", place, "check that this is its DICOM port");
  }

  int socket() const {
    DcmTransportConnection* connection = DUL_getTransportConnection(association->DULassociation);
    return connection == nullptr ? -1 : (connection->*&SocketAccess::getSocket)();
  }

  /// DCMTK itself cannot be cancelled.
  Status wait_for_data() const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(options.timeout_s);
    while (std::chrono::steady_clock::now() < until) {
      if (is_cancelled && is_cancelled()) return fail("cancelled", place_of(options), "fetch it again");
      pollfd one{socket(), POLLIN, 0};
      if (::poll(&one, 1, kPoll_ms) > 0) return {};
    }
    return broken(DUL_READTIMEOUT);
  }

  /// Reads one part. Empty: the association was released.
  Result<std::optional<DUL_PDV>> receive_part() {
    if (!take_buffered()) {
      TROCAR_TRY_STATUS(wait_for_data());
      const OFCondition condition = DUL_ReadPDVs(&association->DULassociation, nullptr, DUL_NOBLOCK, options.timeout_s);
      if (condition == DUL_PEERREQUESTEDRELEASE) {
        ASC_acknowledgeRelease(association);
        ASC_destroyAssociation(&association);
        association = nullptr;
        return std::optional<DUL_PDV>();
      }
      if (condition != DUL_PDATAPDUARRIVED) return broken(condition);
      if (!take_buffered()) return broken(condition);
    }
    const DUL_PDV part = *next;
    next.reset();
    has_answered = true;
    return std::optional(part);
  }

  /// All parts of one kind up to the last. True: complete; false: released before.
  Result<bool> receive_parts(DUL_DATAPDV kind, std::uint8_t& context,
                             const std::function<Status(std::string_view)>& use) {
    for (bool is_first = true;; is_first = false) {
      TROCAR_TRY(const std::optional<DUL_PDV> part, receive_part());
      if (!part) return false;
      if (part->pdvType != kind || (!is_first && part->presentationContextID != context)) return broken(EC_Normal);
      context = part->presentationContextID;
      TROCAR_TRY_STATUS(use(std::string_view(static_cast<const char*>(part->data), part->fragmentLength)));
      if (part->lastPDV) return true;
    }
  }

  /// One protocol unit for each part, as long as the other end accepts.
  Status send_parts(std::uint8_t context, DUL_DATAPDV kind, std::string_view bytes) {
    do {
      const std::string_view part = bytes.substr(0, association->sendPDVLength);
      bytes.remove_prefix(part.size());
      std::string copy(part);  // DCMTK takes a pointer to what could be changed
      DUL_PDV pdv{copy.size(), context, kind, bytes.empty() ? OFTrue : OFFalse, copy.data()};
      DUL_PDVLIST list{};
      list.count = 1;
      list.pdv = &pdv;
      const OFCondition condition = DUL_WritePDVs(&association->DULassociation, &list);
      if (condition.bad()) return broken(DUL_NETWORKCLOSED);
    } while (!bytes.empty());
    return {};
  }
};

Result<Association> Association::request(const Network& network, const DimseOptions& options,
                                         const std::vector<ContextOffer>& sends,
                                         const std::vector<ContextOffer>& receives) {
  T_ASC_Parameters* params = nullptr;
  ASC_createAssociationParameters(&params, kMaxPdu);
  ASC_setAPTitles(params, options.calling_title.c_str(), options.called_title.c_str(), nullptr);
  ASC_setPresentationAddresses(params, "trocar", fmt::format("{}:{}", options.host, options.port).c_str());
  int next_id = 1;
  add_contexts(params, sends, ASC_SC_ROLE_DEFAULT, next_id);
  add_contexts(params, receives, ASC_SC_ROLE_SCP, next_id);
  auto handle = std::make_unique<Handle>();
  handle->network = network.network_;
  handle->options = options;
  handle->is_request = true;
  T_ASC_Association* association = nullptr;
  const OFCondition condition = ASC_requestAssociation(static_cast<T_ASC_Network*>(network.network_.get()), params,
                                                       &association, nullptr, nullptr, DUL_NOBLOCK, options.timeout_s);
  if (condition.bad()) {
    const auto error = not_connected(options, condition, params);
    if (association != nullptr)
      ASC_destroyAssociation(&association);  // with its parameters
    else
      ASC_destroyAssociationParameters(&params);
    return error;
  }
  handle->association = association;
  Association result(std::move(handle));
  send_at_once(result.socket());
  if (ASC_countAcceptedPresentationContexts(params) == 0)
    return fail("the PACS refuses queries and retrieval", place_of(options),
                fmt::format("ask its administrator to permit them for AE title {}", options.calling_title));
  return result;
}

std::optional<Association> Association::accept(const Network& network, const DimseOptions& options) {
  T_ASC_Association* association = nullptr;
  const OFCondition condition =
      ASC_receiveAssociation(static_cast<T_ASC_Network*>(network.network_.get()), &association, kMaxPdu, nullptr,
                             nullptr, OFFalse, DUL_NOBLOCK, std::min(options.timeout_s, kGreeting_s));
  auto handle = std::make_unique<Handle>();
  handle->network = network.network_;
  handle->association = association;
  handle->options = options;
  if (condition.bad() || association == nullptr) return std::nullopt;
  T_ASC_Parameters* params = association->params;
  if (options.calling_title != called_title(params)) {
    const T_ASC_RejectParameters reject{ASC_RESULT_REJECTEDPERMANENT, ASC_SOURCE_SERVICEUSER,
                                        ASC_REASON_SU_CALLEDAETITLENOTRECOGNIZED};
    ASC_rejectAssociation(association, &reject);
    return std::nullopt;
  }
  for (int n = 0; n < ASC_countPresentationContexts(params); ++n) {
    T_ASC_PresentationContext context{};
    if (ASC_getPresentationContext(params, n, &context).good()) answer_context(params, context);
  }
  if (ASC_acknowledgeAssociation(association).bad()) return std::nullopt;
  Association result(std::move(handle));
  send_at_once(result.socket());
  return result;
}

Association::Association(std::unique_ptr<Handle> handle) noexcept : handle_(std::move(handle)) {}
Association::Association(Association&&) noexcept = default;
Association& Association::operator=(Association&&) noexcept = default;
Association::~Association() = default;

void Association::cancel_by(std::function<bool()> is_cancelled) {
  handle_->is_cancelled = std::move(is_cancelled);
}

int Association::socket() const {
  return handle_->socket();
}

std::string Association::local_address() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  char text[INET_ADDRSTRLEN] = {};
  const bool is_known = ::getsockname(socket(), reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
                        ::inet_ntop(AF_INET, &address.sin_addr, text, sizeof text) != nullptr;
  return is_known ? text : "this computer";
}

bool Association::has_buffered() const {
  return handle_->take_buffered();
}

std::optional<std::uint8_t> Association::find_context(const std::string& sop_class) const {
  const auto id = ASC_findAcceptedPresentationContextID(handle_->association, sop_class.c_str());
  return id == 0 ? std::nullopt : std::optional<std::uint8_t>(id);
}

std::string Association::transfer_syntax(std::uint8_t context) const {
  T_ASC_PresentationContext found{};
  if (ASC_findAcceptedPresentationContext(handle_->association->params, context, &found).bad()) return {};
  return found.acceptedTransferSyntax;
}

Status Association::send(std::uint8_t context, const DimseCommand& command, std::string_view data) {
  TROCAR_TRY_STATUS(handle_->send_parts(context, DUL_COMMANDPDV, encode(command)));
  return command.has_data ? handle_->send_parts(context, DUL_DATASETPDV, data) : Status();
}

Result<std::optional<DimseMessage>> Association::receive() {
  DimseMessage message;
  std::string bytes;
  TROCAR_TRY(const bool is_complete,
             handle_->receive_parts(DUL_COMMANDPDV, message.context, [&](std::string_view part) {
               if (bytes.size() + part.size() > kMaxCommand) return Status(handle_->broken(EC_Normal));
               bytes += part;
               return Status();
             }));
  if (!is_complete) return std::optional<DimseMessage>();
  const auto command = decode_command(bytes);
  if (!command) return handle_->broken(EC_Normal);
  message.command = *command;
  return std::optional(std::move(message));
}

Status Association::receive_data(const std::function<Status(std::string_view)>& use) {
  std::uint8_t context = 0;
  TROCAR_TRY(const bool is_complete, handle_->receive_parts(DUL_DATASETPDV, context, use));
  if (!is_complete) return handle_->broken(DUL_NETWORKCLOSED);
  return {};
}

void Association::release() {
  if (handle_->association == nullptr) return;
  ASC_releaseAssociation(handle_->association);
  ASC_destroyAssociation(&handle_->association);
  handle_->association = nullptr;
}

}  // namespace trocar::dicom::detail
