#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/testing/source_dir.h"
#include "haptics/test/layered_patient.h"
#include "server/scene_builder.h"
#include "server/servo.h"

namespace trocar::testing {

inline std::filesystem::path data_file(const char* name) {
  return testing::source_dir() / "data" / name;
}
inline stylus::DevicePreset device_preset(const char* name = "premium") {
  auto preset = stylus::load_device_preset(data_file("devices.toml"), name);
  TROCAR_CHECK(preset.has_value());
  return *preset;
}

/// The shipped tissues on a firm wall: a small indentation of the skin gives a force.
inline std::string firm_tissues() {
  anatomy::TissueTable table = anatomy::load_tissue_table(data_file("tissues.toml")).value();
  for (anatomy::LayerParams& layer : table.layers) layer.load_spread_mm = 0.0;
  return table.to_toml();
}
/// A request for the flat layered patient below the room: z of W is up; the tip of a needle that points down from the
/// origin of W is 20 mm below the skin.
inline link::LoadScene layered_request(const std::string& force_model = "insertion") {
  static const std::string tissues = firm_tissues();
  link::LoadScene request;
  request.tissues_toml = tissues;
  request.patient = "layers";
  request.force_model = force_model;
  Mat3 R_PW;
  R_PW.col(0) = Vec3::UnitX();
  R_PW.col(1) = -Vec3::UnitY();
  R_PW.col(2) = -Vec3::UnitZ();
  request.X_PW = Pose(R_PW, {0.0, 0.0, 20.0 - request.needle_length_mm});
  return request;
}
inline server::PatientOpener layered_opener() {
  return [](const std::string& name, std::uint64_t,
            const Progress&) -> Result<std::shared_ptr<const anatomy::VirtualPatient>> {
    if (name != "layers") return fail("there is no such patient", name);
    return layered_patient(liver_way());
  };
}
/// Pose of a needle that points down into the layered patient, with the tip at this depth below the skin (mm).
inline Pose needle_at_depth(double depth_mm) {
  return {rotation_between(Vec3::UnitZ(), -Vec3::UnitZ()), {0.0, 0.0, 20.0 - depth_mm}};
}

/// A device with a pose set by the test; it records the last written wrench.
class ScriptedDevice final : public devices::HapticDevice {
 public:
  explicit ScriptedDevice(stylus::DevicePreset preset) : preset_(std::move(preset)) {}
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "scripted"; }
  devices::DeviceReading read(double) noexcept override { return reading; }
  bool write(const Wrench& wrench_D) noexcept override {
    written = wrench_D;
    return takes_writes;
  }
  Status reconnect() override { return {}; }

  devices::DeviceReading reading;
  Wrench written;
  bool takes_writes = true;

 private:
  stylus::DevicePreset preset_;
};

/// A servo with a scripted device over the layered patient, driven in simulated time.
class ServoRig {
 public:
  explicit ServoRig(const char* device_name = "premium", const std::string& force_model = "insertion")
      : preset(device_preset(device_name)),
        device(preset),
        builder(layered_opener(), data_file("tissues.toml"), preset),
        servo(device, server::servo_params(preset)) {
    auto made = builder.load(layered_request(force_model));
    TROCAR_CHECK(made.has_value());
    scene = *made;
    input.scene = &scene;
    input.is_wanted = true;
    device.reading.X_DS = needle_at_depth(depth);
  }
  server::ServoRecord step() {
    input.now_s += input.dt_s;
    const server::ServoRecord record = servo.step(input);
    const double written_n = device.written.force_n.norm();
    most_n = std::max(most_n, written_n);
    largest_rise_n = std::max(largest_rise_n, written_n - last_n);
    last_n = written_n;
    input.hand.reset();
    input.is_reset = false;
    return record;
  }
  /// Moves the tip to a depth at a speed. Returns all records.
  std::vector<server::ServoRecord> move_to(double depth_mm, double speed_mm_per_s) {
    std::vector<server::ServoRecord> records;
    const double step_mm = speed_mm_per_s * input.dt_s;
    while (depth != depth_mm) {
      depth = depth_mm > depth ? std::min(depth_mm, depth + step_mm) : std::max(depth_mm, depth - step_mm);
      device.reading.X_DS = needle_at_depth(depth);
      records.push_back(step());
    }
    return records;
  }
  /// Holds the tip with a small tremor like that of a hand, so that no stuck encoder is detected. Returns all records.
  std::vector<server::ServoRecord> hold(double seconds) {
    std::vector<server::ServoRecord> records;
    const auto count = static_cast<int>(seconds / input.dt_s + 0.5);
    for (int i = 0; i < count; ++i) {
      device.reading.X_DS = needle_at_depth(depth + 0.02 * ((i / 20) % 2));
      records.push_back(step());
    }
    return records;
  }
  /// Runs until the safe start is over and forces are on, outside the body.
  void start() { hold(2.0); }

  stylus::DevicePreset preset;
  ScriptedDevice device;
  server::SceneBuilder builder;
  server::ServoScene scene;
  server::Servo servo;
  server::ServoInput input;
  double depth = -10.0;
  double most_n = 0.0, largest_rise_n = 0.0, last_n = 0.0;
};

inline bool has_event(const std::vector<server::ServoRecord>& records, telemetry::EventKind kind, int id = -1) {
  return std::any_of(records.begin(), records.end(), [&](const server::ServoRecord& record) {
    return std::any_of(
        record.sample.events.begin(), record.sample.events.end(),
        [&](const telemetry::TickEvent& event) { return event.kind == kind && (id < 0 || event.id == id); });
  });
}
inline bool has_limit(const std::vector<server::ServoRecord>& records, telemetry::LimitReason reason) {
  return has_event(records, telemetry::EventKind::kLimit, static_cast<int>(reason));
}

}  // namespace trocar::testing
