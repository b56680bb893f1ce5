#pragma once

#include <functional>
#include <optional>
#include <string>

#include "dicom/pacs/testing/made_object.h"

// The other end of an association, byte by byte (PS3.8), so that tests can make every mistake.
namespace trocar::pacs_test {

/// A protocol data unit; type 0: the connection was closed.
struct Pdu {
  int type = 0;
  std::string body;
};
Pdu receive_pdu(int socket);
std::string pdu(int type, const std::string& body);

/// A-ASSOCIATE-AC for a request: accepts every context with its first transfer syntax.
std::string acceptance(const Pdu& request);
/// A-ASSOCIATE-RQ with one context, number 1: CT images without compression.
std::string association_request(const std::string& called_title);
/// A-ASSOCIATE-RJ
std::string rejection(int result, int source, int reason);
/// Context of the request for an abstract syntax; 0 if there is none.
int context_of(const Pdu& request, const std::string& abstract_syntax);

/// P-DATA-TF with one part of a message.
std::string part(int context, bool is_command, bool is_last, const std::string& bytes);
/// A whole message; `data` empty: without a data set.
std::string message(int context, const dicom::testing::MadeObject& command, const std::string& data = {});
/// A command set with what all have.
dicom::testing::MadeObject command(int field, bool has_data);
/// Response to a query or retrieval.
dicom::testing::MadeObject response(int field, int status, bool has_data = false);
/// C-STORE request.
dicom::testing::MadeObject store_request();

/// A PACS that answers the list of series with the CT of made_ct: `announced` images.
std::function<void(int)> lists_series(int announced, const std::string& modality = "CT",
                                      const std::string& uid = dicom::testing::kCtSeriesUid);
/// A PACS that accepts a C-GET and then does what a test wants, with the contexts of the request and of CT images.
std::function<void(int)> answers_get(std::function<void(int socket, int request_context, int ct_context)> then);

/// A PACS that accepts a C-MOVE and then does what a test wants.
std::function<void(int)> answers_move(std::function<void(int socket, int request_context)> then);

inline constexpr int kMoveResponse = 0x8021;
inline constexpr int kGetResponse = 0x8010;
inline constexpr int kFindResponse = 0x8020;

}  // namespace trocar::pacs_test
