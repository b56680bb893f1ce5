// Every tissue, force model, device and holder in closed loop: does the needle come to rest, and is the haptic side
// passive? docs/validation.md, Stability.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "bench/benchmarks.h"
#include "bench/haptics/flat_scene.h"
#include "core/files/folders.h"
#include "core/parallel.h"
#include "haptics/option_texts.h"
#include "lab/haptics/stability_trial.h"

namespace trocar::bench {
namespace {

constexpr double kSurface_mm = 30.0;  // adipose tissue above it, under the skin, which gives way for up to 25 mm
constexpr double kDeep_mm = 60.0;
constexpr double kAtWall_mm = 0.5;  // position below the wall's resting surface: no wall is punctured
constexpr double kIntoBone_mm = 2.0;

struct Trial {
  std::shared_ptr<const haptics::HapticScene> scene;
  const stylus::DevicePreset* device;
  haptics::ForceModel model;
  haptics::Holder holder;
  std::string tissue;
  bool is_at_wall;
  double depth_mm;
  haptics::StabilityOutcome outcome;
};

/// Position at release: deep in the tissue, and at its wall if it has one.
std::vector<std::pair<bool, double>> depths(const anatomy::TissueTable& table, const anatomy::TissueParams& tissue) {
  const double surface_mm = tissue.name == "skin" ? 0.0 : kSurface_mm;
  const bool has_wall = tissue.layer.has_value();
  const bool is_closed = has_wall && !std::isfinite(table.layers[*tissue.layer].puncture_force_n);
  std::vector<std::pair<bool, double>> depths{{false, is_closed ? surface_mm + kIntoBone_mm : kDeep_mm}};
  if (has_wall) depths.emplace_back(true, surface_mm + kAtWall_mm);
  return depths;
}

Result<std::vector<Trial>> plan_trials(const anatomy::TissueTable& table,
                                       const std::vector<stylus::DevicePreset>& devices, const Options& options) {
  std::vector<Trial> trials;
  for (std::size_t i = 1; i < table.tissues.size(); ++i) {  // 0 is air
    const anatomy::TissueParams& tissue = table.tissues[i];
    TROCAR_TRY(const auto patient, make_flat_patient({{0.0, "adipose"}, {kSurface_mm, tissue.name}}));
    for (const haptics::ForceModel model : kForceModels) {
      if (options.force_model && *options.force_model != model) continue;
      for (const stylus::DevicePreset& device : devices) {
        haptics::HapticOptions haptic;
        haptic.force_model = model;
        haptic.seed = options.seed;
        haptics::apply_device_preset(device, haptic);
        TROCAR_TRY(const auto scene, haptics::make_haptic_scene(patient, table, {}, device.capability, haptic));
        for (const haptics::Holder holder : haptics::kAllHolders)
          for (const auto& [is_at_wall, depth] : depths(table, tissue))
            trials.push_back({scene, &device, model, holder, tissue.name, is_at_wall, depth, {}});
      }
    }
  }
  return trials;
}

void run_trials(std::vector<Trial>& trials, const Progress& progress) {
  std::atomic<std::size_t> done{0};
  parallel_for(trials.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      Trial& trial = trials[i];
      trial.outcome = haptics::run_stability_trial(trial.scene, *trial.device, trial.holder, {trial.depth_mm});
      const std::size_t count = ++done;
      if (count % 32 == 0)
        core::report(progress, "releasing needles", static_cast<double>(count) / static_cast<double>(trials.size()));
    }
  });
}

std::string name_of(const Trial& trial) {
  return fmt::format("{}{} held by {}", trial.is_at_wall ? "wall of " : "", trial.tissue, to_string(trial.holder));
}

/// One line per model, device and kind of holder.
void add_results(std::vector<CaseResult>& results, const std::vector<Trial>& trials, haptics::ForceModel model,
                 const stylus::DevicePreset& device) {
  std::vector<const Trial*> group;
  for (const Trial& trial : trials)
    if (trial.model == model && trial.device == &device) group.push_back(&trial);
  if (group.empty()) return;
  const auto worst = [&](auto&& value) {
    return *std::max_element(group.begin(), group.end(),
                             [&](const Trial* a, const Trial* b) { return value(*a) < value(*b); });
  };
  const auto position = [](const Trial& t) { return t.outcome.position_mm; };
  const auto force = [](const Trial& t) { return t.outcome.force_n; };
  const auto growth = [](const Trial& t) { return t.outcome.growth_mj; };
  const auto stable = std::count_if(group.begin(), group.end(), [](const Trial* t) { return t->outcome.is_stable(); });
  const auto resting =
      std::count_if(group.begin(), group.end(), [](const Trial* t) { return t->outcome.is_at_rest(); });
  const std::string prefix = fmt::format("stability/{}/{}", to_string(model), device.name);
  const auto add = [&](const char* what, const char* unit, double value, std::string note) {
    Figures figures;
    figures.median = value;
    results.push_back({prefix + what, unit, figures, {}, std::move(note)});
  };
  add("", "ratio", static_cast<double>(stable) / static_cast<double>(group.size()),
      fmt::format("{} of {} runs are stable, {} come to rest", stable, group.size(), resting));
  results.back().values = {{"stable", static_cast<double>(stable)}, {"runs", static_cast<double>(group.size())}};
  add("/position", "mm", position(*worst(position)),
      fmt::format("worst peak to peak, allowed {:.3f}: {}", group.front()->outcome.allowed_mm,
                  name_of(*worst(position))));
  add("/force", "n", force(*worst(force)),
      fmt::format("worst peak to peak, allowed {:.2f}: {}", haptics::StabilityOutcome::kAllowed_n,
                  name_of(*worst(force))));
  add("/energy", "mj", growth(*worst(growth)),
      fmt::format("worst growth, allowed {:.3f}: {}", group.front()->outcome.allowed_mj, name_of(*worst(growth))));
}

/// The unstable trials, one line each.
void print_failures(const std::vector<Trial>& trials, const Options& options) {
  if (!options.print) return;
  for (const Trial& t : trials) {
    if (t.outcome.is_stable()) continue;
    options.print(fmt::format("not stable: {:<9} {:<8} {:<34} {:8.3f} mm {:7.3f} N {:9.3f} mJ", to_string(t.model),
                              t.device->name, name_of(t), t.outcome.position_mm, t.outcome.force_n,
                              t.outcome.growth_mj));
  }
}

}  // namespace

Result<std::vector<CaseResult>> run_stability_benchmark(const Options& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const anatomy::TissueTable table, anatomy::load_tissue_table(data / "tissues.toml"));
  TROCAR_TRY(auto devices, stylus::load_device_presets(data / "devices.toml"));
  std::erase_if(devices, [](const stylus::DevicePreset& device) { return !device.has_force(); });
  TROCAR_TRY(auto trials, plan_trials(table, devices, options));
  run_trials(trials, options.progress);
  print_failures(trials, options);
  std::vector<CaseResult> results;
  for (const haptics::ForceModel model : kForceModels)
    for (const stylus::DevicePreset& device : devices) add_results(results, trials, model, device);
  return results;
}

}  // namespace trocar::bench
