#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "server/servo_commands.h"

namespace trocar::server {
namespace {

using link::ServerCommand;

/// The steps of one period of the real-time thread.
void run_command_period(CommandQueue& queue, ServoSwitches& switches) {
  queue.apply_stops(switches);
  switches.begin_period();
  queue.apply_commands(switches);
  queue.confirm(switches);
}

void fill(CommandQueue& queue) {
  while (queue.push(ServerCommand::kStart, 0)) {
  }
}

TEST(CommandQueue, AcceptsAStopWhenFull) {
  CommandQueue queue;
  ServoSwitches switches;
  fill(queue);
  run_command_period(queue, switches);
  ASSERT_TRUE(switches.is_wanted);
  fill(queue);
  EXPECT_FALSE(queue.push(ServerCommand::kResetFault, 0));
  EXPECT_TRUE(queue.push(ServerCommand::kStop, 1));
  EXPECT_FALSE(queue.have_stops_taken_effect());
  for (std::size_t period = 0; period < CommandQueue::kCapacity; ++period) {
    run_command_period(queue, switches);
    EXPECT_FALSE(switches.is_wanted) << "period " << period << ": a kStart from before the stop took effect";
  }
  EXPECT_TRUE(queue.have_stops_taken_effect());
  EXPECT_TRUE(queue.push(ServerCommand::kStart, 2));
  run_command_period(queue, switches);
  EXPECT_TRUE(switches.is_wanted);
}

/// Every order of a stop and of a period's two looks at it.
TEST(CommandQueue, NeverAppliesAStartFromBeforeAStop) {
  for (int stop_before = 0; stop_before < 2; ++stop_before) {
    CommandQueue queue;
    ServoSwitches switches;
    queue.push(ServerCommand::kStart, 0);
    if (stop_before == 1) queue.stop(1);
    queue.apply_stops(switches);
    if (stop_before == 0) queue.stop(1);  // between the looks: the next period sees it
    queue.apply_commands(switches);
    EXPECT_EQ(switches.is_wanted, stop_before == 0);
    run_command_period(queue, switches);
    EXPECT_FALSE(switches.is_wanted);
  }
}

TEST(CommandQueue, AppliesAStartFromAfterAStop) {
  CommandQueue queue;
  ServoSwitches switches;
  queue.push(ServerCommand::kStart, 0);
  queue.apply_stops(switches);
  queue.push(ServerCommand::kStop, 1);  // not seen by this period's look at the stops, but by its commands
  queue.push(ServerCommand::kStart, 2);
  queue.apply_commands(switches);
  EXPECT_TRUE(switches.is_wanted);
  EXPECT_EQ(switches.stops, 1u);
  queue.confirm(switches);
  EXPECT_TRUE(queue.have_stops_taken_effect());
}

TEST(CommandQueue, NoOtherCommandTurnsForcesOn) {
  for (int number = 0; number <= static_cast<int>(link::kLastServerCommand); ++number) {
    const auto command = static_cast<ServerCommand>(number);
    if (command == ServerCommand::kStart) continue;
    for (const bool is_queued_before : {true, false}) {
      CommandQueue queue;
      ServoSwitches switches;
      queue.push(ServerCommand::kStart, 0);
      if (is_queued_before) queue.push(command, 1);
      queue.stop(2);
      if (!is_queued_before) queue.push(command, 3);
      run_command_period(queue, switches);
      EXPECT_FALSE(switches.is_wanted) << number << (is_queued_before ? " before" : " after");
      EXPECT_EQ(switches.is_reset, command == ServerCommand::kResetFault) << "a reset is not lost";
    }
  }
}

/// Both threads without pauses, for scripts/sanitize thread.
TEST(CommandQueue, LosesNoStopBetweenTwoThreads) {
  CommandQueue queue;
  std::atomic<bool> is_ending{false}, is_wanted{false};
  std::atomic<std::uint64_t> periods{0};
  std::thread servo([&] {
    for (ServoSwitches switches; !is_ending; ++periods) {
      queue.apply_stops(switches);
      switches.begin_period();
      queue.apply_commands(switches);
      is_wanted.store(switches.is_wanted, std::memory_order_relaxed);
      queue.confirm(switches);
    }
  });
  int lost = 0;
  for (int round = 0; round < 500; ++round) {
    for (int i = 0; i < 100; ++i) queue.push(ServerCommand::kStart, 1);
    queue.stop(round);
    while (!queue.have_stops_taken_effect()) std::this_thread::yield();
    lost += is_wanted.load(std::memory_order_relaxed) ? 1 : 0;
    const std::uint64_t end = periods + CommandQueue::kCapacity / CommandQueue::kMostAPeriod + 2;
    while (periods < end) std::this_thread::yield();
    lost += is_wanted.load(std::memory_order_relaxed) ? 1 : 0;
  }
  is_ending = true;
  servo.join();
  EXPECT_EQ(lost, 0);
}

TEST(CommandQueue, KeepsTheTimeOfTheOldestPendingStop) {
  CommandQueue queue;
  ServoSwitches switches;
  queue.stop(10);
  queue.stop(20);
  EXPECT_TRUE(queue.apply_stops(switches));
  EXPECT_EQ(queue.stopped_ns(), 10);
  EXPECT_FALSE(queue.apply_stops(switches));
  queue.confirm(switches);
  queue.stop(30);
  EXPECT_TRUE(queue.apply_stops(switches));
  EXPECT_EQ(queue.stopped_ns(), 30);
}

}  // namespace
}  // namespace trocar::server
