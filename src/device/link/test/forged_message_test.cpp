// Bytes that our encoder never makes, built with the schema: other versions, missing and shared parts, wrong alignment.
#include <gtest/gtest.h>

#include <cstring>

#include "link/codec.h"
#include "link/detail/inspection.h"
#include "link/detail/wire_sample.h"
#include "link/test/random_message.h"

namespace trocar::link {
namespace {
using namespace detail;

constexpr std::uint64_t kSession = 1, kSequence = 1;

template <class Type>
Bytes finish_client(Builder& b, Type type, flatbuffers::Offset<void> body, std::uint32_t version = kLinkVersion) {
  b.Finish(wire::CreateClientMessage(b, version, kSession, kSequence, type, body), kClientIdentifier);
  return take_bytes(b);
}

Bytes finish_server(Builder& b, wire::ServerBody type, flatbuffers::Offset<void> body) {
  b.Finish(wire::CreateServerMessage(b, kLinkVersion, kSession, kSequence, type, body), kServerIdentifier);
  return take_bytes(b);
}

template <class Message>
std::string complaint(const Result<Message>& decoded) {
  return decoded ? "accepted" : decoded.error().text();
}

void expect_says(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << text;
}

TEST(ForgedMessage, ReportsAnotherVersionFirst) {
  constexpr std::uint32_t kOther = 77;
  Builder b;
  const auto goodbye = wire::CreateGoodbye(b).Union();
  const std::string text =
      complaint(decode_client_message(finish_client(b, wire::ClientBody::Goodbye, goodbye, kOther)));
  expect_says(text, "version 77");
  expect_says(text, "version " + std::to_string(kLinkVersion));

  // The rest of a message of that version may be anything.
  Builder later;
  later.Finish(wire::CreatePrelude(later, kOther), kServerIdentifier);
  expect_says(complaint(decode_server_message(take_bytes(later))), "version 77");
}

TEST(ForgedMessage, TreatsAMissingVersionAsZero) {
  Builder b;
  b.Finish(wire::CreatePrelude(b), kClientIdentifier);
  expect_says(complaint(decode_client_message(take_bytes(b))), "version 0");
}

TEST(ForgedMessage, MissingOrUnknownBodyIsRefused) {
  for (const int type : {0, 1, 5, 6, 255}) {
    Builder client, server;
    EXPECT_FALSE(decode_client_message(finish_client(client, static_cast<wire::ClientBody>(type), {})));
    EXPECT_FALSE(decode_server_message(finish_server(server, static_cast<wire::ServerBody>(type), {})));
  }
  Builder b;
  const auto goodbye = wire::CreateGoodbye(b).Union();
  EXPECT_FALSE(decode_client_message(finish_client(b, static_cast<wire::ClientBody>(200), goodbye)));
}

TEST(ForgedMessage, MissingOrUnknownCommandIsRefused) {
  for (const int type : {0, 3, 4, 255}) {
    Builder b;
    const auto command = wire::CreateCommand(b, 1, static_cast<wire::What>(type), {}).Union();
    EXPECT_FALSE(decode_client_message(finish_client(b, wire::ClientBody::Command, command)));
  }
}

TEST(ForgedMessage, MissingPartsAreRefusedAndMissingTextsEmpty) {
  Builder scene;
  wire::LoadSceneBuilder without_needle(scene);
  const flatbuffers::Offset<void> table(scene.EndTable(without_needle.start_));
  const auto command = wire::CreateCommand(scene, 1, wire::What::LoadScene, table).Union();
  EXPECT_FALSE(decode_client_message(finish_client(scene, wire::ClientBody::Command, command)));

  Builder hello;
  const auto nameless = wire::CreateHello(hello).Union();
  const auto decoded = decode_client_message(finish_client(hello, wire::ClientBody::Hello, nameless));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(std::get<Hello>(decoded->body).client, "");
}

Bytes forge_settings(std::size_t count, std::size_t text_bytes) {
  Builder b;
  const Text shared = b.CreateString(std::string(text_bytes, 'a'));
  const auto setting = wire::CreateTissueSetting(b, shared);
  const auto settings = b.CreateVector(std::vector<flatbuffers::Offset<wire::TissueSetting>>(count, setting));
  const auto what = wire::CreateSetParameters(b, settings).Union();
  const auto command = wire::CreateCommand(b, 1, wire::What::SetParameters, what).Union();
  return finish_client(b, wire::ClientBody::Command, command);
}

TEST(ForgedMessage, SharedTextDoesNotMultiplyMemory) {
  constexpr std::size_t kLong = 100'000;
  EXPECT_TRUE(decode_client_message(forge_settings(1, kLong)));
  expect_says(complaint(decode_client_message(forge_settings(200, kLong))), "more text than the message");
}

TEST(ForgedMessage, TooManySettingsAreRefused) {
  constexpr std::size_t kMany = 257;
  EXPECT_TRUE(decode_client_message(forge_settings(kMany - 1, 0)));
  expect_says(complaint(decode_client_message(forge_settings(kMany, 0))), "more items");
}

TEST(ForgedMessage, TooManyTicksAreRefused) {
  for (const std::size_t count : {kMostSamples, kMostSamples + 1}) {
    Builder b;
    const auto samples = b.CreateVectorOfStructs(std::vector(count, to_wire(telemetry::TickSample{})));
    const auto batch = wire::CreateStateBatch(b, 1, samples).Union();
    const auto decoded = decode_server_message(finish_server(b, wire::ServerBody::StateBatch, batch));
    EXPECT_EQ(decoded.has_value(), count == kMostSamples);
  }
}

TEST(ForgedMessage, RefusesAShaftWithTooManyOrNonFinitePoints) {
  constexpr std::size_t kMost = telemetry::NeedleShape::kMostSpans;
  const auto forge = [](std::size_t points, float mm) {
    Builder b;
    const auto beside = b.CreateVectorOfStructs(std::vector(points, wire::Beside(mm, mm)));
    const auto batch = wire::CreateStateBatch(b, 1, {}, {}, 0, wire::CreateNeedleShape(b, 1.0, beside)).Union();
    return decode_server_message(finish_server(b, wire::ServerBody::StateBatch, batch));
  };
  EXPECT_TRUE(forge(0, 0.0F));
  EXPECT_TRUE(forge(kMost, -5.0F));
  expect_says(complaint(forge(kMost + 1, 0.0F)), "more points");
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 2000.0F}) EXPECT_FALSE(forge(3, bad));
}

