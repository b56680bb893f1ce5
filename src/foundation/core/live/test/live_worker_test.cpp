#include "core/live/live_worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/live/test/live_test_traits.h"
#include "core/testing/no_threads.h"

namespace trocar {
namespace {

using testing::TestLevel;
using testing::TestTraits;
using Worker = LiveWorker<TestTraits>;
using Image = TestTraits::Image;

/// Moved by the renderer and by the test.
class StageClock final : public Clock {
 public:
  TimePoint now() const noexcept override { return TimePoint(now_.load()); }
  void sleep_for(Duration duration) override { now_ = now_.load() + duration; }
  void advance_ms(double ms) { sleep_for(std::chrono::nanoseconds(std::llround(1e6 * ms))); }

 private:
  std::atomic<Duration> now_{std::chrono::seconds(10)};
};

/// What renderer and test share. The renderer moves the clock by the cost of its frames; it waits where `is_gated` for
/// the test, where `is_until_stop` until it is told to stop.
struct Stage {
  std::shared_ptr<StageClock> clock = std::make_shared<StageClock>();
  std::atomic<double> ms_per_work{5.0};
  std::atomic<bool> is_gated{false}, is_until_stop{false}, is_held{false}, was_stopped{false};
  std::counting_semaphore<> begun{0}, go_on{0};
  std::vector<int> rendered;  ///< Read while the worker is idle.

  LiveWorkerOptions options() const { return {.threads = 1, .nice = 0, .clock = clock}; }
};

constexpr int kFails = -1, kThrows = -2;

class TestRenderer final : public LiveRenderer<TestTraits> {
 public:
  explicit TestRenderer(Stage& stage) : stage_(stage) {}

  Result<Image> render(const Request& request, const Frame& frame) override {
    if (stage_.is_gated) {
      stage_.begun.release();
      if (!stage_.is_until_stop) stage_.go_on.acquire();
      while (stage_.is_until_stop && !frame.stop.stop_requested()) std::this_thread::yield();
    }
    stage_.was_stopped = frame.stop.stop_requested();
    if (request.place == kFails) return fail("no image");
    if (request.place == kThrows) throw std::runtime_error("a library's error");
    stage_.clock->advance_ms(stage_.ms_per_work * TestTraits().work(request, frame.level));
    stage_.rendered.push_back(request.place);
    return Image{request.place, frame.level};
  }
  bool is_held() override { return stage_.is_held; }
  Result<std::optional<Image>> render_held(const Request& request, const Frame&) override {
    if (request.place == held_place_) return std::nullopt;
    held_place_ = request.place;
    return Image{1000 + request.place};
  }

