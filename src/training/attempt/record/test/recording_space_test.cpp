#include <gtest/gtest.h>

#include "attempt/record/journal.h"

namespace trocar::attempt {
namespace {

constexpr std::uintmax_t kMB = 1'000'000;

TEST(RecordingSpace, IsSilentWithEnoughOrUnknownSpace) {
  for (const RecordingSpace& room : {RecordingSpace("/disk", 1000 * kMB), RecordingSpace("/disk", std::nullopt)}) {
    EXPECT_FALSE(room.is_full());
    EXPECT_TRUE(room.check_start());
    EXPECT_EQ(room.start_warning(), "");
    EXPECT_EQ(room.banner(), "");
  }
}

TEST(RecordingSpace, WarnsBeforeTheStartOfTheRemainingTime) {
  const RecordingSpace room("/disk", 64 * kMB);  // 55 MB to record at 11 MB a minute
  EXPECT_TRUE(room.check_start());
  EXPECT_EQ(room.start_warning(), "The disk is almost full: 64 MB are free in /disk, enough to record 5 minutes.");
  EXPECT_EQ(room.banner(), "");
  EXPECT_EQ(RecordingSpace("/disk", 64 * kMB, 4000.0).left_s(), 0.25 * room.left_s());
}

TEST(RecordingSpace, WarnsWhileRecordingAndKeepsRoomToClose) {
  const RecordingSpace scarce("/disk", 20 * kMB);
  EXPECT_FALSE(scarce.is_full());
  EXPECT_NE(scarce.banner().find("60 s can still be recorded in /disk"), std::string::npos) << scarce.banner();
  EXPECT_TRUE(RecordingSpace("/disk", 8 * kMB).is_full());
}

TEST(RecordingSpace, RefusesAStartWithoutSpace) {
  const Status start = RecordingSpace("/disk", 3 * kMB).check_start();
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().what.find("3.0 MB are free in /disk"), std::string::npos) << start.error().what;
  EXPECT_NE(start.error().advice.find("--state"), std::string::npos);
}

}  // namespace
}  // namespace trocar::attempt
