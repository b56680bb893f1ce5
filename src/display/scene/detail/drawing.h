#pragma once

#include <vtkActor.h>
#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <span>
#include <vector>

#include "geometry/shapes.h"
#include "image/image.h"
#include "scene/camera.h"
#include "scene/scene_options.h"
#include "scene/scene_view.h"
#include "scene/structure.h"

class vtkPolyDataMapper;
class vtkRenderWindow;

namespace trocar::scene::detail {

/// The mesh with one normal per vertex; the second overload computes the normals from the mesh.
vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh, const std::vector<Vec3f>& normals);
vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh);
vtkSmartPointer<vtkPolyDataMapper> make_mapper(vtkPolyData* data);

/// Sets colour, opacity and specular coefficient of a surface.
void apply(const Appearance& look, vtkActor& actor);
/// Opacity increases from surface parts perpendicular to the view direction to the outline, as in glass. Only the front
/// side of a translucent surface is drawn, because its back side would cover the structures inside. Call once per
/// actor; has an effect while the opacity is below 1.
void make_translucent(vtkActor& actor);
/// Draws the actor in its own colour, without lighting.
void make_unlit(vtkActor& actor);

/// Draws a translucent actor in the pass of the opaque actors: it is blended over the actors drawn before it. Needs no
/// additional pass.
void blend_at_once(vtkActor& actor);

/// Adds a key light from the upper left, a weak fill light from the right, a cool rim light from behind, and a dark
/// background gradient.
void add_lights(vtkRenderer& renderer);
inline constexpr int kDepthPeels = 6;  ///< Translucent layers of a pixel that are drawn, at most.
void apply(const CameraView& view, vtkRenderer& renderer);

inline constexpr double kUnseen_mm = 0.005;  ///< Smaller motion is invisible: five thousandths of a millimetre.

/// A textured rectangle in 3D: RGBA pixels. Pixels with alpha 0 are not drawn; all others are opaque.
class PictureQuad {
 public:
  PictureQuad();
  vtkActor* actor() const noexcept { return actor_; }
  /// Pixel buffer to write before `show`: RGBA, `columns` x `rows`, top row first.
  std::span<std::uint8_t> resize(int columns, int rows);
  /// Corners of the image outline in P: top left, top right, bottom left.
  void show(const std::array<Vec3, 3>& corners_P);
  /// Sets the pixels of an image with its alpha (one byte per pixel; empty: all opaque) and shows it. True if it
  /// changed something.
  bool show_picture(const PictureView& picture, std::span<const std::uint8_t> alpha,
                    const std::array<Vec3, 3>& corners_P);
  /// Returns true if it was visible.
  bool hide();

 private:
  std::array<Vec3, 3> corners_P_ = zero_vectors<3>();
  vtkSmartPointer<vtkImageData> image_;
  vtkSmartPointer<vtkPolyData> rectangle_;
  vtkSmartPointer<vtkActor> actor_;
};

/// The window's pixels, averaged over blocks of `supersampling`^2, top row first. The window has columns*supersampling
/// x rows*supersampling pixels.
image::RgbImage read_picture(vtkRenderWindow& window, int columns, int rows, int supersampling);

}  // namespace trocar::scene::detail
