#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "geometry/pose.h"
#include "geometry/shapes.h"
#include "image/image.h"
#include "motion/patient_motion.h"
#include "scene/tool_shapes.h"

namespace trocar::scene {

/// Pixels of a gray or colour image, which has to outlive it.
struct PictureView {
  PictureView() = default;
  PictureView(const image::GrayImage& gray) noexcept  // NOLINT: both kinds of images are meant
      : columns(gray.columns), rows(gray.rows), channels(1), bytes(gray.pixels) {}
  PictureView(const image::RgbImage& colour) noexcept  // NOLINT
      : columns(colour.columns),
        rows(colour.rows),
        channels(3),
        bytes(colour.pixels.empty() ? nullptr : colour.pixels.front().data(), 3 * colour.pixels.size()) {}

  int columns = 0, rows = 0;
  std::size_t channels = 1;  ///< 1 or 3 bytes a pixel, row by row from the top left.
  std::span<const std::uint8_t> bytes;
};

/// An ultrasound transducer and its image in 3D.
struct ScanView {
  Pose X_PT;
  TransducerFace face;
  PictureView picture;  ///< Empty: the transducer alone.
  /// One byte per pixel (0: not drawn), or empty (all drawn).
  std::span<const std::uint8_t> alpha;
  std::array<Vec3, 3> corners_P = zero_vectors<3>();  ///< Of the image: top left, top right, bottom left.
  std::uint64_t number = 0;  ///< Of the image: one of the same number is not looked at again; 0: it has none.
};

/// A fingertip on the skin.
struct Fingertip {
  Vec3 p_P = Vec3::Zero();          ///< Where it touches the skin.
  Vec3 inward_P = Vec3::UnitY();    ///< Unit, into the body.
  image::Rgb color{200, 200, 200};  ///< Of the ring around it: what it feels.
};

/// What of a frame changes from frame to frame: where the patient is, and the tools. Frame P, mm. Spans and images have
/// to live as long as the call that takes it.
struct SceneView {
  motion::PatientMotion motion;
  std::span<const Vec3> shaft_P;  ///< Hub to tip; fewer than two points: no needle.
  double diameter_mm = 1.0;       ///< Of the needle.
  NeedleModel model = NeedleModel::kChiba;
  std::optional<Segment> goal_P;       ///< Needle at the hand's pose, translucent.
  std::optional<Segment> stylet_P;     ///< Of a biopsy gun, ahead of its cannula.
  std::optional<Segment> core_P;       ///< Place of the last core.
  std::optional<Segment> throw_P;      ///< Path of a gun's stylet if it were fired now; dashed.
  std::optional<Segment> notch_P;      ///< The part of it where the notch stops.
  std::optional<Fingertip> finger;     ///< Palpating.
  std::span<const Vec3> skin_marks_P;  ///< Dots of a skin marker.
  std::optional<ScanView> scan;
};

}  // namespace trocar::scene
