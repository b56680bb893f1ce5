#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "dicom/pacs/detail/dimse_command.h"
#include "dicom/pacs/detail/rewrite_object.h"
#include "dicom/pacs/dimse_source.h"

namespace trocar::dicom::detail {

/// Address of the PACS, for messages.
std::string place_of(const DimseOptions& options);

/// A DICOM network endpoint of DCMTK: for our own connections, and with a port for those of the PACS.
class Network {
 public:
  /// `listen_port` 0: none. Errors: the port cannot be opened.
  static Result<Network> open(int listen_port, int timeout_s);
  int listening_socket() const;

 private:
  friend class Association;
  std::shared_ptr<void> network_;
};

/// A message begins: its command and the presentation context of its data set.
struct DimseMessage {
  DimseCommand command;
  std::uint8_t context = 0;
};

/// An association (PS3.8). DCMTK opens it and moves the parts of messages; commands are decoded by dimse_command. The
/// destructor aborts it unless release() was called.
class Association {
 public:
  /// Connects to the PACS. `receives`: contexts for objects that come over this association. Errors: no connection,
  /// refused.
  static Result<Association> request(const Network& network, const DimseOptions& options,
                                     const std::vector<ContextOffer>& sends, const std::vector<ContextOffer>& receives);
  /// Accepts an association that waits at the listening socket, if it offers to store objects. Empty: it was none, or
  /// for another AE title.
  static std::optional<Association> accept(const Network& network, const DimseOptions& options);

  /// Polled while waiting for a message: true ends the waiting with an error.
  void cancel_by(std::function<bool()> is_cancelled);
  int socket() const;
  std::string local_address() const;  ///< Of our end: "192.168.1.7".
  /// True if a message has arrived already, so that the socket need not become readable.
  bool has_buffered() const;

  /// Context that the other end accepted for a SOP class; empty: refused.
  std::optional<std::uint8_t> find_context(const std::string& sop_class) const;
  /// Its transfer syntax.
  std::string transfer_syntax(std::uint8_t context) const;

  Status send(std::uint8_t context, const DimseCommand& command, std::string_view data = {});
  /// The next command. Empty: the other end has released the association. Errors: closed, aborted, no data for the time
  /// limit, not a message.
  Result<std::optional<DimseMessage>> receive();
  /// Passes the data set of the message that receive() returned to `use`, part by part.
  Status receive_data(const std::function<Status(std::string_view)>& use);
  void release();

  Association(Association&&) noexcept;
  Association& operator=(Association&&) noexcept;
  ~Association();

 private:
  struct Handle;
  explicit Association(std::unique_ptr<Handle> handle) noexcept;
  std::unique_ptr<Handle> handle_;
};

}  // namespace trocar::dicom::detail
