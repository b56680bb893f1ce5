#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "image/image.h"
#include "motion/patient_motion.h"
#include "volume/grid.h"
#include "volume/sampling.h"

namespace trocar::slices {

/// Gray values of CT: black at centre - width/2, white at centre + width/2. Width > 0.
struct Window {
  double center_hu = 40.0;
  double width_hu = 400.0;

  bool operator==(const Window&) const = default;
};

struct WindowPreset {
  std::string_view name;
  Window window;
};
/// The windows of keys and menus, in this order. Sources: abdomen, lung, bone and spine as in Radiopaedia, "Windowing
/// (CT)" (abdomen 350..400 / 20..60, lung 1500 / -600, bone 1800 / 400, soft tissue of the spine 250 / 50, width /
/// centre). Liver assumed: narrow (Radiopaedia: 150 HU wide), centred such that both the plain (about 60 HU) and the
/// contrasted liver (about 100 HU) are gray.
inline constexpr std::array<WindowPreset, 5> kWindowPresets{{{"Abdomen", {40.0, 400.0}},
                                                             {"Liver", {60.0, 160.0}},
                                                             {"Lung", {-600.0, 1500.0}},
                                                             {"Bone", {400.0, 1800.0}},
                                                             {"Spine", {50.0, 250.0}}}};
/// Name of the preset that equals a window (within half a HU); empty for any other window.
std::string_view window_name(const Window& window) noexcept;

/// Gray of HU, rounded to the nearest step; 0 for NaN. `gray` has the length of `hu` (checked).
void apply_window(std::span<const float> hu, const Window& window, std::span<std::uint8_t> gray);

struct SliceStyle {
  Window window;
  double label_opacity = 0.25;  ///< Fill; outlines are always opaque. Range 0..1.
  bool has_outlines = true;
  bool hides_lesions = false;  ///< Lesions (lesions_as_organs) are painted as the organ that contains them.

  bool operator==(const SliceStyle&) const = default;
};

/// Buffers of paint_slice, reused for the next image.
struct SliceBuffers {
  std::vector<float> hu;
  std::vector<std::uint8_t> gray;
  std::vector<std::uint8_t> ids;
  std::vector<Vec3f> rest_A;
};

/// Labels that paint_slice draws: not fat, muscle and skin, which are the background of the structures.
bool is_drawn(const anatomy::Label& label) noexcept;

/// Paints CT on a plane (trilinear, window/level) and over it the labels (nearest) in their colours, filled and
/// outlined. Fat, muscle and skin are not painted, as they are the background of structures. The value outside of the
/// volume is air. The plane is in the patient now; `motion` tells where its tissue is at rest. Sets the image size to
/// that of the plane. Allocates only if an image is larger than the previous ones. One thread.
void paint_slice(const anatomy::VirtualPatient& patient, const volume::SlicePlane& plane, const SliceStyle& style,
                 SliceBuffers& buffers, image::RgbImage& picture, const motion::PatientMotion& motion = {});

/// How an ultrasound volume is shown in a slice of the CT.
enum class FusionKind : std::uint8_t { kOff, kBlend, kCheckerboard };

struct FusionStyle {
  FusionKind kind = FusionKind::kBlend;
  double share = 0.5;      ///< Of the ultrasound in the blend, 0..1.
  double field_mm = 15.0;  ///< Edge of a field of the checkerboard, > 0. The fields do not move with the zoom.

  bool operator==(const FusionStyle&) const = default;
};

/// An ultrasound volume with its pose in the CT. `imaged_U`: not 0 where it shows the body, on the grid of `gray_U`.
struct PlacedUltrasound {
  const volume::LabelGrid& gray_U;
  const volume::MaskGrid& imaged_U;
  double white = 255.0;  ///< Gray level that is shown white, > 0.
  Pose X_PU;
};

/// Draws an ultrasound over an image of paint_slice of the same plane: in orange over the CT, or in the fields of a
/// checkerboard. Nothing is drawn where the ultrasound has no image. One thread.
void fuse_ultrasound(const PlacedUltrasound& ultrasound, const volume::SlicePlane& plane, const FusionStyle& style,
                     image::RgbImage& picture);

}  // namespace trocar::slices
