#include "bench/training/stations.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "attempt/tools/tool_motion.h"
#include "volume/sampling.h"

namespace trocar::bench {
namespace {

constexpr int kSlicePixels = 512;
constexpr double kSlice_mm = 200.0;
constexpr auto kPatience_ms = std::chrono::duration_cast<std::chrono::milliseconds>(kPatience);

Result<Station> open_station(const std::filesystem::path& program, const TemporaryFolder& folder,
                             const std::string& tool, double rate_hz) {
  const std::string url = "ipc://" + (folder / tool).string();
  const std::vector<std::string> arguments{"--device",         "virtual:premium",
                                           "--tool",           tool,
                                           "--rate",           fmt::format("{:.0f}", rate_hz),
                                           "--endpoint",       url,
                                           "--flight-records", folder.path().string()};
  TROCAR_TRY(link::ServerProcess process, link::ServerProcess::start(program, arguments, folder / (tool + ".log")));
  link::ClientOptions options;
  options.endpoint = url;
  options.name = "trocar bench";
  options.has_window = true;
  TROCAR_TRY(link::HapticClient client, link::HapticClient::connect(options));
  TROCAR_TRY_STATUS(client.wait_connected(kPatience_ms));
  return Station{tool, std::move(process), std::move(client), 0.0};
}

/// In and out along the path, 12 s per cycle, with a small tremor.
link::HandTarget needle_hand(const Segment& line_P, double time_s) {
  constexpr double kCycle_s = 12.0, kTremor_hz = 9.0, kTremor_mm = 0.1, kOutside_mm = 10.0;
  const double swing = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time_s / kCycle_s);
  const double way_mm = -kOutside_mm + (line_P.length_mm() + kOutside_mm) * swing;
  const Vec3 u = line_P.direction();
  const Vec3 side = u.unitOrthogonal() * kTremor_mm * std::sin(2.0 * std::numbers::pi * kTremor_hz * time_s);
  link::HandTarget hand;
  hand.X_PN = needle_pose(line_P.a + u * way_mm + side, u);
  hand.holds_tip = true;
  return hand;
}

Status start(Station& station, const cases::Case& the_case, haptics::ForceModel model,
             const attempt::RestingTransducer& probe) {
  cases::SceneChoice choice;
  choice.tool = station.tool;
  choice.force_model = to_string(model);
  choice.patient_source = "abdomen";
  link::LoadScene request = cases::scene_request(the_case, choice);
  request.patient_hash.clear();
  const bool is_needle = station.tool == "needle";
  if (!is_needle) request.X_PW = attempt::transducer_room(request.X_PW, probe.X_PT_room());
  TROCAR_TRY_STATUS(station.client.ask(request, kPatience_ms));
  link::HandTarget hand = is_needle ? needle_hand(the_case.plan.line_P, 0.0) : probe.at(0.0);
  hand.is_placed = true;
  station.client.set_hand(hand);
  TROCAR_TRY_STATUS(station.client.ask(link::ServerCommand::kStart, kPatience_ms));
  return {};
}

}  // namespace

Result<Stations> start_stations(const TemporaryFolder& folder, const cases::Case& the_case, double rate_hz,
                                haptics::ForceModel model) {
  TROCAR_TRY(const std::filesystem::path program, link::find_server_program());
  TROCAR_TRY(Station needle, open_station(program, folder, "needle", rate_hz));
  TROCAR_TRY(Station transducer, open_station(program, folder, "probe", rate_hz));
  Stations stations{std::move(needle), std::move(transducer)};
  const attempt::RestingTransducer probe(*the_case.patient, the_case.plan.line_P);
  for (Station& station : stations) TROCAR_TRY_STATUS(start(station, the_case, model, probe));
  return stations;
}

MovingHands::MovingHands(Stations& stations, const cases::Case& the_case)
    : thread_([this, &stations, &the_case] {
        using namespace std::chrono_literals;
        const attempt::RestingTransducer probe(*the_case.patient, the_case.plan.line_P);
        const auto start = std::chrono::steady_clock::now();
        while (!is_done_) {
          const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
          for (Station& station : stations)
            station.client.set_hand(station.tool == "needle" ? needle_hand(the_case.plan.line_P, now_s)
                                                             : probe.at(now_s));
          std::this_thread::sleep_for(5ms);
        }
      }) {}

MovingHands::~MovingHands() {
  is_done_ = true;
  thread_.join();
}

double draw_slices(const volume::CtGrid& ct, const Vec3& tip_P, const Vec3& axis_P) {
  const Vec3 across = axis_P.unitOrthogonal();
  const std::array<std::pair<Vec3, Vec3>, 3> planes{
      std::pair<Vec3, Vec3>{axis_P, across}, {axis_P, axis_P.cross(across)}, {across, axis_P.cross(across)}};
  double sum = 0.0;
  constexpr double kStep_mm = kSlice_mm / kSlicePixels;
  for (const auto& [a, b] : planes) {
    for (int row = 0; row < kSlicePixels; ++row) {
      const Vec3 start = tip_P + (row - kSlicePixels / 2) * kStep_mm * a - 0.5 * kSlice_mm * b;
      for (int column = 0; column < kSlicePixels; ++column)
        sum += volume::sample_linear(ct, Vec3(start + column * kStep_mm * b));
    }
  }
  return sum;
}

}  // namespace trocar::bench