 private:
  Stage& stage_;
  int held_place_ = 0;
};

TEST(LiveWorker, RendersTheNewestRequest) {
  Stage stage;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  EXPECT_EQ(worker.images().value(), nullptr);
  stage.is_gated = true;
  worker.request({1});
  stage.begun.acquire();  // in work
  for (int place = 2; place <= 100; ++place) worker.request({place});
  stage.is_gated = false;
  stage.go_on.release();
  worker.wait_until_idle();
  EXPECT_EQ(stage.rendered, (std::vector<int>{1, 100}));
  ASSERT_NE(worker.images().value(), nullptr);
  EXPECT_EQ(worker.images().value()->place, 100);
  EXPECT_EQ(worker.images().value()->number, 2U);
}

TEST(LiveWorker, DetailFollowsTheMeasuredCost) {
  Stage stage;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  const auto level_at = [&](double ms_per_work) {
    stage.ms_per_work = ms_per_work;
    for (int n = 0; n < 60; ++n) {
      static int place = 0;
      worker.request({++place});
      worker.wait_until_idle();
      stage.clock->advance_ms(10.0);
    }
    EXPECT_NEAR(worker.images().value()->took_ms, ms_per_work * TestTraits().work({}, worker.images().value()->level),
                1e-6);
    return worker.images().value()->level;
  };
  EXPECT_EQ(level_at(5.0), TestLevel::kFine);
  EXPECT_EQ(level_at(18.0), TestLevel::kMiddle);
  EXPECT_EQ(level_at(60.0), TestLevel::kCoarse);
  EXPECT_EQ(level_at(5.0), TestLevel::kFine);
}

TEST(LiveWorker, RendersUnchangedRequestsOnlyAtTheRefreshTime) {
  Stage stage;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  for (int n = 0; n < 3; ++n) {
    worker.request({7});
    worker.wait_until_idle();
  }
  EXPECT_EQ(stage.rendered.size(), 1U);
  stage.clock->advance_ms(200.0);
  worker.request({7});
  worker.wait_until_idle();
  EXPECT_EQ(stage.rendered.size(), 2U);
}

TEST(LiveWorker, StopsDuringAFrame) {
  Stage stage;
  {
    Worker worker(stage.options());
    worker.open(std::make_unique<TestRenderer>(stage));
    stage.is_gated = true;
    stage.is_until_stop = true;
    worker.request({1});
    stage.begun.acquire();
    worker.request({2});
  }  // the frame ends some time after the destructor has begun
  EXPECT_EQ(stage.rendered, (std::vector<int>{1})) << "a request that waits is dropped";
}

TEST(LiveWorker, NewSubjectDropsTheFrameInProgress) {
  Stage stage, other;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  stage.is_gated = true;
  worker.request({1});
  stage.begun.acquire();
  worker.open(std::make_unique<TestRenderer>(other));
  stage.go_on.release();
  worker.wait_until_idle();
  EXPECT_TRUE(stage.was_stopped) << "the renderer is told";
  EXPECT_EQ(worker.images().value(), nullptr);
  worker.request({1});
  worker.wait_until_idle();
  EXPECT_EQ(other.rendered, (std::vector<int>{1})) << "due at once, although the place is the same";
}

TEST(LiveWorker, FailedFrameKeepsTheLastImageUntilTheNextRequest) {
  Stage stage;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  worker.request({1});
  worker.wait_until_idle();
  for (const int place : {kFails, kThrows}) {
    worker.request({place});
    worker.wait_until_idle();
    EXPECT_TRUE(worker.error());
    EXPECT_EQ(worker.images().value()->place, 1);
  }
  worker.request({2});
  worker.wait_until_idle();
  EXPECT_FALSE(worker.error());
  EXPECT_EQ(worker.images().value()->place, 2);
}

TEST(LiveWorker, HeldImageBypassesTheSchedule) {
  Stage stage;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  worker.request({1});
  worker.wait_until_idle();
  stage.is_held = true;
  worker.request({5});
  worker.wait_until_idle();
  EXPECT_EQ(worker.images().value()->place, 1005);
  const auto kept = worker.images().value();
  worker.request({5});
  worker.wait_until_idle();
  EXPECT_EQ(worker.images().value(), kept) << "unchanged";
  stage.is_held = false;
  worker.request({1});
  worker.wait_until_idle();
  EXPECT_EQ(worker.images().value()->place, 1) << "due although it was rendered a moment ago";
}

TEST(LiveWorker, RequestsWithoutASubjectAreDropped) {
  Stage stage;
  Worker worker(stage.options());
  worker.request({1});
  worker.wait_until_idle();
  EXPECT_EQ(worker.images().value(), nullptr);
}

TEST(LiveWorker, ReportsAMissingThreadAndRetriesOnRequest) {
  Stage stage;
  Worker worker(stage.options());
  worker.open(std::make_unique<TestRenderer>(stage));
  {
    const testing::NoThreads none;
    worker.request({1});
    ASSERT_TRUE(worker.error());
    EXPECT_NE(worker.error()->what.find("does not start"), std::string::npos);
    worker.wait_until_idle();
    EXPECT_FALSE(worker.images().value());
  }
  worker.request({2});
  worker.wait_until_idle();
  ASSERT_TRUE(worker.images().value());
  EXPECT_FALSE(worker.error());
}

}  // namespace
}  // namespace trocar
