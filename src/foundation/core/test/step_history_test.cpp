#include "core/step_history.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace trocar {
inline namespace core {
namespace {

TEST(StepHistory, UndoAndRedoVisitTheSameValues) {
  // Against a plain list of all values with an index.
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    StepHistory<int> history;
    std::vector<int> all{0};
    std::size_t now = 0;
    for (std::uint64_t n = 0; n < 200; ++n) {
      const double chance = uniform01(seed, n);
      if (chance < 0.4) {
        history.step_to(static_cast<int>(n) + 1);
        all.resize(++now);
        all.push_back(static_cast<int>(n) + 1);
      } else if (chance < 0.5) {
        history.step_to(-static_cast<int>(n), true);
        all.resize(now == 0 ? 1 : now);
        all.push_back(-static_cast<int>(n));
        now = all.size() - 1;
      } else if (chance < 0.8) {
        history.undo();
        now -= now > 0 ? 1 : 0;
      } else {
        history.redo();
        now += now + 1 < all.size() ? 1 : 0;
      }
      ASSERT_EQ(history.now(), all[now]);
      ASSERT_EQ(history.can_undo(), now > 0);
      ASSERT_EQ(history.can_redo(), now + 1 < all.size());
      if (history.can_redo()) {
        ASSERT_EQ(history.next(), all[now + 1]);
      }
    }
  }
}

TEST(StepHistory, DropsOnlyTheOldestSteps) {
  StepHistory<int> history(3);
  for (int n = 1; n <= 10; ++n) history.step_to(n);
  for (int n = 0; n < 10; ++n) history.undo();
  EXPECT_EQ(history.now(), 7);
  for (int n = 0; n < 10; ++n) history.redo();
  EXPECT_EQ(history.now(), 10);
}

TEST(StepHistory, PutAddsNoStepAndChangeAllEditsEveryValue) {
  StepHistory<int> history;
  history.step_to(1);
  history.step_to(2);
  history.undo();
  history.put(5);
  EXPECT_TRUE(history.can_redo());
  history.change_all([](int& value) { value += 100; });
  EXPECT_EQ(history.now(), 105);
  history.redo();
  EXPECT_EQ(history.now(), 102);
  history.undo();
  history.undo();
  EXPECT_EQ(history.now(), 100);
  history.begin(9);
  EXPECT_FALSE(history.can_undo() || history.can_redo());
}

}  // namespace
}  // namespace core
}  // namespace trocar
