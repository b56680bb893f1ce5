#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "ultrasound/live/scan_picture.h"
#include "ultrasound/scanner/display_settings.h"

namespace trocar::ultrasound {
namespace {

TEST(ScanPreset, ShippedOnesFitTheirTransducers) {
  const auto presets = load_scan_presets(data_dir() / "scan_presets.toml");
  ASSERT_TRUE(presets) << presets.error().text();
  EXPECT_GE(presets->size(), 3U);
  for (const ScanPreset& preset : *presets) {
    const auto transducer = load_transducer(data_dir() / "transducers.toml", preset.transducer);
    ASSERT_TRUE(transducer) << preset.name;
    ScanRequest request;
    request.acquisition = acquisition_of(preset, *transducer);
    EXPECT_EQ(within_ranges(request, *transducer).acquisition, request.acquisition) << preset.name;
    EXPECT_TRUE(check(preset.display)) << preset.name;
  }
}

TEST(ScanPreset, NamesTheInvalidKey) {
  const struct {
    const char* row;
    const char* says;
  } kBad[] = {{"title = 'x'\ntransducer = 'y'\ndepth_mm = 900", "depth_mm"},
              {"title = 'x'\ntransducer = 'y'\nflavour = 3", "flavour"},
              {"title = 'x'\ntransducer = 'y'\ngray_map = 'pink'", "pink"},
              {"title = 'x'", "transducer"}};
  const TemporaryFolder folder;
  const auto path = folder.path() / "presets.toml";
  for (const auto& bad : kBad) {
    std::ofstream(path) << "[presets.p]\n" << bad.row << "\n";
    const auto presets = load_scan_presets(path);
    ASSERT_FALSE(presets) << bad.row;
    EXPECT_NE(presets.error().text().find(bad.says), std::string::npos) << presets.error().text();
  }
}

}  // namespace
}  // namespace trocar::ultrasound
