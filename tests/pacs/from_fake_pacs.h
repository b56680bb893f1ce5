#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/program.h"
#include "dicom/pacs/testing/made_object.h"
#include "pacs/fake_pacs.h"
#include "pacs/sockets.h"

namespace trocar::pacs_test {

inline constexpr int kPatient_s = 20;   ///< Longer than a busy machine needs.
inline constexpr int kImpatient_s = 1;  ///< For servers that never answer.

/// `trocar patient fetch` from a server that speaks DIMSE as a test wants.
class FromFakePacs : public ::testing::Test {
 protected:
  std::string arguments(int port, int timeout_s = kPatient_s) const {
    return fmt::format("patient fetch --pacs FAKE@127.0.0.1:{} --via get --timeout {} --study {} --out '{}'", port,
                       timeout_s, dicom::testing::kStudyUid, folder_ / "a");
  }

  /// One line that contains `message`, exit status 1, nothing written.
  void expect_refused(std::vector<FakeServer::Serve> serve, const std::string& message, int timeout_s = kPatient_s) {
    const FakeServer server(std::move(serve));
    const cli_test::Outcome outcome = cli_test::trocar(arguments(server.port(), timeout_s));
    EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_EQ(cli_test::line_count(outcome.err), 1) << outcome.err;
    EXPECT_TRUE(folder_.is_empty());
  }

  /// The same for what follows a request to send a CT of `announced` images.
  void expect_get_refused(std::function<void(int, int, int)> then, const std::string& message, int announced = 2,
                          int timeout_s = kPatient_s) {
    expect_refused({lists_series(announced), answers_get(std::move(then))}, message, timeout_s);
  }

  cli_test::TemporaryFolder folder_;
};

inline void send_object(int socket, int context, const std::string& data) {
  send_all(socket, message(context, store_request(), data));
  receive_pdu(socket);  // the answer
}

inline void end_get(int socket, int context, int status = 0) {
  send_all(socket, message(context, response(kGetResponse, status)));
  if (receive_pdu(socket).type == 5) send_all(socket, pdu(6, std::string(4, '\0')));
}

/// A PACS that accepts a C-GET and sends two slices of made_ct.
inline FakeServer::Serve sends_two_slices() {
  return answers_get([](int socket, int request, int ct) {
    for (int slice = 0; slice < 2; ++slice) send_object(socket, ct, dicom::testing::made_ct(slice).bytes());
    end_get(socket, request);
  });
}

}  // namespace trocar::pacs_test
