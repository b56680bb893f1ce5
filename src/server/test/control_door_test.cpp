#include <gtest/gtest.h>

#include "server/detail/shared.h"

namespace trocar {
namespace {

ControlJob scene_job(std::uint32_t request) {
  return {1, request, LoadScene{}};
}

TEST(ControlDoor, ANewerSceneStopsTheOneThatIsLoaded) {
  ControlDoor door;
  ControlJob job;
  door.post(scene_job(1));
  ASSERT_TRUE(door.wait(job));
  const std::stop_token first = door.stop_token();
  EXPECT_FALSE(first.stop_requested());
  door.post({1, 2, SetParameters{}});
  EXPECT_FALSE(first.stop_requested()) << "numbers wait for their scene";
  door.post(scene_job(3));
  EXPECT_TRUE(first.stop_requested());
}

TEST(ControlDoor, OfWaitingScenesTheNewestIsLoaded) {
  ControlDoor door;
  ControlJob job;
  for (const std::uint32_t request : {1u, 2u, 3u}) door.post(scene_job(request));
  for (const std::uint32_t request : {1u, 2u, 3u}) {
    ASSERT_TRUE(door.wait(job));
    EXPECT_EQ(job.request, request) << "each gets its reply";
    EXPECT_EQ(door.stop_token().stop_requested(), request != 3);
  }
}

TEST(ControlDoor, ClosingStopsTheRunningJob) {
  ControlDoor door;
  ControlJob job;
  door.post(scene_job(1));
  ASSERT_TRUE(door.wait(job));
  const std::stop_token token = door.stop_token();
  door.close();
  EXPECT_TRUE(token.stop_requested());
  EXPECT_FALSE(door.wait(job));
}

}  // namespace
}  // namespace trocar