/// A batch of one tick that lies `shift` bytes before where it would be aligned.
Bytes forge_misaligned_batch(const telemetry::TickSample& sample, std::size_t shift) {
  Builder b;
  b.ForceVectorAlignment(sizeof(wire::Sample), 1, alignof(wire::Sample));
  b.Pad(shift);
  const wire::Sample packed = to_wire(sample);
  b.PushBytes(reinterpret_cast<const std::uint8_t*>(&packed), sizeof packed);
  const flatbuffers::Offset<flatbuffers::Vector<const wire::Sample*>> samples(
      b.PushElement<flatbuffers::uoffset_t>(1));  // aligns itself to 4 bytes
  const auto batch = wire::CreateStateBatch(b, 1, samples).Union();
  return finish_server(b, wire::ServerBody::StateBatch, batch);
}

TEST(ForgedMessage, MisalignedTicksAreRefused) {
  const telemetry::TickSample sample = RandomMessages(31).some<telemetry::TickSample>();
  EXPECT_TRUE(decode_server_message(forge_misaligned_batch(sample, 0)));
  expect_says(complaint(decode_server_message(forge_misaligned_batch(sample, 4))), "misaligned ticks");
}

TEST(ForgedMessage, TerminatesOnCycles) {
  // Every table's offset to the next one leads forward: a message can be deep, never endless. Here all offsets are 4.
  Bytes bytes(1024);
  const std::uint32_t four = 4;
  for (std::size_t i = 0; i + sizeof four <= bytes.size(); i += sizeof four) std::memcpy(&bytes[i], &four, sizeof four);
  std::memcpy(&bytes[4], kClientIdentifier, 4);
  EXPECT_FALSE(decode_client_message(bytes));
}

}  // namespace
}  // namespace trocar::link
