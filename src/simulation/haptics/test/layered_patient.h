#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "haptics/tick.h"

namespace trocar::testing {

/// Transfer functions for tests: air, fat, muscle, bone.
inline anatomy::HuTransfer test_transfer() {
  anatomy::HuTransfer transfer;
  transfer.knot_count = 5;
  transfer.hu = {-200, -100, 50, 250, 500};
  //                  K    T_N   T_T   R0    c      shaft   nu     E
  transfer.laws = {{{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                    {1.0, 0.2, 0.05, 0.05, 0.002, 0.002, 0.01, 10.0},
                    {2.0, 2.5, 0.2, 0.2, 0.005, 0.004, 0.03, 30.0},
                    {5.0, 5.0, 0.5, 0.5, 0.005, 0.01, 0.03, 100.0},
                    {20.0, 100.0, 5.0, 20.0, 0.01, 0.05, 0.05, 1e6}}};
  return transfer;
}

/// Paper A, Table 1, and puncture and cutting forces of references.md (skin 2.8 N, muscle 2.5 N, capsule 1.5 N).
inline anatomy::TissueTable paper_tissues() {
  anatomy::TissueTable table;
  table.layers = {{"skin", 0.46, 0.02, 0.1, 2.8},
                  {"muscle", 0.19, 0.03, 0.11, 2.5},
                  {"liver_capsule", 0.42, 0.02, 0.12, 1.5},
                  {"bone", 20.0, 0.0, 0.1}};
  const auto tissue = [](const char* name, double nu, double mu, double delta, double stick, double cutting,
                         std::optional<std::uint8_t> layer) {
    return anatomy::TissueParams{name, nu, mu, delta, stick, cutting, layer};
  };
  table.tissues = {tissue("air", 0, 0, 0, 0, 0, {}),
                   tissue("skin", 0.02, 0.18, 0.1, 0.004, 0, 0),
                   tissue("adipose", 0.01, 0.1, 0.1, 0.002, 0, {}),
                   tissue("muscle", 0.03, 0.15, 0.1, 0.004, 0, 1),
                   tissue("liver", 0.02, 0.58, 0.1, 0.004, 0.6, 2),
                   tissue("bone", 0.0, 0.3, 0.1, 0.0, 0, 3),
                   tissue("soft_tissue", 0.01, 0.1, 0.1, 0.002, 0, {})};
  table.skin = 1;
  table.transfer = test_transfer();
  for (anatomy::LayerParams& layer : table.layers) layer.is_wall = layer.name != "muscle";
  return table;
}

/// The same with paper A's path constraint.
inline anatomy::TissueTable constrained_tissues() {
  anatomy::TissueTable table = paper_tissues();
  table.path_constraint.is_given = true;
  return table;
}

/// The device's force against a needle that goes along -z, without that for its own weight.
inline double resistance_n(const telemetry::TickSample& sample) {
  return -(sample.device_f_n - sample.f_weight_n).z();
}

/// A slab of tissue that begins at this depth (mm) below the skin.
struct Slab {
  double from_mm;
  std::uint8_t label;
};
inline constexpr std::uint8_t kFat = 1, kMuscle = 2, kLiver = 3, kBone = 4;
inline constexpr std::array<std::int16_t, 5> kHuOfLabel{0, -100, 50, 60, 800};

/// Typical layers above the liver: fat from 0, muscle from 12, liver from 24 mm.
inline std::vector<Slab> liver_way() {
  return {{0, kFat}, {12, kMuscle}, {24, kLiver}};
}

/// A flat layered patient, 1 mm voxels: skin at z = 0, inside at z > 0; slabs by depth.
inline std::shared_ptr<anatomy::VirtualPatient> layered_patient(const std::vector<Slab>& slabs) {
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->name = "layers";
  volume::GridGeometry geometry;
  geometry.size = {41, 41, 121};
  geometry.origin_P = {-20.0, -20.0, -20.0};
  patient->ct = volume::CtGrid(geometry, 0);
  patient->labels = volume::LabelGrid(geometry, 0);
  patient->skin_distance_mm = volume::FloatGrid(geometry, 0.0F);
  for (std::size_t n = 0; n < patient->labels.voxels.size(); ++n) {
    const double z = static_cast<double>(geometry.index_of(n)[2]) - 20.0;
    patient->skin_distance_mm.voxels[n] = static_cast<float>(-z);
    for (const Slab& slab : slabs) {
      if (z >= slab.from_mm && z >= 0.0) patient->labels.voxels[n] = slab.label;
    }
    patient->ct.voxels[n] = z < 0.0 ? std::int16_t{-1000} : kHuOfLabel[patient->labels.voxels[n]];
  }
  patient->label_table.labels = {
      {kFat, "fat", "adipose"}, {kMuscle, "muscle", "muscle"}, {kLiver, "liver", "liver"}, {kBone, "rib", "bone"}};
  return patient;
}

inline std::shared_ptr<const haptics::HapticScene> make_scene(const std::vector<Slab>& slabs,
                                                              const haptics::HapticOptions& options = {},
                                                              const anatomy::TissueTable& tissues = paper_tissues()) {
  auto scene = haptics::make_haptic_scene(layered_patient(slabs), tissues, {}, {}, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

inline std::shared_ptr<const haptics::HapticScene> make_scene(const std::vector<Slab>& slabs, haptics::ForceModel model,
                                                              const anatomy::TissueTable& tissues = paper_tissues()) {
  haptics::HapticOptions options;
  options.force_model = model;
  return make_scene(slabs, options, tissues);
}

/// The same patient without labels: the CT determines all tissue but the skin.
inline std::shared_ptr<const haptics::HapticScene> make_unlabelled_scene(
    const std::vector<Slab>& slabs, haptics::ForceModel model, const anatomy::TissueTable& tissues = paper_tissues()) {
  auto patient = layered_patient(slabs);
  patient->labels = volume::LabelGrid(patient->ct.geometry, 0);
  haptics::HapticOptions options;
  options.force_model = model;
  auto scene = haptics::make_haptic_scene(std::move(patient), tissues, {}, {}, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

/// Drives the device's needle tip through the scene, tick by tick.
class Driver {
 public:
  explicit Driver(std::shared_ptr<const haptics::HapticScene> scene, double rate_hz = 1000.0)
      : scene_(std::move(scene)), dt_s_(1.0 / rate_hz) {}

  telemetry::TickSample to(const Vec3& tip_P, const Vec3& axis_P = Vec3::UnitZ()) {
    time_s_ += dt_s_;
    depth_mm_ = tip_P.z();
    return haptics::tick(state_, {time_s_, dt_s_, telemetry::to_tool_pose(needle_pose(tip_P, axis_P))}, *scene_).sample;
  }
  /// Moves straight down (or up) to a depth at constant speed; returns all samples.
  std::vector<telemetry::TickSample> move(double to_depth_mm, double speed_mm_per_s) {
    std::vector<telemetry::TickSample> samples;
    const double step = speed_mm_per_s * dt_s_ * (to_depth_mm > depth_mm_ ? 1.0 : -1.0);
    const double start = depth_mm_;
    const auto count = static_cast<int>(std::abs((to_depth_mm - start) / step));
    for (int i = 1; i <= count; ++i) samples.push_back(to({0.0, 0.0, start + step * i}));
    return samples;
  }
  /// Moves the tip there at once.
  void jump_to(double depth_mm) { to({0.0, 0.0, depth_mm}); }
  std::vector<telemetry::TickSample> hold(double seconds) {
    std::vector<telemetry::TickSample> samples;
    for (double t = 0.0; t < seconds; t += dt_s_) samples.push_back(to({0.0, 0.0, depth_mm_}));
    return samples;
  }
  haptics::HapticState& state() { return state_; }

 private:
  std::shared_ptr<const haptics::HapticScene> scene_;
  haptics::HapticState state_;
  double dt_s_;
  double time_s_ = 0.0;
  double depth_mm_ = -10.0;
};

/// Punctured layers, in order.
inline std::vector<int> punctures(const std::vector<telemetry::TickSample>& samples) {
  std::vector<int> layers;
  for (const telemetry::TickSample& sample : samples) {
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind == telemetry::EventKind::kPuncture) layers.push_back(event.id);
    }
  }
  return layers;
}

/// Punctured layers and entered labels, in order.
inline std::vector<std::pair<telemetry::EventKind, int>> ways_in(const std::vector<telemetry::TickSample>& samples) {
  std::vector<std::pair<telemetry::EventKind, int>> ways;
  for (const telemetry::TickSample& sample : samples) {
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind == telemetry::EventKind::kPuncture || event.kind == telemetry::EventKind::kEnter)
        ways.emplace_back(event.kind, event.id);
    }
  }
  return ways;
}

inline std::vector<telemetry::TickSample> joined(std::vector<telemetry::TickSample> a,
                                                 const std::vector<telemetry::TickSample>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace trocar::testing
