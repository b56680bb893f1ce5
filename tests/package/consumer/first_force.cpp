// Pushes a needle against the skin of an embedded patient and prints the force on it; then turns a failed check of a
// library into an exception: first_force DATA_FOLDER
#include <cstdio>
#include <stdexcept>

#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"
#include "haptics/haptic_scene.h"
#include "haptics/tick.h"
#include "phantom/phantom.h"
#include "volume/resample.h"

namespace {

using namespace trocar;

Result<double> largest_force_n(const char* data_folder) {
  TROCAR_TRY(anatomy::VirtualPatient made, phantom::generate_phantom("abdomen", 1, {{96, 80, 80}}));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(made));
  TROCAR_TRY(const anatomy::TissueTable tissues,
             anatomy::load_tissue_table(std::filesystem::path(data_folder) / "tissues.toml"));
  TROCAR_TRY(const auto scene, haptics::make_haptic_scene(patient, tissues, {}));

  const volume::GridGeometry& geometry = patient->labels.geometry;
  const Vec3 middle_P = geometry.to_mm({0.5 * geometry.size[0], 0.5 * geometry.size[1], 0.5 * geometry.size[2]});
  constexpr double kStep_mm = 0.01;
  haptics::HapticState state;
  double most_n = 0.0;
  for (int tick = 0; tick < 30000; ++tick) {  // from 200 mm in front of the body's middle, to the back
    const Vec3 tip_P = middle_P + Vec3(0.0, -200.0 + kStep_mm * tick, 0.0);
    const auto tool = telemetry::to_tool_pose(needle_pose(tip_P, Vec3::UnitY()));
    const auto output = haptics::tick(state, {0.001 * tick, 0.001, tool}, *scene);
    most_n = std::max(most_n, output.sample.f_total_n.norm());
    if (most_n > 0.5) break;
  }
  return most_n;
}

bool has_thrown_for_failed_check() {
  set_check_handler([](const char* text) { throw std::invalid_argument(text); });
  try {
    volume::isotropic_geometry({{2, 2, 2}, {1.0, 1.0, 1.0}}, -1.0);
  } catch (const std::invalid_argument& error) {
    std::printf("caught: %s\n", error.what());
    return true;
  }
  return false;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const Result<double> force = largest_force_n(arguments[1]);
  if (!force) {
    std::fprintf(stderr, "error: %s\n", force.error().text().c_str());
    return 1;
  }
  std::printf("the skin holds the needle back with %.2f N\n", *force);
  return *force > 0.5 && has_thrown_for_failed_check() ? 0 : 1;
}
