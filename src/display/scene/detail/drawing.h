#pragma once

#include <vtkActor.h>
#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "scene/camera.h"
#include "scene/detail/appearance.h"
#include "volume/image.h"

class vtkPolyDataMapper;
class vtkRenderWindow;

namespace trocar::scene::detail {

/// The mesh with normals, one a vertex; without them they are those of the mesh.
vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh, const std::vector<Vec3f>& normals);
vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh);
vtkSmartPointer<vtkPolyDataMapper> make_mapper(vtkPolyData* data);

/// Colour, opacity and shine of a surface.
void apply(const Appearance& look, vtkActor& actor);
/// Clear where it is seen face on, denser towards its outline, like glass. Of a translucent surface the front alone is
/// drawn: its far side would veil what lies inside. Once for an actor; has an effect while its opacity is below 1.
void make_translucent(vtkActor& actor);
/// Drawn in its own colour, whatever the light.
void make_unlit(vtkActor& actor);

/// Translucent, and yet drawn in its turn among the opaque ones: over what has been drawn before it. Costs no pass of
/// its own.
void blend_at_once(vtkActor& actor);

/// Key from the upper left, a weak fill from the right, a cool rim from behind; a dark gradient behind all.
void add_studio(vtkRenderer& renderer);
void apply(const CameraView& view, vtkRenderer& renderer);

/// A flat picture in space: the pixels' RGBA on a rectangle. Where alpha is 0 nothing is drawn; elsewhere it is opaque.
class PictureQuad {
 public:
  PictureQuad();
  vtkActor* actor() const noexcept { return actor_; }
  /// RGBA, `columns` x `rows`, top row first, to be written and then `show`n.
  std::span<std::uint8_t> resize(int columns, int rows);
  /// Corners of the picture's outline in P: top left, top right, bottom left.
  void show(const std::array<Vec3, 3>& corners_P);
  /// Both at once for a picture with its alpha (one byte a pixel; empty: all shown); tells whether anything is new.
  bool show_picture(const volume::RgbImage& picture, std::span<const std::uint8_t> alpha,
                    const std::array<Vec3, 3>& corners_P);
  /// Tells whether it was shown.
  bool hide();

 private:
  std::array<Vec3, 3> corners_P_ = zero_vectors<3>();
  vtkSmartPointer<vtkImageData> image_;
  vtkSmartPointer<vtkPolyData> rectangle_;
  vtkSmartPointer<vtkActor> actor_;
};

/// The window's pixels, averaged over blocks of `supersampling`^2 and turned to run from the top. The window has
/// columns*supersampling x rows*supersampling pixels.
volume::RgbImage read_picture(vtkRenderWindow& window, int columns, int rows, int supersampling);

}  // namespace trocar::scene::detail
