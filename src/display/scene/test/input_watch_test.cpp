#include "scene/input_watch.h"

#include <gtest/gtest.h>

#include "scene/render_patient.h"
#include "x_pointer.h"

namespace trocar::scene {
namespace {

TEST(InputWatch, DetectsPointerMotionWithoutReadingEvents) {
  if (!can_render()) GTEST_SKIP() << "no X server: run under scripts/with_display";
  move_pointer(100, 100);
  InputWatch watch;
  watch.start();
  EXPECT_FALSE(watch.has_happened());
  move_pointer(101, 100);
  EXPECT_TRUE(watch.has_happened());
  watch.start();
  EXPECT_FALSE(watch.has_happened());
}

}  // namespace
}  // namespace trocar::scene
