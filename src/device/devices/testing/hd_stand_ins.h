#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/files/folders.h"
#include "geometry/vec.h"

namespace trocar::testing {

/// Environment variable: folder with one file per device, named after the device.
inline constexpr const char* kHdVariable = "TROCAR_STANDIN_HD";

/// State of an OpenHaptics device, in memory shared by a test and the program that has opened the device. The hand that
/// holds the device gives way to no force.
struct HdControls {
  std::array<char, 64> model{};
  int output_dof = 3;
  double force_n = 3.3, continuous_n = 0.88, stiffness_n_per_mm = 0.5;
  int calibration_style = 0;
  std::atomic<std::uint32_t> calibration{0};
  std::atomic<int> is_present{1};
  std::atomic<int> is_in_reset_position{0};
  std::atomic<int> buttons{0};
  std::array<std::atomic<double>, 9> R{};     ///< Row-major, in the vendor's axes.
  std::array<std::atomic<double>, 3> p_mm{};  ///< In the vendor's axes.
  std::atomic<double> tremor_mm{0.0};         ///< Amplitude of the hand's tremor along the vendor's y; 0: a vice.
  std::atomic<double> strongest_n{0.0};       ///< Largest force of the motors since the beginning.
  std::atomic<int> openings{0};               ///< Number of times that it was opened.
};

/// OpenHaptics devices for programs that are started during the lifetime of this object. The environment makes them
/// open the stand-in library and find the configuration that the vendor's setup program would have written.
class HdStandIns {
 public:
  HdStandIns();
  ~HdStandIns();
  HdStandIns(const HdStandIns&) = delete;
  HdStandIns& operator=(const HdStandIns&) = delete;

  /// Add a connected and calibrated device, held in the middle of its workspace, with the tip away from the user.
  HdControls& add_omni(const std::string& name);
  HdControls& add_premium(const std::string& name);

 private:
  HdControls& add(const std::string& name, const char* model);

  TemporaryFolder folder_;
  std::vector<HdControls*> devices_;
};

/// Sets HdControls::p_mm, in the vendor's axes.
void place(HdControls& device, const Vec3& p_mm);
/// Moves the device to `p_mm` at this speed, like a hand; returns when it has arrived.
void glide(HdControls& device, const Vec3& p_mm, double mm_per_s);

}  // namespace trocar::testing
