#pragma once

#include <string>
#include <vector>

#include "image/image.h"
#include "ultrasound/scanner/scanner.h"

namespace trocar::ultrasound {

inline constexpr image::Rgb kTextInk = {200, 205, 210};  ///< Of texts and ticks beside a picture.

/// Text beside a picture.
struct ScanCaption {
  std::string transducer;
  double frequency_mhz = 3.5;  ///< Received.
  bool is_harmonic = false;    ///< Tissue harmonic imaging.
  double focus_mm = 80.0;
  DisplaySettings settings;
  std::vector<std::string> remarks;  ///< Further lines, e.g. "frozen 12/60"; below the others.
};

/// Annotation around a scanner's picture, as positions in pixels, so that a window and a file show the same.
struct ScanAnnotation {
  struct Tick {
    double row = 0.0;
    int length_px = 4;
    double depth_mm = 0.0;
  };
  struct Text {
    int column = 0;  ///< Position of the top left dot.
    int row = 0;
    std::string text;
  };
  struct Wedge {
    int column = 0;
    int row = 0;
    int columns = 0;
    std::vector<std::uint8_t> gray;  ///< From the top; one value per pixel row.
  };
  int scale_column = 0;         ///< Ticks extend to the left from here; labels are on the right.
  std::vector<Tick> ticks;      ///< Depth below the middle of the face, including 0.
  double focus_row = 0.0;       ///< Row of the focus triangle, which points at the scale from the left.
  Vec2 marker_pixel{0.0, 0.0};  ///< Beside the marked end of the transducer's face: its +x end.
  Wedge wedge;                  ///< Gray of the levels within the dynamic range, white on top.
  std::vector<Text> texts;      ///< Depth labels in cm and the caption.
  int text_scale = 1;           ///< Pixels per dot.
};

ScanAnnotation make_scan_annotation(const RasterGeometry& raster, const ScanGeometry& scan, const ScanCaption& caption);

/// Draws over a picture of the raster's size; parts beyond the picture are left out.
void draw_annotation(image::RgbImage& image, const ScanAnnotation& annotation);

}  // namespace trocar::ultrasound
