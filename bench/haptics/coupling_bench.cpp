// How far the coupling of every device is from its limits of stability: spring and damping varied together by the
// stated margin, and in turn until runs are no longer stable (docs/validation.md, Stability).

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <atomic>
#include <functional>

#include "bench/benchmarks.h"
#include "bench/haptics/flat_scene.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "haptics/option_texts.h"
#include "lab/haptics/stability_trial.h"

namespace trocar::bench {
namespace {

/// Every coupling within this factor of a device's k_c and b_c must be stable, up to the device's limit.
constexpr double kMargin = 1.25;
constexpr std::array kFactors{1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0};  // of the values varied in turn
constexpr double kCouplingSurface_mm = 30.0;
constexpr double kSeconds = 20.0;

/// Tissue and depth of a run: pressed on a wall, on bone, deep in tissue that holds the needle well or hardly.
struct PressedPlace {
  std::string_view tissue;
  double depth_mm;
};
constexpr std::array kPlaces{
    PressedPlace{"liver", kCouplingSurface_mm + 0.5}, PressedPlace{"bone", kCouplingSurface_mm + 2.0},
    PressedPlace{"muscle", kCouplingSurface_mm + 30.0}, PressedPlace{"fluid", kCouplingSurface_mm + 30.0}};
constexpr std::array kHolders{haptics::Holder::kHand, haptics::Holder::kBare45g, haptics::Holder::kBare150g};

using Patients = std::array<std::shared_ptr<const anatomy::VirtualPatient>, kPlaces.size()>;

/// True if every run of a device with this coupling is stable.
Result<bool> is_stable(const stylus::DevicePreset& device, const Patients& patients,
                       const anatomy::TissueTable& table) {
  haptics::HapticOptions haptic;
  haptics::apply_device_preset(device, haptic);
  std::vector<std::shared_ptr<const haptics::HapticScene>> scenes;
  for (const haptics::ForceModel model : kForceModels) {
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

stylus::DevicePreset with_coupling(stylus::DevicePreset device, double k_n_per_mm, double damping_ms) {
  device.coupling = {k_n_per_mm, 1e-3 * damping_ms * k_n_per_mm};
  return device;
}

using IsStable = std::function<Result<bool>(double factor)>;

/// The factors below and above 1 up to which all runs are stable.
struct Range {
  double low = 1.0, high = 1.0;
};
Result<Range> stable_range(const IsStable& holds) {
  Range range;
  for (const double factor : kFactors) {
    TROCAR_TRY(const bool is_fine, holds(factor));
    if (!is_fine) break;
    range.high = factor;
  }
  for (const double factor : kFactors) {
    TROCAR_TRY(const bool is_fine, holds(1.0 / factor));
    if (!is_fine) break;
    range.low = 1.0 / factor;
  }
  return range;
}

/// k_c and b_c both as chosen, or by kMargin more or less: the couplings that are not stable.
Result<std::vector<std::string>> unstable_in_margin(const stylus::DevicePreset& device, double damping_ms,
                                                    const Patients& patients, const anatomy::TissueTable& table) {
  const double k = device.coupling.stiffness_n_per_mm;
  std::vector<std::string> unstable;
  for (const double spring : {1.0 / kMargin, 1.0, kMargin}) {
    for (const double damping : {1.0 / kMargin, 1.0, kMargin}) {
      const double k_here = std::min(spring * k, device.capability.max_stiffness_n_per_mm);
      const double ms = damping * damping_ms;
      TROCAR_TRY(const bool is_fine, is_stable(with_coupling(device, k_here, ms), patients, table));
      if (!is_fine) unstable.push_back(fmt::format("{:.3f} N/mm with {:.2f} ms", k_here, ms));
    }
  }
  return unstable;
}

Status add_device(std::vector<CaseResult>& results, const stylus::DevicePreset& device, const Patients& patients,
                  const anatomy::TissueTable& table) {
  const double k = device.coupling.stiffness_n_per_mm;
  const double damping_ms = 1e3 * device.coupling.damping_ns_per_mm / k;
  const double most_n_per_mm = device.capability.max_stiffness_n_per_mm;
  TROCAR_TRY(const auto unstable, unstable_in_margin(device, damping_ms, patients, table));
  TROCAR_TRY(const Range spring, stable_range([&](double factor) -> Result<bool> {
               if (factor * k > most_n_per_mm) return false;
               return is_stable(with_coupling(device, factor * k, damping_ms), patients, table);
             }));
  TROCAR_TRY(const Range damping, stable_range([&](double factor) {
               return is_stable(with_coupling(device, k, factor * damping_ms), patients, table);
             }));
  const std::string name = "coupling/" + device.name;
  const std::string margin = fmt::format("both within a factor of {}", kMargin);
  results.push_back({name + "/margin",
                     "unstable",
                     figure_of(static_cast<double>(unstable.size())),
                     {},
                     unstable.empty() ? "of 9 couplings, " + margin
                                      : fmt::format("of 9 couplings, {}: {}", margin, fmt::join(unstable, ", "))});
  results.push_back({name + "/spring",
                     "n_per_mm",
                     figure_of(k),
                     {},
                     fmt::format("alone stable from {:.3f} to {:.3f}; the device's limit is {:.1f}", spring.low * k,
                                 spring.high * k, most_n_per_mm),
                     {{"low", spring.low * k}, {"high", spring.high * k}, {"limit", most_n_per_mm}}});
  results.push_back({name + "/damping",
                     "ms",
                     figure_of(damping_ms),
                     {},
                     fmt::format("as the time b_c/k_c, alone stable from {:.1f} to {:.1f}", damping.low * damping_ms,
                                 damping.high * damping_ms),
                     {{"low", damping.low * damping_ms}, {"high", damping.high * damping_ms}}});
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_coupling_benchmark(const Options& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const anatomy::TissueTable table, anatomy::load_tissue_table(data / "tissues.toml"));
  TROCAR_TRY(auto devices, stylus::load_device_presets(data / "devices.toml"));
  std::erase_if(devices, [](const stylus::DevicePreset& device) { return !device.has_force(); });
  Patients patients;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    TROCAR_TRY(patients[i],
               make_flat_patient({{0.0, "adipose"}, {kCouplingSurface_mm, std::string(kPlaces[i].tissue)}}));
  }
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    core::report(options.progress, "varying couplings", static_cast<double>(i) / static_cast<double>(devices.size()));
    TROCAR_TRY_STATUS(add_device(results, devices[i], patients, table));
  }
  return results;
}

}  // namespace trocar::bench
