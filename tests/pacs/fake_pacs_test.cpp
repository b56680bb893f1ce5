// A PACS that speaks DIMSE and makes mistakes: one clear line, nothing written.
#include "pacs/fake_pacs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "cli/program.h"
#include "dicom/pacs/testing/made_object.h"
#include "pacs/from_fake_pacs.h"
#include "pacs/sockets.h"

namespace trocar::pacs_test {
namespace {
namespace fs = std::filesystem;
namespace made = dicom::testing;

using cli_test::Outcome;

TEST_F(FromFakePacs, ObjectsOfACorrectOneAreWritten) {
  const FakeServer server({lists_series(2), answers_get([](int socket, int request, int ct) {
                             send_object(socket, ct, made::made_ct(0).bytes());
                             send_object(socket, ct, made::made_ct(1).bytes());
                             send_object(socket, ct, made::made_ct(1).bytes());  // once more
                             end_get(socket, request);
                           })});
  const Outcome outcome = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("2 images of 1 series"), std::string::npos) << outcome.out;
}

TEST_F(FromFakePacs, RejectionNamesTheReason) {
  const auto reject = [](int result, int source, int reason) {
    return std::vector<FakeServer::Serve>{[=](int socket) {
      receive_pdu(socket);
      send_all(socket, rejection(result, source, reason));
      wait_for_close(socket);
    }};
  };
  expect_refused(reject(1, 1, 3), "does not know our AE title TROCAR");
  expect_refused(reject(1, 1, 7), "its AE title is not FAKE");
  expect_refused(reject(2, 3, 2), "busy");
  expect_refused(reject(1, 1, 1), "refuses the association");
}

TEST_F(FromFakePacs, NamesAPacsThatDoesNotAnswer) {
  const Outcome outcome = cli_test::trocar(arguments(free_port()));
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(outcome.err.find("cannot connect to the PACS"), std::string::npos) << outcome.err;
}

TEST_F(FromFakePacs, RefusesNonDimseBytes) {
  const auto answer = [](const std::string& bytes) {
    return std::vector<FakeServer::Serve>{[=](int socket) {
      receive_pdu(socket);
      send_all(socket, bytes);
    }};
  };
  expect_refused(answer(""), "does not answer as a PACS");
  expect_refused(answer("HTTP/1.1 400 Bad Request\r\n\r\n"), "does not answer as a PACS");
  expect_refused(answer(std::string(10'000, '\xff')), "does not answer as a PACS");
  expect_refused(answer(pdu(2, "short")), "does not answer as a PACS");
  expect_refused(answer(std::string("\x02\x00\xff\xff\xff\xff", 6) + std::string(1000, 'x')),
                 "does not answer as a PACS");
}

TEST_F(FromFakePacs, TimesOutOnSilence) {
  const std::string message = "sent nothing for 1 s";
  expect_refused({wait_for_close}, message, kImpatient_s);
  expect_get_refused([](int socket, int, int) { wait_for_close(socket); }, message, 2, kImpatient_s);
  expect_get_refused(
      [](int socket, int, int ct) {  // in the middle of an object
        send_all(socket, part(ct, true, true, store_request().bytes()) + part(ct, false, false, "half an obj"));
        wait_for_close(socket);
      },
      message, 2, kImpatient_s);
  expect_get_refused(
      [](int socket, int, int ct) {  // in the middle of a protocol unit
        send_all(socket, part(ct, true, true, store_request().bytes()).substr(0, 40));
        wait_for_close(socket);
      },
      "the PACS", 2, kImpatient_s);
}

TEST_F(FromFakePacs, ReportsAClosedConnection) {
  expect_get_refused(
      [](int socket, int, int ct) {
        send_object(socket, ct, made::made_ct(0).bytes());
        send_all(socket, part(ct, true, true, store_request().bytes()) + part(ct, false, false, "half an obj"));
      },
      "has ended the connection in the middle");
  expect_get_refused(
      [](int socket, int, int ct) {
        send_object(socket, ct, made::made_ct(0).bytes());
        send_all(socket, pdu(7, std::string(4, '\0')));
      },
      "has ended the connection in the middle");
  expect_get_refused([](int socket, int, int) { send_all(socket, pdu(5, std::string(4, '\0'))); },
                     "ended the retrieval early");
}

TEST_F(FromFakePacs, EndWithoutAnswerNamesTheAeTitle) {
  const std::string message = "without an answer: it may not know our AE title TROCAR";
  const auto abort = [](int socket) { send_all(socket, pdu(7, std::string(4, '\0'))); };
  expect_get_refused([](int, int, int) {}, message);
  expect_get_refused([&](int socket, int, int) { abort(socket); }, "--aet");
  const auto accept_and_abort = [&](int socket) {
    send_all(socket, acceptance(receive_pdu(socket)));
    receive_pdu(socket);
    abort(socket);
  };
  expect_refused({accept_and_abort}, message);
  const auto abort_at_once = [&](int socket) {
    receive_pdu(socket);
    abort(socket);
  };
  expect_refused({abort_at_once}, "--aet");
}

TEST_F(FromFakePacs, WrongProtocolUnitsAreRefused) {
  const auto send = [](const std::string& bytes) {
    return [=](int socket, int, int) {
      send_all(socket, bytes);
      wait_for_close(socket);
    };
  };
  const std::string message = "the PACS";
  expect_get_refused(send(std::string(5000, '\xff')), message, 2, kImpatient_s);
  expect_get_refused(send(std::string("\x04\x00\xff\xff\xff\xf0", 6) + std::string(5000, 'x')), message, 2,
                     kImpatient_s);
  expect_get_refused(send(pdu(4, std::string("\xff\xff\xff\xff\x01\x03", 6))), message, 2, kImpatient_s);
  expect_get_refused(send(pdu(4, std::string("\0\0\0\0", 4))), message, 2, kImpatient_s);
  expect_get_refused(send(pdu(4, std::string("\0\0\0\1\1", 5))), message, 2, kImpatient_s);
  expect_get_refused(send(pdu(4, "")), message, 2, kImpatient_s);
  expect_get_refused(send(part(1, true, true, "no command")), "no DICOM message");
  expect_get_refused(send(part(1, false, true, "a data set first")), "no DICOM message");
}

TEST_F(FromFakePacs, EndlessCommandIsRefused) {
  expect_get_refused(
      [](int socket, int, int ct) {
        for (int n = 0; n < 100; ++n) send_all(socket, part(ct, true, false, std::string(10'000, '\0')));
        wait_for_close(socket);
      },
      "no DICOM message");
}

TEST_F(FromFakePacs, EndlessListIsRefused) {
  expect_refused({[](int socket) {
                   const Pdu request = receive_pdu(socket);
                   send_all(socket, acceptance(request));
                   const std::string answer = message(1, response(kFindResponse, 0xff00, true), "\x08\x00\x60\x00");
                   for (int n = 0; n < 20'000; ++n) send_all(socket, answer);
                   wait_for_close(socket);
                 }},
                 "more than 10000 answers");
}

TEST_F(FromFakePacs, RefusesMalformedObjects) {
  expect_get_refused([](int socket, int, int ct) { send_object(socket, ct, "<html>this is no DICOM object</html>"); },
                     "damaged");
  expect_get_refused([](int socket, int, int ct) { send_object(socket, ct, std::string(50'000, '\xff')); }, "damaged");
  const std::string whole = made::made_ct(0).bytes();
  expect_get_refused([&](int socket, int, int ct) { send_object(socket, ct, whole.substr(0, whole.size() / 2)); },
                     "ends too early");
}

TEST_F(FromFakePacs, ObjectsOfAnotherStudyAreRefused) {
  made::MadeObject other = made::made_ct(0);
  other.add(0x0020000d, "UI", "1.2.3");
  expect_get_refused([&](int socket, int, int ct) { send_object(socket, ct, other.bytes()); }, "another study");
}

TEST_F(FromFakePacs, MissingObjectsAreCounted) {
  const auto send_one = [](int socket, int request, int ct) {
    send_object(socket, ct, made::made_ct(0).bytes());
    end_get(socket, request);
  };
  expect_get_refused(send_one, "sent 1 of 3 images", 3);
  expect_get_refused([](int socket, int request, int) { end_get(socket, request); }, "sent 0 of 2 images");
  expect_get_refused([](int socket, int request, int) { end_get(socket, request, 0xa702); }, "status A702");
}

TEST_F(FromFakePacs, KeepsExtraObjectsWithAWarning) {
  const FakeServer server({lists_series(1), answers_get([](int socket, int request, int ct) {
                             for (int slice = 0; slice < 4; ++slice)
                               send_object(socket, ct, made::made_ct(slice).bytes());
                             end_get(socket, request);
                           })});
  const Outcome outcome = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("announced 1 image and sent 4"), std::string::npos) << outcome.err;
}

TEST_F(FromFakePacs, DoesNotUsePacsNamesAsPaths) {
  expect_refused({lists_series(1, "CT", "../../../../tmp/x")}, "no such study");
  const FakeServer server({lists_series(1, "../../A/B"), answers_get([](int socket, int request, int ct) {
                             made::MadeObject object = made::made_ct(0);
                             object.add(0x00080060, "CS", "../../A/B").add(0x00200013, "IS", "../1");
                             send_object(socket, ct, object.bytes());
                             end_get(socket, request);
                           })});
  const Outcome outcome = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "a" / "series_001_AB" / "00001.dcm"));
}

TEST_F(FromFakePacs, SkipsReports) {
  const FakeServer server({lists_series(1), answers_get([](int socket, int request, int ct) {
                             made::MadeObject object = made::made_ct(0);
                             send_object(socket, ct,
                                         object.add(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.11").bytes());
                             end_get(socket, request);
                           })});
  const Outcome outcome = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("no object that can be anonymised"), std::string::npos) << outcome.err;
  EXPECT_TRUE(folder_.is_empty());
}

/// C-MOVE: connections to the port on which the program listens.
class Listening : public FromFakePacs {
 protected:
  Outcome fetch(std::function<void(int socket, int request_context)> then) {
    const FakeServer server({lists_series(1), answers_move(std::move(then))});
    std::string line = arguments(server.port());
    line.replace(line.find("--via get"), 9, fmt::format("--listen-port {}", port_));
    return cli_test::trocar(line);
  }

  /// Sends an object over a connection of its own; returns the type of the answer to the association.
  int store(const std::string& called_title, const std::string& data) const {
    const int socket = connect_to(port_);
    send_all(socket, association_request(called_title));
    const int type = receive_pdu(socket).type;
    if (type == 2) {
      send_object(socket, 1, data);
      send_all(socket, pdu(5, std::string(4, '\0')));
      receive_pdu(socket);
    }
    ::close(socket);
    return type;
  }

  void end_move(int socket, int context, int status = 0) const {
    send_all(socket, message(context, response(kMoveResponse, status)));
    if (receive_pdu(socket).type == 5) send_all(socket, pdu(6, std::string(4, '\0')));
  }

  const int port_ = free_port();
};

TEST_F(Listening, IgnoresForeignConnections) {
  const Outcome outcome = fetch([this](int socket, int request) {
    ::close(connect_to(port_));
    const int garbage = connect_to(port_);
    send_all(garbage, std::string(5000, '\xff'));
    ::close(garbage);
    EXPECT_EQ(store("OTHER", made::made_ct(0).bytes()), 3) << "rejected: another AE title";
    EXPECT_EQ(store("TROCAR", made::made_ct(0).bytes()), 2);
    end_move(socket, request);
  });
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 image of 1 series"), std::string::npos) << outcome.out;
}

TEST_F(Listening, ObjectsOfAnotherSeriesAreRefused) {
  made::MadeObject other = made::made_ct(0);
  other.add(0x0020000e, "UI", "1.2.3");
  const Outcome outcome = fetch([&](int socket, int request) {
    store("TROCAR", other.bytes());
    end_move(socket, request);
  });
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("another study or series"), std::string::npos) << outcome.err;
  EXPECT_TRUE(folder_.is_empty());
}

TEST_F(Listening, UnknownDestinationIsExplained) {
  const Outcome outcome = fetch([this](int socket, int request) { end_move(socket, request, 0xa801); });
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find(fmt::format("AE title TROCAR, address 127.0.0.1, port {}", port_)), std::string::npos)
      << outcome.err;
  EXPECT_TRUE(folder_.is_empty());
}

TEST_F(Listening, UsedPortIsNamed) {
  const FakeServer other({wait_for_close});
  const FakeServer server({lists_series(1)});
  std::string line = arguments(server.port());
  line.replace(line.find("--via get"), 9, fmt::format("--listen-port {}", other.port()));
  const Outcome outcome = cli_test::trocar(line);
  EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find(fmt::format("cannot listen for the images of the PACS — port {}", other.port())),
            std::string::npos)
      << outcome.err;
}

TEST_F(FromFakePacs, CountsReplacedTextsWithoutShowingThem) {
  const FakeServer server({lists_series(2), sends_two_slices()});
  const Outcome outcome = cli_test::trocar(arguments(server.port()));
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("harmless_words.toml: 1 description of a series"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("MUSTERMANN"), std::string::npos) << outcome.err;
}

TEST_F(FromFakePacs, NamesAMissingWordListBeforeFetching) {
  const cli_test::TemporaryFolder data;
  const Outcome outcome = cli_test::trocar(arguments(free_port()), "TROCAR_DATA_DIR='" + data.path().string() + "'");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(outcome.err.find("harmless_words.toml"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace trocar::pacs_test
