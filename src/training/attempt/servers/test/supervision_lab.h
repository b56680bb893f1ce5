#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "attempt/servers/server_supervisor.h"
#include "attempt/servers/test/scripted_server.h"

namespace trocar::attempt {

inline constexpr double kTimeout_s = 2.0;

/// A supervisor of a scripted server, in the time of the test.
class SupervisionTest : public ::testing::Test {
 protected:
  void supervise(const std::string& device = "virtual:premium") {
    server.emplace(clock, device);
    SupervisionOptions options;
    options.recovery = recovery;
    options.timeout = std::chrono::milliseconds(static_cast<int>(1000.0 * kTimeout_s));
    tool.emplace(*server, options, clock);
    PreparationRequest request;
    request.place.X_PN = X_PN;
    tool->prepare(request);
  }
  void start(const std::string& device = "virtual:premium") {
    supervise(device);
    ASSERT_TRUE(run_until([&] { return tool->is_fresh(); })) << tool->banner();
    notes.clear();
  }
  void run_for(double seconds) {
    for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) {
      if (std::string note = tool->poll(); !note.empty()) notes.push_back(std::move(note));
      if (std::string text = tool->take_recovery(); !text.empty()) recoveries.push_back(std::move(text));
      for (std::string& message : tool->take_messages()) messages.push_back(std::move(message));
      ticks += tool->take_samples().size();
      clock.advance(std::chrono::milliseconds(1));
    }
  }
  bool run_until(const std::function<bool()>& is_so, double most_s = 60.0) {
    for (double at_s = 0.0; at_s < most_s && !is_so(); at_s += 0.001) run_for(0.001);
    return is_so();
  }
  bool has_note(const std::string& text) const {
    return std::any_of(notes.begin(), notes.end(), [&](const auto& note) { return note.find(text) != note.npos; });
  }
  bool has_given_up() const { return tool->state() == ServerState::kFailed; }
  bool shows(const std::string& text) const { return tool->banner().find(text) != std::string::npos; }

  testing::FakeClock clock;
  std::optional<testing::ScriptedServer> server;
  std::optional<ServerSupervisor> tool;
  Recovery recovery = Recovery::kAll;
  const Pose X_PN = Pose::translation({10.0, 20.0, 30.0});
  std::vector<std::string> notes, recoveries, messages;
  std::size_t ticks = 0;
};

}  // namespace trocar::attempt
