#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "attempt/live/attempt_loop.h"
#include "attempt/live/live_attempt.h"
#include "attempt/tools/tool_motion.h"
#include "cases/testing/phantom_case.h"
#include "core/files/folders.h"
#include "servers/simulated_server.h"

namespace trocar::servers_test {

/// A case with all data for an attempt, without display data; created once. The abdomen's path to the liver is oblique:
/// a stylus that sags leaves the needle's channel.
inline std::shared_ptr<const cases::OpenCase> prepared_case(const std::string& patient_name) {
  static std::map<std::string, std::shared_ptr<const cases::OpenCase>> kMade;
  std::shared_ptr<const cases::OpenCase>& made = kMade[patient_name];
  if (made) return made;
  auto the_case = testing::phantom_case(patient_name);
  TROCAR_CHECK(the_case.has_value());
  cases::OpenCase open;
  open.choice.patient_source = open.server_source = patient_name;
  open.the_case = *std::move(the_case);
  open.the_case.breathing = {};  // what is compared is at rest
  open.force_model = open.the_case.task.force_model;
  const attempt::RestingTransducer resting(*open.the_case.patient, open.the_case.plan.line_P);
  open.X_PT_start = resting.at(10.0).X_PN;  // pressed onto the skin
  return made = std::make_shared<const cases::OpenCase>(std::move(open));
}

/// An attempt of the window with two simulated haptic servers in simulated time.
class SimulatedAttemptTest : public ::testing::Test {
 protected:
  static constexpr std::chrono::milliseconds kPoll{2};

  attempt::AttemptOptions options() const {
    attempt::AttemptOptions options;
    options.session = folder_ / "attempt.trocar";
    options.free_bytes = nullptr;
    return options;
  }
  void start(const attempt::AttemptOptions& options) {
    loop_.reset();
    servers_.reset();
    needle.emplace(*clock, open->the_case.patient, SimulatedServer::Options{"needle", options.device_needle});
    if (options.has_probe)
      probe.emplace(*clock, open->the_case.patient, SimulatedServer::Options{"probe", options.device_probe});
    servers_ = std::make_shared<attempt::HapticServers>(needle->host(), probe ? probe->host() : nullptr);
    const attempt::SupervisionOptions supervision{attempt::Recovery::kAll, options.timeout, "a test", true};
    attempt.emplace(clock);
    loop_.emplace(attempt::attempt_case(open), attempt::loop_options(*open, options),
                  attempt::trainee_operators(*open, options), servers_, servers_->supervise(supervision, *clock),
                  *clock, *attempt);
  }
  /// Polls the attempt, then advances the time to the next poll, for `seconds`.
  void run_for(double seconds) {
    const int polls = static_cast<int>(seconds / 0.002 + 0.5);
    for (int i = 0; i < polls; ++i) {
      if (loop_ && !loop_->poll()) loop_.reset();
      clock->advance(kPoll);
    }
  }
  bool run_until(const std::function<bool()>& is_so, double most_s = 120.0) {
    for (double at_s = 0.0; at_s < most_s && !is_so(); at_s += 0.002) run_for(0.002);
    return is_so();
  }
  bool run_until_phase(attempt::AttemptPhase phase) {
    return run_until([&] {
             return attempt->view().phase == phase || attempt->view().phase == attempt::AttemptPhase::kFailed;
           }) &&
           attempt->view().phase == phase;
  }
  bool run_until_deeper(double depth_mm) {
    return run_until([&] { return attempt->view().needle.depth_mm > depth_mm; });
  }
  /// Simulates a client without processor time: the attempt and the threads of its connections do not run; servers do.
  void stall_client(double seconds) {
    needle->stall_client(true);
    if (probe) probe->stall_client(true);
    clock->advance(std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>(seconds)));
    needle->stall_client(false);
    if (probe) probe->stall_client(false);
  }
  std::unique_ptr<tasks::Operator> expert() const {
    const cases::Case& the_case = open->the_case;
    tasks::OperatorActions actions = tasks::actions_for(the_case.task, the_case.needle);
    actions.gives_anaesthetic = false;
    return tasks::make_expert({the_case.plan.line_P, the_case.needle.is_biopsy, 1, actions});
  }
  /// Ends the attempt without a score, like closing the window.
  void leave() { loop_.reset(); }
  attempt::RunResult finished() {
    attempt->finish();
    return ended();
  }
  attempt::RunResult ended() {
    if (!run_until([&] { return attempt->view().phase >= attempt::AttemptPhase::kFinished; })) return {};
    auto result = attempt->take_result();
    EXPECT_TRUE(result && *result) << (result && !*result ? result->error().text() : "no result");
    return result && *result ? **result : attempt::RunResult{};
  }
  std::string where() const {
    const attempt::AttemptView view = attempt->view();
    return std::string(to_string(view.phase)) + " | " + view.progress + " | " + view.banner;
  }

  TemporaryFolder folder_;
  std::shared_ptr<testing::FakeClock> clock = std::make_shared<testing::FakeClock>();
  std::shared_ptr<const cases::OpenCase> open = prepared_case("layers-liver");
  std::optional<SimulatedServer> needle, probe;
  std::optional<attempt::AttemptExchange> attempt;

 private:
  std::shared_ptr<attempt::HapticServers> servers_;
  std::optional<attempt::AttemptLoop> loop_;
};

}  // namespace trocar::servers_test
