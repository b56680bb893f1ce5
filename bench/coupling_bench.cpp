// How far the coupling of every device is from its limits of stability: spring and damping varied in turn
// (docs/validation.md, Stability).

#include <fmt/format.h>

#include <array>
#include <atomic>

#include "bench/benchmarks.h"
#include "bench/flat_scene.h"
#include "core/files/data_dir.h"
#include "core/parallel.h"
#include "haptics/closed_loop/stability_trial.h"

namespace trocar::bench {
namespace {

constexpr std::array kSprings{0.125, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0};  // N/mm
constexpr std::array kDampings_ms{1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0};            // b_c as a time: b_c/k_c
constexpr double kSurface_mm = 30.0;
constexpr double kSeconds = 20.0;

/// Tissue and depth of a run: pressed on a wall, on bone, deep in tissue that holds the needle well or hardly.
struct Place {
  std::string_view tissue;
  double depth_mm;
};
constexpr std::array kPlaces{Place{"liver", kSurface_mm + 0.5}, Place{"bone", kSurface_mm + 2.0},
                             Place{"muscle", kSurface_mm + 30.0}, Place{"fluid", kSurface_mm + 30.0}};
constexpr std::array kModels{haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy,
                             haptics::ForceModel::kCombined};
constexpr std::array kHolders{haptics::Holder::kHand, haptics::Holder::kBare45g, haptics::Holder::kBare150g};

using Patients = std::array<std::shared_ptr<const anatomy::VirtualPatient>, kPlaces.size()>;

/// True if every run of a device with this coupling is stable.
Result<bool> is_stable(const haptics::DevicePreset& device, const Patients& patients,
                       const anatomy::TissueTable& table) {
  haptics::HapticOptions haptic;
  haptics::apply_device_preset(device, haptic);
  std::vector<std::shared_ptr<const haptics::HapticScene>> scenes;
  for (const haptics::ForceModel model : kModels) {
    haptic.force_model = model;
    for (const auto& patient : patients) {
      TROCAR_TRY(const auto scene, haptics::make_haptic_scene(patient, table, {}, device.capability, haptic));
      scenes.push_back(scene);
    }
  }
  std::atomic<bool> holds{true};
  parallel_for(scenes.size() * kHolders.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last && holds; ++i) {
      const std::size_t scene = i / kHolders.size();
      haptics::StabilityTrial trial;
      trial.depth_mm = kPlaces[scene % kPlaces.size()].depth_mm;
      trial.seconds = kSeconds;
      if (!haptics::run_stability_trial(scenes[scene], device, kHolders[i % kHolders.size()], trial).is_stable())
        holds = false;
    }
  });
  return holds.load();
}

haptics::DevicePreset with_coupling(haptics::DevicePreset device, double k_n_per_mm, double damping_ms) {
  device.coupling = {k_n_per_mm, 1e-3 * damping_ms * k_n_per_mm};
  return device;
}

/// The values on both sides of the chosen one up to which all runs are stable.
struct Range {
  double low = 0.0, high = 0.0;
};
template <class IsStable>
Result<Range> stable_range(std::span<const double> values, double chosen, const IsStable& holds) {
  Range range{chosen, chosen};
  for (const double value : values) {
    if (value <= chosen) continue;
    TROCAR_TRY(const bool is_fine, holds(value));
    if (!is_fine) break;
    range.high = value;
  }
  for (auto value = values.rbegin(); value != values.rend(); ++value) {
    if (*value >= chosen) continue;
    TROCAR_TRY(const bool is_fine, holds(*value));
    if (!is_fine) break;
    range.low = *value;
  }
  return range;
}

Status add_device(std::vector<CaseResult>& results, const haptics::DevicePreset& device, const Patients& patients,
                  const anatomy::TissueTable& table) {
  const double k = device.coupling.stiffness_n_per_mm;
  const double damping_ms = 1e3 * device.coupling.damping_ns_per_mm / k;
  TROCAR_TRY(const bool is_chosen_stable, is_stable(device, patients, table));
  std::vector<double> springs;
  for (const double value : kSprings)
    if (value <= device.capability.max_stiffness_n_per_mm) springs.push_back(value);
  TROCAR_TRY(const Range spring, stable_range(springs, k, [&](double value) {
               return is_stable(with_coupling(device, value, damping_ms), patients, table);
             }));
  TROCAR_TRY(const Range damping, stable_range(kDampings_ms, damping_ms, [&](double value) {
               return is_stable(with_coupling(device, k, value), patients, table);
             }));
  const std::string name = "coupling/" + device.name;
  results.push_back({name + "/spring",
                     "n_per_mm",
                     figure_of(k),
                     {},
                     fmt::format("{}; stable from {:.3f} to {:.3f} N/mm, the device's limit is {:.1f}",
                                 is_chosen_stable ? "stable" : "NOT STABLE", spring.low, spring.high,
                                 device.capability.max_stiffness_n_per_mm)});
  results.push_back({name + "/damping",
                     "ms",
                     figure_of(damping_ms),
                     {},
                     fmt::format("as a time; stable from {:.1f} to {:.1f} ms", damping.low, damping.high)});
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_coupling_benchmark(const Options& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const anatomy::TissueTable table, anatomy::load_tissue_table(data / "tissues.toml"));
  TROCAR_TRY(auto devices, haptics::load_device_presets(data / "devices.toml"));
  std::erase_if(devices, [](const haptics::DevicePreset& device) { return !device.has_force(); });
  Patients patients;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    TROCAR_TRY(patients[i], make_flat_patient({{0.0, "adipose"}, {kSurface_mm, std::string(kPlaces[i].tissue)}}));
  }
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    report(options.progress, "varying couplings", static_cast<double>(i) / static_cast<double>(devices.size()));
    TROCAR_TRY_STATUS(add_device(results, devices[i], patients, table));
  }
  return results;
}

}  // namespace trocar::bench
