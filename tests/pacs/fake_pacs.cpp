#include "pacs/fake_pacs.h"

#include <utility>
#include <vector>

#include "pacs/sockets.h"

namespace trocar::pacs_test {
namespace {

using dicom::testing::MadeObject;

constexpr dicom::Encoding kImplicit{false, true};
constexpr const char* kFindModel = "1.2.840.10008.5.1.4.1.2.2.1";
constexpr const char* kMoveModel = "1.2.840.10008.5.1.4.1.2.2.2";
constexpr const char* kGetModel = "1.2.840.10008.5.1.4.1.2.2.3";
constexpr std::size_t kMaxPart = 16'000;

std::string big(std::uint64_t value, int bytes) {
  std::string text;
  for (int n = bytes - 1; n >= 0; --n) text += static_cast<char>(value >> 8 * n & 0xff);
  return text;
}

std::uint64_t read_big(const std::string& bytes, std::size_t at, int count) {
  std::uint64_t value = 0;
  for (int n = 0; n < count; ++n)
    value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(n)]);
  return value;
}

std::string item(int type, const std::string& body) {
  return big(static_cast<std::uint64_t>(type), 1) + '\0' + big(body.size(), 2) + body;
}

/// Items of an A-ASSOCIATE or of a presentation context.
std::vector<std::pair<int, std::string>> items_of(const std::string& bytes, std::size_t at) {
  std::vector<std::pair<int, std::string>> items;
  while (at + 4 <= bytes.size()) {
    const std::size_t size = read_big(bytes, at + 2, 2);
    items.emplace_back(read_big(bytes, at, 1), bytes.substr(at + 4, size));
    at += 4 + size;
  }
  return items;
}

constexpr std::size_t kFixedPart = 68;  ///< Of an A-ASSOCIATE, before its items.

std::string us(int value) {
  return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8 & 0xff)};
}

/// Reads the query: command and data set.
void receive_request(int socket) {
  receive_pdu(socket);
  receive_pdu(socket);
}

}  // namespace

Pdu receive_pdu(int socket) {
  const std::string head = receive_exactly(socket, 6);
  if (head.size() < 6) return {};
  return {static_cast<int>(read_big(head, 0, 1)), receive_exactly(socket, read_big(head, 2, 4))};
}

std::string pdu(int type, const std::string& body) {
  return big(static_cast<std::uint64_t>(type), 1) + '\0' + big(body.size(), 4) + body;
}

std::string acceptance(const Pdu& request) {
  std::string body = request.body.substr(0, kFixedPart);
  body += item(0x10, "1.2.840.10008.3.1.1.1");
  for (const auto& [type, context] : items_of(request.body, kFixedPart)) {
    if (type != 0x20) continue;
    std::string syntax;
    for (const auto& [kind, value] : items_of(context, 4))
      if (kind == 0x40 && syntax.empty()) syntax = value;
    body += item(0x21, context.substr(0, 1) + std::string(3, '\0') + item(0x40, syntax));
  }
  std::string user = item(0x51, big(16384, 4)) + item(0x52, "1.2.3.4");
  for (const auto& [type, information] : items_of(request.body, kFixedPart)) {
    if (type != 0x50) continue;
    for (const auto& [kind, value] : items_of(information, 0))
      if (kind == 0x54) user += item(0x54, value);  // the roles that were proposed
  }
  return pdu(2, body + item(0x50, user));
}

std::string association_request(const std::string& called_title) {
  std::string title = called_title;
  title.resize(16, ' ');
  std::string body = big(1, 2) + big(0, 2) + title + title + std::string(32, '\0');
  body += item(0x10, "1.2.840.10008.3.1.1.1");
  body +=
      item(0x20, std::string("\1\0\0\0", 4) + item(0x30, dicom::testing::kCtClass) + item(0x40, "1.2.840.10008.1.2.1"));
  return pdu(1, body + item(0x50, item(0x51, big(16384, 4)) + item(0x52, "1.2.3.4")));
}

std::string rejection(int result, int source, int reason) {
  return pdu(3, std::string{'\0', static_cast<char>(result), static_cast<char>(source), static_cast<char>(reason)});
}

int context_of(const Pdu& request, const std::string& abstract_syntax) {
  for (const auto& [type, context] : items_of(request.body, kFixedPart))
    for (const auto& [kind, value] : items_of(type == 0x20 ? context : std::string(), 4))
      if (kind == 0x30 && value == abstract_syntax) return static_cast<int>(read_big(context, 0, 1));
  return 0;
}

std::string part(int context, bool is_command, bool is_last, const std::string& bytes) {
  const int kind = (is_command ? 1 : 0) | (is_last ? 2 : 0);
  return pdu(4, big(bytes.size() + 2, 4) + std::string{static_cast<char>(context), static_cast<char>(kind)} + bytes);
}

std::string message(int context, const MadeObject& command, const std::string& data) {
  std::string all = part(context, true, true, command.bytes());
  for (std::size_t at = 0; at < data.size(); at += kMaxPart)
    all += part(context, false, at + kMaxPart >= data.size(), data.substr(at, kMaxPart));
  return all;
}

MadeObject command(int field, bool has_data) {
  MadeObject made(kImplicit);
  return made.add(0x00000100, "US", us(field)).add(0x00000800, "US", us(has_data ? 1 : 0x0101));
}

MadeObject response(int field, int status, bool has_data) {
  return command(field, has_data).add(0x00000120, "US", us(1)).add(0x00000900, "US", us(status));
}

MadeObject store_request() {
  return command(1, true)
      .add(0x00000002, "UI", dicom::testing::kCtClass)
      .add(0x00000110, "US", us(5))
      .add(0x00001000, "UI", dicom::testing::ct_instance(0));
}

std::function<void(int)> lists_series(int announced, const std::string& modality, const std::string& uid) {
  return [=](int socket) {
    const Pdu request = receive_pdu(socket);
    const int context = context_of(request, kFindModel);
    send_all(socket, acceptance(request));
    receive_request(socket);
    MadeObject series;
    series.add(0x00080060, "CS", modality).add(0x0020000e, "UI", uid).add(0x00200011, "IS", "1");
    series.add(0x00201209, "IS", std::to_string(announced));
    send_all(socket, message(context, response(kFindResponse, 0xff00, true), series.bytes()));
    send_all(socket, message(context, response(kFindResponse, 0)));
    if (receive_pdu(socket).type == 5) send_all(socket, pdu(6, std::string(4, '\0')));
    wait_for_close(socket);
  };
}

std::function<void(int)> answers_get(std::function<void(int, int, int)> then) {
  return [then = std::move(then)](int socket) {
    const Pdu request = receive_pdu(socket);
    send_all(socket, acceptance(request));
    receive_request(socket);
    then(socket, context_of(request, kGetModel), context_of(request, dicom::testing::kCtClass));
  };
}

std::function<void(int)> answers_move(std::function<void(int, int)> then) {
  return [then = std::move(then)](int socket) {
    const Pdu request = receive_pdu(socket);
    send_all(socket, acceptance(request));
    receive_request(socket);
    then(socket, context_of(request, kMoveModel));
  };
}

}  // namespace trocar::pacs_test
