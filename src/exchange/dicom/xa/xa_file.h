#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::dicom {

/// Whom and what an X-ray image belongs to. Without a change, an anonymous patient and new UIDs.
struct XaIdentity {
  std::string patient_name = "ANONYMOUS^";
  std::string patient_id = "ANONYMOUS";
  std::string study_description = "Simulated X-ray";
  std::string series_description = "Fluoroscopy";
  std::string study_uid, series_uid, instance_uid;  ///< Empty: random ones.
  int series_number = 1, instance_number = 1;       ///< Range 1..2^31 - 1.
};

/// C-arm of an image, as DICOM PS3.3 C.8.7.5 states it.
struct XaGeometry {
  double primary_angle_deg = 0.0;    ///< LAO positive. Range -180..180.
  double secondary_angle_deg = 0.0;  ///< Cranial positive. Range -90..90.
  double source_detector_mm = 1100.0;
  double source_patient_mm = 700.0;  ///< To the isocentre.
  double pixel_mm = 0.5;             ///< Distance of pixels at the detector.
};

/// Exposure of an image (C.8.7.2).
struct XaExposure {
  double kv = 80.0;
  double tube_current_ma = 50.0;
  double pulse_ms = 5.0;              ///< Mean width of a pulse.
  double total_mas = 0.0;             ///< Of all frames.
  double area_product_mgy_cm2 = 0.0;  ///< Of all frames.
  bool is_low_dose = true;            ///< Fluoroscopy ("SC"); otherwise an acquisition ("GR").
};

/// Grays and how they came about.
struct XaImage {
  int columns = 0, rows = 0;
  std::vector<std::vector<std::uint8_t>> frames;  ///< Row by row from the upper left, as displayed; 255: white.
  std::vector<double> time_s;                     ///< Of each frame, rising; may be empty for one frame.
  std::array<int, 4> shutters{0, 0, 0, 0};        ///< Dark columns at the left and right, rows at the top and bottom.
  XaGeometry geometry;
  XaExposure exposure;
  XaIdentity identity;
};

/// Writes an X-Ray Angiographic Image (PS3.3, A.14), 8 bits, uncompressed, single or multi-frame, completely or not at
/// all. Errors: no frames, sizes that do not agree, times that do not rise, a UID that is none, the file system's.
Status write_xa_file(const XaImage& image, const std::filesystem::path& path);

}  // namespace trocar::dicom
