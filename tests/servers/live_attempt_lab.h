#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/files/temporary_folder.h"
#include "servers/live_server.h"
#include "attempt/live/live_attempt.h"
#include "attempt/case/open_case.h"

namespace trocar::servers_test {

inline std::shared_ptr<const OpenCase> layered_case() {
  static const std::shared_ptr<const OpenCase> kOpen = [] {
    CaseChoice choice;
    choice.patient_source = "layers-liver";
    auto made = make_open_case(choice);
    EXPECT_TRUE(made) << made.error().text();
    return made ? *made : nullptr;
  }();
  return kOpen;
}

/// Its way to the liver is slanted: a stylus that sags leaves the needle's channel. The patient is kept, so that the
/// servers need not make it again.
inline std::shared_ptr<const OpenCase> abdomen_case() {
  static const TemporaryFolder kKept;
  static const std::shared_ptr<const OpenCase> kOpen = [] {
    auto made = make_open_case({}, OpenOptions{nullptr, kKept.path()});
    EXPECT_TRUE(made) << made.error().text();
    return made ? *made : nullptr;
  }();
  return kOpen;
}

class LiveAttemptTest : public ::testing::Test {
 protected:
  AttemptOptions options() const {
    AttemptOptions options;
    options.session = folder_ / "attempt.trocar";
    options.priority = 0;  // ordinary scheduling: it takes no core from other tests
    options.patience = std::chrono::seconds(30);
    return options;
  }
  void start(const AttemptOptions& options, std::shared_ptr<SeatServers> servers = nullptr) {
    attempt = std::make_unique<LiveAttempt>(open, options, std::move(servers));
  }
  bool wait_phase(AttemptPhase phase) {
    return wait_for([&] {
             const AttemptPhase now = attempt->view().phase;
             return now == phase || now == AttemptPhase::kFailed;
           }) &&
           attempt->view().phase == phase;
  }
  std::unique_ptr<Operator> expert() const {
    const Case& the_case = open->the_case;
    return make_expert({the_case.plan.line_P, the_case.needle.is_biopsy, 1});
  }
  bool wait_deeper(double depth_mm) {
    return wait_for([&] { return attempt->view().needle.depth_mm > depth_mm; });
  }
  RunResult finished() {
    if (!wait_for([&] { return attempt->view().phase >= AttemptPhase::kFinished; })) return {};
    auto result = attempt->take_result();
    EXPECT_TRUE(result && *result) << (result && !*result ? result->error().text() : "no result");
    EXPECT_FALSE(attempt->take_result());
    return result && *result ? **result : RunResult{};
  }
  std::string where() const {
    const AttemptView view = attempt->view();
    return std::string(to_string(view.phase)) + " | " + view.progress + " | " + view.banner;
  }

  TemporaryFolder folder_;
  std::shared_ptr<const OpenCase> open = layered_case();
  std::unique_ptr<LiveAttempt> attempt;
};

}  // namespace trocar::servers_test
