// Good messages come through the codec whole.
#include "link/codec.h"

#include <gtest/gtest.h>

#include "link/test/fingerprint.h"
#include "link/test/random_message.h"

namespace trocar::link {
namespace {

constexpr std::uint64_t kSeeds = 200;

TEST(Codec, RoundTripsEveryClientMessageBitwise) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const ClientMessage& message : RandomMessages(seed).client_messages()) {
      const auto decoded = decode_client_message(encode(message));
      ASSERT_TRUE(decoded) << decoded.error().text();
      EXPECT_EQ(Fingerprint(*decoded), Fingerprint(message)) << "seed " << seed;
    }
  }
}

TEST(Codec, RoundTripsEveryServerMessageBitwise) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const ServerMessage& message : RandomMessages(seed).server_messages()) {
      const auto decoded = decode_server_message(encode(message));
      ASSERT_TRUE(decoded) << decoded.error().text();
      EXPECT_EQ(Fingerprint(*decoded), Fingerprint(message)) << "seed " << seed;
    }
  }
}

TEST(Codec, RoundTripsDefaultMessages) {
  for (const ClientBody& body :
       {ClientBody(Hello{}), ClientBody(Heartbeat{}), ClientBody(Command{}), ClientBody(Command{0, LoadScene{}}),
        ClientBody(Command{0, SetParameters{}}), ClientBody(Command{0, SetParameters{std::vector<TissueSetting>()}}),
        ClientBody(HandTarget{}), ClientBody(Goodbye{})}) {
    const ClientMessage message{0, 0, body};
    const auto decoded = decode_client_message(encode(message));
    ASSERT_TRUE(decoded) << decoded.error().text();
    EXPECT_EQ(Fingerprint(*decoded), Fingerprint(message));
  }
  for (const ServerBody& body : {ServerBody(Welcome{}), ServerBody(StateBatch{}),
                                 ServerBody(StateBatch{0, {telemetry::TickSample{}}, ServerStatus{}}),
                                 ServerBody(Reply{}), ServerBody(Pong{})}) {
    const ServerMessage message{0, 0, body};
    const auto decoded = decode_server_message(encode(message));
    ASSERT_TRUE(decoded) << decoded.error().text();
    EXPECT_EQ(Fingerprint(*decoded), Fingerprint(message));
  }
}

TEST(Codec, LargestBatchAndLongestTextFit) {
  RandomMessages random(1);
  StateBatch batch;
  batch.samples.resize(kMostSamples);
  for (telemetry::TickSample& sample : batch.samples) sample = random.some<telemetry::TickSample>();
  batch.status = random.some<ServerStatus>();
  batch.shape = random.some<telemetry::NeedleShape>();
  const ServerMessage many{1, 1, batch};
  ASSERT_LE(encode(many).size(), kMostMessageBytes);
  const auto decoded = decode_server_message(encode(many));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(Fingerprint(*decoded), Fingerprint(many));

  LoadScene scene;
  scene.tissues_toml.assign(kMostTextBytes, '#');
  EXPECT_TRUE(decode_client_message(encode(ClientMessage{1, 1, Command{1, scene}})));
}

TEST(Codec, BytesMayStartAnywhere) {
  const ServerMessage message{1, 1, StateBatch{1, {RandomMessages(3).some<telemetry::TickSample>()}, std::nullopt}};
  const Bytes bytes = encode(message);
  for (std::size_t shift = 0; shift < sizeof(double); ++shift) {
    Bytes shifted(shift);
    shifted.insert(shifted.end(), bytes.begin(), bytes.end());
    const auto decoded = decode_server_message(std::span(shifted).subspan(shift));
    ASSERT_TRUE(decoded) << decoded.error().text();
    EXPECT_EQ(Fingerprint(*decoded), Fingerprint(message));
  }
}

TEST(Codec, OrthonormalisesASlightlyInexactRotationOnce) {
  const Mat3 R = (1.0 + 1e-7) * RandomMessages(4).some<Pose>().R();
  HandTarget target;
  target.X_PN = Pose(R, Vec3(1, 2, 3));
  const auto decoded = decode_client_message(encode(ClientMessage{1, 1, target}));
  ASSERT_TRUE(decoded) << decoded.error().text();
  const Mat3 mended = std::get<HandTarget>(decoded->body).X_PN.R();
  constexpr double kRounding = 1e-15;
  EXPECT_LT((mended.transpose() * mended - Mat3::Identity()).norm(), 4 * kRounding);
  EXPECT_LT((mended - R).norm(), 1e-6);
  const auto again = decode_client_message(encode(*decoded));
  ASSERT_TRUE(again);
  EXPECT_EQ(Fingerprint(*again), Fingerprint(*decoded));
}

TEST(CodecDeathTest, AbortsOnATooLongBatch) {
  StateBatch batch;
  batch.samples.resize(kMostSamples + 1);
  EXPECT_DEATH(encode(ServerMessage{1, 1, batch}), "kMostSamples");
}

}  // namespace
}  // namespace trocar::link
