#include "devices/testing/hd_stand_ins.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/testing/source_dir.h"
#include "devices/vendor/detail/hd_api.h"

namespace trocar::testing {

HdStandIns::HdStandIns() {
  std::filesystem::create_directories(folder_ / "devices");
  std::filesystem::create_directories(folder_ / "home" / "config");
  ::setenv(kHdVariable, (folder_ / "devices").c_str(), 1);
  ::setenv("GTDD_HOME", (folder_ / "home").c_str(), 1);
  ::setenv("TROCAR_LIBHD", (standin_dir() / "libHD.so").c_str(), 1);
}

HdStandIns::~HdStandIns() {
  for (const char* variable : {kHdVariable, "GTDD_HOME", "TROCAR_LIBHD"}) ::unsetenv(variable);
  for (HdControls* device : devices_) ::munmap(device, sizeof(HdControls));
}

HdControls& HdStandIns::add(const std::string& name, const char* model) {
  std::ofstream(folder_ / "home" / "config" / (name + ".config")) << "{}\n";
  const int file = ::open((folder_ / "devices" / name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  EXPECT_EQ(::ftruncate(file, sizeof(HdControls)), 0);
  void* memory = ::mmap(nullptr, sizeof(HdControls), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  EXPECT_NE(memory, MAP_FAILED);
  ::close(file);
  auto* device = new (memory) HdControls{};
  std::strncpy(device->model.data(), model, device->model.size() - 1);
  device->calibration = devices::hd::kCalibrationOk;
  for (std::size_t i = 0; i < device->R.size(); i += 4) device->R[i] = 1.0;
  devices_.push_back(device);
  return *device;
}

HdControls& HdStandIns::add_omni(const std::string& name) {
  HdControls& device = add(name, "PHANTOM Omni");
  device.calibration_style = devices::hd::kStyleInkwell;
  return device;
}

HdControls& HdStandIns::add_premium(const std::string& name) {
  HdControls& device = add(name, "PHANTOM Premium 1.5 High Force");
  device.force_n = 37.5;
  device.continuous_n = 6.2;
  device.stiffness_n_per_mm = 3.5;
  device.calibration_style = devices::hd::kStyleEncoderReset;
  return device;
}

void place(HdControls& device, const Vec3& p_mm) {
  for (int i = 0; i < 3; ++i) device.p_mm[static_cast<std::size_t>(i)] = p_mm[i];
}

void glide(HdControls& device, const Vec3& p_mm, double mm_per_s) {
  constexpr std::chrono::milliseconds kStep{2};
  const Vec3 from_mm(device.p_mm[0], device.p_mm[1], device.p_mm[2]);
  const int steps = 1 + static_cast<int>((p_mm - from_mm).norm() / (mm_per_s * 1e-3 * kStep.count()));
  for (int step = 1; step <= steps; ++step) {
    place(device, from_mm + (p_mm - from_mm) * step / steps);
    std::this_thread::sleep_for(kStep);
  }
}

}  // namespace trocar::testing
