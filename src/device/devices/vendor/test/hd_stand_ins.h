#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/files/temporary_folder.h"
#include "geometry/vec.h"

namespace trocar::testing {

/// Folder of the devices' files, a file a device, named after it.
inline constexpr const char* kHdVariable = "TROCAR_STANDIN_HD";

/// How an OpenHaptics device stands, in memory that a test shares with the program that has opened it. The hand that
/// holds it does not give way.
struct HdControls {
  std::array<char, 64> model{};
  int output_dof = 3;
  double force_n = 3.3, continuous_n = 0.88, stiffness_n_per_mm = 0.5;
  int calibration_style = 0;
  std::atomic<std::uint32_t> calibration{0};
  std::atomic<int> is_present{1};
  std::atomic<int> is_in_reset_position{0};
  std::atomic<int> buttons{0};
  std::array<std::atomic<double>, 9> R{};     ///< Row by row, in the vendor's axes.
  std::array<std::atomic<double>, 3> p_mm{};  ///< Likewise.
  std::atomic<double> strongest_n{0.0};       ///< Of the motors, since the beginning.
  std::atomic<int> openings{0};               ///< How often it was opened.
};

/// OpenHaptics devices for programs that are started while it lives: the environment has them open the stand-in library
/// and find the configuration that the vendor's setup program would have written.
class HdStandIns {
 public:
  HdStandIns();
  ~HdStandIns();
  HdStandIns(const HdStandIns&) = delete;
  HdStandIns& operator=(const HdStandIns&) = delete;

  /// Plugged in and calibrated, held in the middle of its workspace, the tip away from who sits there.
  HdControls& add_omni(const std::string& name);
  HdControls& add_premium(const std::string& name);

 private:
  HdControls& add(const std::string& name, const char* model);

  TemporaryFolder folder_;
  std::vector<HdControls*> devices_;
};

/// In the vendor's axes, for HdControls::p_mm.
void place(HdControls& device, const Vec3& p_mm);
/// As a hand moves it there; returns when it is there.
void glide(HdControls& device, const Vec3& p_mm, double mm_per_s);

}  // namespace trocar::testing
