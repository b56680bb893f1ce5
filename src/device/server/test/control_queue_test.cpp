#include <gtest/gtest.h>

#include "server/detail/shared.h"

namespace trocar::server {
namespace {

ControlJob scene_job(std::uint32_t request) {
  return {1, request, link::LoadScene{}};
}

TEST(ControlQueue, NewerSceneStopsTheLoadingOne) {
  ControlQueue queue;
  ControlJob job;
  queue.post(scene_job(1));
  ASSERT_TRUE(queue.wait(job));
  const std::stop_token first = queue.stop_token();
  EXPECT_FALSE(first.stop_requested());
  queue.post({1, 2, link::SetParameters{}});
  EXPECT_FALSE(first.stop_requested()) << "numbers wait for their scene";
  queue.post(scene_job(3));
  EXPECT_TRUE(first.stop_requested());
}

TEST(ControlQueue, LoadsOnlyTheNewestWaitingScene) {
  ControlQueue queue;
  ControlJob job;
  for (const std::uint32_t request : {1u, 2u, 3u}) queue.post(scene_job(request));
  for (const std::uint32_t request : {1u, 2u, 3u}) {
    ASSERT_TRUE(queue.wait(job));
    EXPECT_EQ(job.request, request) << "each gets its reply";
    EXPECT_EQ(queue.stop_token().stop_requested(), request != 3);
  }
}

TEST(ControlQueue, ClosingStopsTheRunningJob) {
  ControlQueue queue;
  ControlJob job;
  queue.post(scene_job(1));
  ASSERT_TRUE(queue.wait(job));
  const std::stop_token token = queue.stop_token();
  queue.close();
  EXPECT_TRUE(token.stop_requested());
  EXPECT_FALSE(queue.wait(job));
}

ControlJob parameters_of(std::size_t bytes) {
  link::SetParameters parameters;
  parameters.tissues.emplace().push_back({std::string(bytes, 'x'), "k", 0.5});
  return {1, 2, parameters};
}

TEST(ControlQueue, FlightsUseReservedPlacesAndRunFirst) {
  ControlQueue queue;
  while (queue.post({1, 2, link::ServerCommand::kReconnect})) {
  }
  for (std::size_t i = 0; i < kMostFlights; ++i) EXPECT_TRUE(queue.post(Flight(i + 1)));
  EXPECT_FALSE(queue.post(Flight(9)));
  ControlJob job;
  ASSERT_TRUE(queue.wait(job));
  ASSERT_TRUE(std::holds_alternative<Flight>(job.what));
  EXPECT_EQ(std::get<Flight>(job.what).size(), 1u);
  EXPECT_EQ(job.session, 0u);
  queue.close();
  EXPECT_FALSE(queue.wait(job));
  EXPECT_EQ(queue.take_flights().size(), kMostFlights - 1) << "those that are still to be written";
  EXPECT_TRUE(queue.take_flights().empty());
}

TEST(ControlQueue, AFlightDoesNotStopALoading) {
  ControlQueue queue;
  ControlJob job;
  queue.post(scene_job(1));
  ASSERT_TRUE(queue.wait(job));
  EXPECT_TRUE(queue.post(Flight(1)));
  EXPECT_FALSE(queue.stop_token().stop_requested());
}

TEST(ControlQueue, BoundsTheNumberOfJobs) {
  ControlQueue queue;
  for (std::size_t i = 0; i < kMostJobs; ++i) EXPECT_TRUE(queue.post({1, 2, link::ServerCommand::kReconnect}));
  EXPECT_FALSE(queue.post({1, 2, link::ServerCommand::kReconnect}));
  ControlJob job;
  ASSERT_TRUE(queue.wait(job));
  EXPECT_TRUE(queue.post({1, 2, link::ServerCommand::kReconnect}));
}

TEST(ControlQueue, BoundsTheBytesOfText) {
  constexpr std::size_t kLarge = 600'000;
  ControlQueue queue;
  std::size_t taken = 0;
  while (queue.post(parameters_of(kLarge))) ASSERT_LT(++taken, 100u);
  EXPECT_LE(taken * kLarge, kMostJobBytes);
  EXPECT_GT(taken, 0u);
  link::LoadScene scene;
  scene.tissues_toml.assign(kLarge, 'x');
  EXPECT_FALSE(queue.post({1, 2, scene}));
  EXPECT_TRUE(queue.post({1, 2, link::ServerCommand::kReconnect})) << "a small job still has its place";
  // What is done makes room again, to the last byte.
  ControlJob job;
  for (std::size_t i = 0; i <= taken; ++i) ASSERT_TRUE(queue.wait(job));
  for (std::size_t i = 0; i < taken; ++i) EXPECT_TRUE(queue.post(parameters_of(kLarge)));
  EXPECT_FALSE(queue.post(parameters_of(kLarge)));
}

}  // namespace
}  // namespace trocar::server
