#include "surface/extract_surface.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "core/parallel.h"
#include "surface/detail/contour.h"

namespace trocar::surface {
namespace {

// Assumed: finer sampling of a large structure only adds triangles that decimation removes.
constexpr std::size_t kManyVoxels = 300'000;
constexpr double kCoarseMm = 1.5;
// Assumed: enough for the shape of one structure in a picture; an organ at 1 mm has 20,000 to 60,000, the skin of a
// trunk 500,000. Decimation takes 5 microseconds per face.
constexpr std::size_t kWantedFaces = 40'000;
// Assumed: the skin of a whole trunk has a third of this at 1.5 mm, noise in a whole CT a hundred times as many.
constexpr std::size_t kMaxFaces = 1'000'000;

/// The voxels of one structure and the box around them.
struct Box {
  volume::Index3 low{0, 0, 0};
  volume::Index3 high{-1, -1, -1};
  std::size_t voxels = 0;

  void add(const Box& other) {
    if (other.voxels == 0) return;
    add(other.low, other.high[0], 0);
    add(other.high, other.high[0], other.voxels);
  }
  void add(const volume::Index3& ijk, std::int64_t last_i, std::size_t count) {
    if (high[0] < low[0]) low = high = ijk;
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], ijk[a]);
    for (std::size_t a = 0; a < 3; ++a) high[a] = std::max(high[a], ijk[a]);
    high[0] = std::max(high[0], last_i);
    voxels += count;
  }
};

std::array<Box, 256> find_boxes(const volume::LabelGrid& labels) {
  std::array<Box, 256> boxes;
  const auto& size = labels.geometry.size;
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const std::uint8_t* row = labels.voxels.data() + labels.geometry.offset({0, j, k});
      for (std::int64_t i = 0; i < size[0];) {
        const std::int64_t first = i;
        while (i < size[0] && row[i] == row[first]) ++i;
        if (row[first] != 0) boxes[row[first]].add({first, j, k}, i - 1, static_cast<std::size_t>(i - first));
      }
    }
  }
  return boxes;
}

/// Labels of one surface: a label, and the lesions in it.
struct Body {
  std::array<bool, 256> has{};
  Box box;
};

Body body_of(std::uint8_t id, const std::array<Box, 256>& boxes, const std::array<std::uint8_t, 256>& organ_of) {
  Body body;
  for (std::size_t label = 1; label < boxes.size(); ++label) {
    body.has[label] = label == id || organ_of[label] == id;
    if (body.has[label]) body.box.add(boxes[label]);
  }
  return body;
}

volume::MaskGrid cut_out(const volume::LabelGrid& labels, const Body& body) {
  const Box& box = body.box;
  volume::GridGeometry geometry = labels.geometry;
  for (std::size_t a = 0; a < 3; ++a) geometry.size[a] = box.high[a] - box.low[a] + 1;
  geometry.origin_P = labels.geometry.centre_mm(box.low);
  volume::MaskGrid mask(geometry);
  std::size_t n = 0;
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k) {
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j) {
      const std::uint8_t* row = labels.voxels.data() + labels.geometry.offset({0, j, k});
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) mask.voxels[n++] = body.has[row[i]] ? 1 : 0;
    }
  }
  return mask;
}

bool fills_the_space_between(const anatomy::Label& label) {
  const bool is_membrane = label.is_derived && (label.tissue == "peritoneum" || label.tissue == "pleura");
  return is_membrane || label.tissue == "adipose" || label.tissue == "gas" || label.tissue == "soft_tissue" ||
         label.name == "muscle";
}

