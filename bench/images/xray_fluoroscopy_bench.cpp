#include "bench/images/xray_fluoroscopy_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "xray/fluoroscopy/fluoroscope.h"

namespace trocar::bench {
namespace {

constexpr int kFluoroscopyWarmUp = 5, kStillRounds = 100, kMovingRounds = 40;

/// A trunk of water with a spine and ribs of bone, 256³ voxels of 1.4 mm.
volume::CtGrid make_trunk() {
  volume::GridGeometry geometry;
  geometry.size = {256, 256, 256};
  geometry.spacing_mm = Vec3::Constant(1.4);
  geometry.origin_P = Vec3::Constant(-0.5 * 1.4 * 255);
  volume::CtGrid ct(geometry, -1000);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
    const double body = std::hypot(p_P.x() / 150.0, p_P.y() / 100.0);
    if (body < 1.0) ct.voxels[n] = 40;
    if (std::hypot(p_P.x(), p_P.y() - 55.0) < 18.0) ct.voxels[n] = 500;
    const bool is_rib = std::fmod(p_P.z() + 0.3 * p_P.y() + 1000.0, 28.0) < 9.0;
    if (is_rib && body > 0.90 && body < 0.96) ct.voxels[n] = 700;
  }
  return ct;
}

/// A needle, a guide wire in 60 pieces and a filled tree of 200 pieces that change with the frame.
void set_frame(int frame, xray::FluoroscopyRequest& request) {
  request.time_s = frame / request.pulses_per_s;
  const double depth_mm = 40.0 * std::sin(0.05 * frame);
  xray::ToolShape needle;
  needle.line_P = {{-140, 10, 30}, {-60 + depth_mm, 5, 10}};
  needle.outer_radius_mm = 0.6;
  needle.inner_radius_mm = 0.45;
  xray::ToolShape wire;
  wire.outer_radius_mm = 0.45;
  for (int n = 0; n <= 60; ++n)
    wire.line_P.emplace_back(-60 + depth_mm + 1.5 * n, 5 + 0.3 * n, 10 + 12.0 * std::sin(0.12 * n));
  request.tools = {needle, wire};
  auto iodine = std::make_shared<xray::Iodine>();
  for (int branch = 0; branch < 10; ++branch)
    for (int n = 0; n < 20; ++n) {
      const auto place = [&](int k) {
        return Vec3(-30 + 3.0 * k, 4.0 * std::sin(0.3 * k + branch), -40 + 8.0 * branch + 0.8 * k);
      };
      const double radius = 2.5 - 0.1 * n;
      iodine->pieces.push_back({place(n), place(n + 1), radius, radius - 0.1, 100.0 + frame % 50});
    }
  request.iodine = iodine;
}

CaseResult make_case(std::string name, const Figures& figures, std::string note) {
  return {std::move(name), "ms", figures, std::nullopt,
          fmt::format("{:.0f} frames per s at the median; {}", 1e3 / figures.median.value_or(1.0), note)};
}

}  // namespace

Result<std::vector<CaseResult>> fluoroscopy_cases() {
  TROCAR_TRY(const auto volume, xray::XrayVolume::from_ct(make_trunk()));
  xray::FluoroscopyRequest request;
  request.is_pedal_down = true;
  request.pulses_per_s = 30.0;
  std::optional<Error> error;
  xray::Fluoroscope fluoroscope(volume);
  int frame = 0;
  const auto render = [&] {
    set_frame(frame, request);
    const auto made = fluoroscope.frame(request, static_cast<std::uint64_t>(frame));
    ++frame;
    if (!made) error = made.error();
  };
  std::vector<CaseResult> results;
  results.push_back(make_case("fluoroscopy/512-static", time_ms(kFluoroscopyWarmUp, kStillRounds, render),
                              "256^3 CT, static C-arm, needle, wire of 60 and tree of 200 pieces change, all cores"));
  results.push_back(make_case("fluoroscopy/512-moving",
                              time_ms(kFluoroscopyWarmUp, kMovingRounds,
                                      [&] {
                                        request.arm.lao_deg = 30.0 * std::sin(0.05 * frame);
                                        render();
                                      }),
                              "the same with a C-arm that turns at each frame"));
  if (error) return tl::unexpected(*error);
  return results;
}

}  // namespace trocar::bench
