#pragma once

#include <cmath>
#include <numbers>

#include "anatomy/patient.h"

namespace trocar::scene {

inline constexpr image::Rgb kRed = {220, 30, 30};
inline constexpr image::Rgb kGreen = {30, 200, 60};

/// A closed sphere of latitude and longitude triangles, facing outward.
inline TriangleMesh ball(const Vec3& center_P, double radius_mm) {
  constexpr int kRings = 24;
  constexpr int kSectors = 48;
  TriangleMesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double theta = std::numbers::pi * ring / kRings;
    for (int sector = 0; sector < kSectors; ++sector) {
      const double phi = 2.0 * std::numbers::pi * sector / kSectors;
      const Vec3 n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      mesh.vertices.push_back((center_P + radius_mm * n).cast<float>());
    }
  }
  const auto id = [](int ring, int sector) { return static_cast<std::uint32_t>(ring * kSectors + sector % kSectors); };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      mesh.triangles.push_back({id(ring, sector), id(ring + 1, sector), id(ring + 1, sector + 1)});
      mesh.triangles.push_back({id(ring, sector), id(ring + 1, sector + 1), id(ring, sector + 1)});
    }
  }
  return mesh;
}

/// A red organ on the patient's right and a green one towards the head, inside a skin.
struct Scene {
  anatomy::VirtualPatient patient;
  std::vector<anatomy::NamedMesh> meshes;
};

inline Scene two_organs() {
  Scene scene;
  scene.patient.label_table.labels = {{1, "right", "kidney", kRed}, {2, "upper", "spleen", kGreen}};
  scene.meshes = {
      {"skin", ball({0, 0, 0}, 100.0)}, {"right", ball({-50, 0, 0}, 20.0)}, {"upper", ball({0, 0, 50}, 20.0)}};
  return scene;
}

inline bool is_reddish(const image::Rgb& c) {
  return c[0] > 70 && c[0] > 2 * c[1] && c[0] > 2 * c[2];
}
inline bool is_greenish(const image::Rgb& c) {
  return c[1] > 60 && 2 * c[1] > 3 * c[0] && 2 * c[1] > 3 * c[2];
}

inline bool is_bluish(const image::Rgb& c) {
  return c[2] > 90 && c[2] > c[1] && 2 * c[2] > 5 * c[0];
}

/// Mean position of the pixels that pass, in pixels; NaN if none passes.
inline Eigen::Vector2d middle_of(const image::RgbImage& image, bool (*passes)(const image::Rgb&)) {
  Eigen::Vector2d sum(0, 0);
  int count = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      if (!passes(image.at(column, row))) continue;
      sum += Eigen::Vector2d(column, row);
      ++count;
    }
  }
  return sum / count;
}

inline int count_of(const image::RgbImage& image, bool (*passes)(const image::Rgb&)) {
  int count = 0;
  for (const image::Rgb& pixel : image.pixels) count += passes(pixel) ? 1 : 0;
  return count;
}

}  // namespace trocar::scene
