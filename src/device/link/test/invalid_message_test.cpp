// Well-formed bytes that say what no message may say.
#include <gtest/gtest.h>

#include <limits>

#include "link/codec.h"
#include "link/detail/inspection.h"
#include "link/test/field_walk.h"
#include "link/test/random_message.h"

namespace trocar::link {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_accepted(const ClientMessage& message) {
  return decode_client_message(encode(message)).has_value();
}
bool is_accepted(const ServerMessage& message) {
  return decode_server_message(encode(message)).has_value();
}
bool is_accepted(const ClientBody& body) {
  return is_accepted(ClientMessage{1, 1, body});
}

/// A struct with one field set.
template <class Struct, class Field, class Value>
Struct with(Field Struct::*field, const Value& value) {
  Struct result;
  result.*field = value;
  return result;
}

/// Puts each of `values`, one at a time, into each value of that type (those of ticks apart); all must be refused.
template <class T, class Message>
int expect_none_accepted(const Message& good, const std::vector<T>& values) {
  int count = 0;
  Message counted = good;
  walk(counted, Overloaded{[&](T&) { ++count; }, [](telemetry::TickSample&) {}});
  for (const T& value : values) {
    for (int chosen = 0; chosen < count; ++chosen) {
      Message bad = good;
      int i = 0;
      walk(bad, Overloaded{[&](T& field) {
                             if (i++ == chosen) field = value;
                           },
                           [](telemetry::TickSample&) {}});
      EXPECT_FALSE(is_accepted(bad)) << "field " << chosen << " of body " << good.body.index();
    }
  }
  return count;
}

TEST(UnsoundNumber, IsRefusedInEveryField) {
  const std::vector<double> values = {kNan, kInfinity, -kInfinity, 1e200, -1e200};
  RandomMessages random(21);
  int count = 0;
  for (const ClientMessage& message : random.client_messages()) count += expect_none_accepted(message, values);
  for (const ServerMessage& message : random.server_messages()) count += expect_none_accepted(message, values);
  EXPECT_GE(count, 67) << "numbers of all messages";
}

TEST(UnsoundText, IsRefusedInEveryField) {
  const std::vector<std::string> texts = {std::string(kMostTextBytes + 1, 'a'),
                                          "a\x01",
                                          std::string("a\0b", 3),
                                          "a\x7f",
                                          "\xff",
                                          "a\xc3",
                                          "\xc0\xaf",
                                          "\xc2\x9b"
                                          "31m"};
  RandomMessages random(22);
  int count = 0;
  for (const ClientMessage& message : random.client_messages()) count += expect_none_accepted(message, texts);
  for (const ServerMessage& message : random.server_messages()) count += expect_none_accepted(message, texts);
  EXPECT_GT(count, 20);
}

TEST(UnsoundText, AllowsLineBreaksOnlyInTissueTables) {
  EXPECT_TRUE(is_accepted(Command{1, with(&LoadScene::tissues_toml, "[skin]\r\n\tk = 1 # é\n")}));
  EXPECT_FALSE(is_accepted(Command{1, with(&LoadScene::patient, "a\nb")}));
  EXPECT_FALSE(is_accepted(Command{1, SetParameters{std::vector<TissueSetting>{{"liver\n", "k", 0.5}}}}));
  EXPECT_FALSE(is_accepted(Hello{"a\tb", true}));
}

TEST(CleanText, AcceptsExactlyStandardUtf8) {
  using detail::is_plain_text;
  using detail::Layout;
  for (const char* good : {"", "a b", "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
                           "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(is_plain_text(good, Layout::kLine)) << ::testing::PrintToString(good);
  }
  for (const char* bad : {"\x80",
                          "\xbf",
                          "\xc0\x80",
                          "\xc1\xbf",
                          "\xc2",
                          "\xc2\x41",
                          "\xe0\x80\x80",
                          "\xe0\x9f\xbf",
                          "\xe1\x80",
                          "\xed\xa0\x80",
                          "\xed\xbf\xbf",
                          "\xf0\x80\x80\x80",
                          "\xf0\x8f\xbf\xbf",
                          "\xf4\x90\x80\x80",
                          "\xf5\x80\x80\x80",
                          "\xf8\x88\x80\x80\x80",
                          "\xfe",
                          "\x1b[31m",
                          "\xc2\x80",
                          "\xc2\x9f",
                          "\x7f",
                          "\v",
                          "\f"}) {
    EXPECT_FALSE(is_plain_text(bad, Layout::kLines)) << ::testing::PrintToString(bad);
  }
}

TEST(UnsoundPose, RefusesANonRotation) {
  const auto accepts = [](const Mat3& R) { return is_accepted(with(&HandTarget::X_PN, Pose(R, Vec3::Zero()))); };
  const Mat3 R = RandomMessages(23).some<Pose>().R();
  Mat3 sheared = R;
  sheared.col(0) += 1e-4 * sheared.col(1);
  EXPECT_TRUE(accepts(R));
  EXPECT_FALSE(accepts(sheared));
  EXPECT_FALSE(accepts(Mat3::Zero()));
  EXPECT_FALSE(accepts(-R)) << "mirrored";
  EXPECT_FALSE(accepts(1.0001 * R));
  EXPECT_FALSE(accepts(Vec3(1, 1, -1).asDiagonal() * R));
  EXPECT_FALSE(is_accepted(Command{1, with(&LoadScene::X_PW, Pose(2.0 * R, Vec3::Zero()))}));
}

TEST(UnsoundMotion, IsRefused) {
  const auto accepts = [](const motion::MotionDrive& drive) {
    SetParameters parameters;
    parameters.motion = drive;
    return is_accepted(Command{1, with(&LoadScene::motion, drive)}) && is_accepted(Command{1, parameters});
  };
  EXPECT_TRUE(accepts({}));
  for (const double bad : {-1.0, 0.5, 61.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(accepts({.period_s = bad}));
  EXPECT_FALSE(accepts({.begins_s = 1e12}));
  EXPECT_FALSE(accepts({.held_phase = 1.1}));
  EXPECT_FALSE(accepts({.depth = {0.0, -0.4}}));
  EXPECT_FALSE(accepts({.pause_share = 0.7}));
  EXPECT_FALSE(accepts({.irregularity = 0.5}));
  EXPECT_FALSE(accepts({.cough_every_s = 2.0})) << "no more often than every 5 s";
  EXPECT_FALSE(accepts({.hold_s = -1e12}));
  EXPECT_FALSE(accepts({.hold_limit_s = 0.5}));
  EXPECT_FALSE(accepts({.drift_per_s = 0.2}));
}

TEST(UnsoundPose, RefusesATooDistantPosition) {
  constexpr double kFar_mm = 1e5;
  EXPECT_TRUE(is_accepted(with(&HandTarget::X_PN, Pose::translation({kFar_mm, 0, 0}))));
  EXPECT_FALSE(is_accepted(with(&HandTarget::X_PN, Pose::translation({kFar_mm, 1000, 0}))));
}

TEST(UnsoundNumber, NegativeStiffnessMassOrLengthIsRefused) {
  EXPECT_FALSE(is_accepted(with(&HandTarget::stiffness_n_per_mm, -1e-9)));
  EXPECT_FALSE(is_accepted(with(&HandTarget::damping_ns_per_mm, -1e-9)));
  EXPECT_FALSE(is_accepted(with(&HandTarget::mass_kg, -1e-9)));
  EXPECT_FALSE(is_accepted(with(&HandTarget::inertia_kg_mm2, -1e-9)));
  EXPECT_FALSE(is_accepted(with(&HandTarget::pressed_mm, -1e-9)));
  EXPECT_FALSE(is_accepted(with(&HandTarget::pressed_mm, 101.0)));
  EXPECT_FALSE(is_accepted(Command{1, with(&LoadScene::needle_length_mm, -1.0)}));
  EXPECT_FALSE(is_accepted(Heartbeat{0.0, -1.0, 0}));
}

TEST(UnsoundEnumerator, IsRefused) {
  constexpr auto kLast = static_cast<std::uint8_t>(kLastServerCommand);
  EXPECT_TRUE(is_accepted(Command{1, kLastServerCommand}));
  EXPECT_FALSE(is_accepted(Command{1, static_cast<ServerCommand>(kLast + 1)}));
  EXPECT_FALSE(is_accepted(Command{1, static_cast<ServerCommand>(255)}));
}

bool is_accepted(const ServerStatus& status) {
  return is_accepted(ServerMessage{1, 1, StateBatch{1, {}, status}});
}

TEST(UnsoundEnumerator, IsRefusedInAStatus) {
  const auto accepts = [](auto field, auto last) {
    const auto number = static_cast<int>(last);
    using Enum = decltype(last);
    EXPECT_FALSE(is_accepted(with(field, static_cast<Enum>(number + 1))));
    EXPECT_FALSE(is_accepted(with(field, static_cast<Enum>(255))));
    return is_accepted(with(field, last));
  };
  EXPECT_TRUE(accepts(&ServerStatus::state, kLastServerState));
  EXPECT_TRUE(accepts(&ServerStatus::gate_mode, telemetry::kLastGateMode));
  EXPECT_TRUE(accepts(&ServerStatus::fault, telemetry::kLastGateFault));
}

bool is_accepted_in_a_batch(const telemetry::TickSample& sample) {
  return is_accepted(ServerMessage{1, 1, StateBatch{1, {telemetry::TickSample{}, sample}, std::nullopt}});
}

TEST(UnsoundTick, EnumeratorsOutOfRangeAreRefused) {
  int enumerations = 0;
  telemetry::for_each_tick_field(
      [&]<class Value, telemetry::TickUse use>(const telemetry::TickField<Value, use>& field) {
        if constexpr (std::is_enum_v<Value>) {
          ++enumerations;
          const auto last = static_cast<int>(last_of(Value{}));
          EXPECT_TRUE(is_accepted_in_a_batch(with(field.member, static_cast<Value>(last)))) << field.name;
          EXPECT_FALSE(is_accepted_in_a_batch(with(field.member, static_cast<Value>(last + 1)))) << field.name;
        }
      });
  EXPECT_EQ(enumerations, 3);
  for (std::size_t i = 0; i < 4; ++i) {
    telemetry::TickSample sample;
    sample.events[i].kind = static_cast<telemetry::EventKind>(4);
    EXPECT_FALSE(is_accepted_in_a_batch(sample));
  }
}

TEST(UnsoundTick, RequiresFiniteTimeNeedleAndDevice) {
  for (const double bad : {kNan, kInfinity, 1e200}) {
    EXPECT_FALSE(is_accepted_in_a_batch(with(&telemetry::TickSample::time_s, bad)));
    for (int k = 0; k < 3; ++k) {
      telemetry::TickSample tip, axis, device;
      tip.tip_mm[k] = axis.axis[k] = device.device_mm[k] = bad;
      EXPECT_FALSE(is_accepted_in_a_batch(tip));
      EXPECT_FALSE(is_accepted_in_a_batch(axis));
      EXPECT_FALSE(is_accepted_in_a_batch(device));
    }
  }
}

TEST(UnsoundTick, KeepsTheForcesOfAFault) {
  telemetry::TickSample sample;
  sample.f_total_n.x() = kNan;
  sample.f_stick_n = -kInfinity;
  EXPECT_TRUE(is_accepted_in_a_batch(sample));
}

TEST(UnsoundDevice, ImpossibleDegreesOfFreedomAreRefused) {
  for (const int dof : {-1, 8, std::numeric_limits<int>::max()}) {
    Welcome welcome;
    welcome.device.sensed_dof = dof;
    EXPECT_FALSE(is_accepted(ServerMessage{1, 1, welcome}));
  }
}

}  // namespace
}  // namespace trocar::link