volume::MaskGrid body_mask(const volume::FloatGrid& skin_distance_mm) {
  volume::MaskGrid mask(skin_distance_mm.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = skin_distance_mm.voxels[n] < 0.0F ? 1 : 0;
  return mask;
}

/// A structure with a surface. Id 0: the skin.
struct Structure {
  std::uint8_t id = 0;
  std::string name;
};

/// The skin first, which shows the whole patient, then the small structures, which are fast.
std::vector<Structure> structures_of(const anatomy::VirtualPatient& patient, const std::array<Box, 256>& boxes,
                                     const SurfaceOptions& options) {
  std::vector<Structure> structures;
  for (const anatomy::Label& label : patient.label_table.labels) {
    const bool has_surface =
        !fills_the_space_between(label) && boxes[label.id].voxels >= std::max<std::size_t>(options.min_voxels, 1);
    if (has_surface) structures.push_back({label.id, label.name});
  }
  std::stable_sort(structures.begin(), structures.end(),
                   [&](const Structure& a, const Structure& b) { return boxes[a.id].voxels < boxes[b.id].voxels; });
  structures.insert(structures.begin(), {0, "skin"});
  return structures;
}

std::vector<anatomy::NamedMesh> in_table_order(std::map<std::string, TriangleMesh> found,
                                               const anatomy::LabelTable& table) {
  std::vector<anatomy::NamedMesh> meshes;
  const auto add = [&](const std::string& name) {
    if (auto mesh = found.extract(name)) meshes.push_back({name, std::move(mesh.mapped())});
  };
  add("skin");
  for (const anatomy::Label& label : table.labels) add(label.name);
  return meshes;
}

}  // namespace

TriangleMesh extract_surface(const volume::MaskGrid& mask, const SurfaceOptions& options) {
  const auto voxels = static_cast<std::size_t>(std::count(mask.voxels.begin(), mask.voxels.end(), 1));
  if (voxels == 0) return {};
  const volume::Grid<std::uint8_t> occupancy =
      detail::bounded_occupancy(mask, voxels > kManyVoxels ? kCoarseMm : 0.0, kWantedFaces, kMaxFaces);
  TriangleMesh mesh = detail::contour(occupancy, options);
  detail::restore_volume(mesh, static_cast<double>(voxels) * mask.geometry.voxel_volume_mm3(),
                         0.5 * mask.geometry.spacing_mm.maxCoeff());
  const volume::GridGeometry& geometry = occupancy.geometry;
  for (Vec3f& vertex : mesh.vertices)
    vertex = (geometry.origin_P + geometry.R_PV * vertex.cast<double>()).cast<float>();
  return mesh;
}

void extract_each_surface(const anatomy::VirtualPatient& patient, const SurfaceOptions& options,
                          const SurfaceReceiver& receive) {
  const std::array<Box, 256> boxes = find_boxes(patient.labels);
  const std::array<std::uint8_t, 256> organ_of = anatomy::lesions_as_organs(patient.label_table);
  const std::vector<Structure> structures = structures_of(patient, boxes, options);
  std::atomic<bool> is_stopped = false;
  std::mutex receiving;
  std::size_t done = 0;
  parallel_for(structures.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last && !is_stopped; ++n) {
      const std::uint8_t id = structures[n].id;
      anatomy::NamedMesh mesh{structures[n].name, {}};
      mesh.mesh_P = extract_surface(
          id == 0 ? body_mask(patient.skin_distance_mm) : cut_out(patient.labels, body_of(id, boxes, organ_of)),
          options);
      const std::lock_guard lock(receiving);
      if (is_stopped) return;
      is_stopped = !receive(std::move(mesh), ++done, structures.size());
    }
  });
}

std::vector<anatomy::NamedMesh> extract_surfaces(const anatomy::VirtualPatient& patient, const SurfaceOptions& options,
                                                 const Progress& progress) {
  std::map<std::string, TriangleMesh> found;
  extract_each_surface(patient, options, [&](anatomy::NamedMesh mesh, std::size_t done, std::size_t count) {
    if (!mesh.mesh_P.triangles.empty()) found.emplace(mesh.name, std::move(mesh.mesh_P));
    report(progress, "surfaces", static_cast<double>(done) / static_cast<double>(count));
    return true;
  });
  return in_table_order(std::move(found), patient.label_table);
}

}  // namespace trocar::surface
