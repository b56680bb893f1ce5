#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "attempt/live/live_attempt.h"
#include "cases/testing/cached_case.h"
#include "core/files/folders.h"
#include "servers/live_server.h"

namespace trocar::servers_test {

inline std::shared_ptr<const cases::OpenCase> layered_case() {
  static const std::shared_ptr<const cases::OpenCase> kOpen = [] {
    cases::CaseChoice choice;
    choice.patient_source = "layers-liver";
    auto made = testing::open_cached_case(choice);
    EXPECT_TRUE(made) << made.error().text();
    return made ? *made : nullptr;
  }();
  return kOpen;
}

/// The path to the liver is oblique: a stylus that sags leaves the needle's channel. The patient is cached, so that the
/// servers do not generate it again.
inline std::shared_ptr<const cases::OpenCase> abdomen_case() {
  static const std::shared_ptr<const cases::OpenCase> kOpen = [] {
    cases::CaseChoice choice;
    choice.options.breathing = "none";  // tests of stalls and lost servers compare places
    auto made = testing::open_cached_case(choice);
    EXPECT_TRUE(made) << made.error().text();
    return made ? *made : nullptr;
  }();
  return kOpen;
}

class LiveAttemptTest : public ::testing::Test {
 protected:
  attempt::AttemptOptions options() const {
    attempt::AttemptOptions options;
    options.session = folder_ / "attempt.trocar";
    options.priority = 0;  // ordinary scheduling: it takes no core from other tests
    options.timeout = std::chrono::seconds(30);
    return options;
  }
  void start(const attempt::AttemptOptions& options, std::shared_ptr<attempt::HapticServers> servers = nullptr) {
    attempt = std::make_unique<attempt::LiveAttempt>(open, options, std::move(servers));
  }
  bool wait_phase(attempt::AttemptPhase phase) {
    return wait_for([&] {
             const attempt::AttemptPhase now = attempt->view().phase;
             return now == phase || now == attempt::AttemptPhase::kFailed;
           }) &&
           attempt->view().phase == phase;
  }
  std::unique_ptr<tasks::Operator> expert() const {
    const cases::Case& the_case = open->the_case;
    return tasks::make_expert({the_case.plan.line_P, the_case.needle.is_biopsy, 1});
  }
  bool wait_deeper(double depth_mm) {
    return wait_for([&] { return attempt->view().needle.depth_mm > depth_mm; });
  }
  attempt::RunResult finished() {
    if (!wait_for([&] { return attempt->view().phase >= attempt::AttemptPhase::kFinished; })) return {};
    auto result = attempt->take_result();
    EXPECT_TRUE(result && *result) << (result && !*result ? result->error().text() : "no result");
    EXPECT_FALSE(attempt->take_result());
    return result && *result ? **result : attempt::RunResult{};
  }
  std::string where() const {
    const attempt::AttemptView view = attempt->view();
    return std::string(to_string(view.phase)) + " | " + view.progress + " | " + view.banner;
  }

  TemporaryFolder folder_;
  std::shared_ptr<const cases::OpenCase> open = layered_case();
  std::unique_ptr<attempt::LiveAttempt> attempt;
};

}  // namespace trocar::servers_test
