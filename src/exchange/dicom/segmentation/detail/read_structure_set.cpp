#include "dicom/segmentation/detail/read_structure_set.h"

#include <fmt/format.h>

#include "core/available_memory.h"
#include "dicom/segmentation/detail/contour_raster.h"
#include "dicom/segmentation/detail/contours.h"
#include "dicom/segmentation/detail/label_layers.h"

namespace trocar::dicom::detail {
namespace {

constexpr double kSparsePlanes = 3.5;    ///< Steps of the grid: more were drawn on by hand only here and there.
constexpr double kMostOutside_ml = 1.0;  ///< Of a structure beyond the CT without a warning.
constexpr double kMostCommon_ml = 0.05;  ///< In two contours of a plane without a warning.

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// What the contours leave open: gaps and the places between them.
void warn_of_distances(const std::string& name, const PlaneDistances& distances, double step_mm, bool is_on_ct,
                       std::vector<std::string>& warnings) {
  const std::string usual = fmt::format("; its planes are usually {:.1f} mm apart", distances.usual * step_mm);
  if (distances.filled_gaps > 0)
    warnings.push_back(fmt::format("\"{}\": {} between contours filled, of up to {:.1f} mm{}", name,
                                   counted(distances.filled_gaps, "gap"), distances.widest_filled * step_mm, usual));
  if (distances.open_gaps > 0)
    warnings.push_back(fmt::format("\"{}\": {} between contours left empty, of {:.1f} mm or more{}", name,
                                   counted(distances.open_gaps, "gap"), distances.narrowest_open * step_mm, usual));
  if (is_on_ct && distances.usual > kSparsePlanes)
    warnings.push_back(
        fmt::format("\"{}\": its contours are {:.1f} mm apart, the CT's slices {:.1f} mm: filled "
                    "half-way to the next contour",
                    name, distances.usual * step_mm, step_mm));
}

/// Contours of one plane whose meaning is not plain.
void warn_of_overlaps(const ContourStructure& structure, const RasterResult& raster,
                      std::vector<std::string>& warnings) {
  const std::string& name = structure.segment.name;
  if (raster.repeated > 0)
    warnings.push_back(fmt::format("\"{}\": {} left out, the same as another one of the plane", name,
                                   counted(raster.repeated, "contour")));
  if (raster.crossing_ml > kMostCommon_ml)
    warnings.push_back(fmt::format("\"{}\": {} of contours cross in their plane: the {:.1f} ml in both are {}", name,
                                   counted(raster.crossing, "pair"), raster.crossing_ml,
                                   structure.is_exclusive_or ? "outside (CLOSEDPLANAR_XOR)" : "inside"));
  if (raster.doubtful_ml > kMostCommon_ml)
    warnings.push_back(
        fmt::format("\"{}\": {} of {:.1f} ml left empty: contours inside others of their plane, but "
                    "across them or leaving only a thin ring; drawn twice?",
                    name, counted(raster.doubtful, "hole"), raster.doubtful_ml));
}

void warn_of(const ContourStructure& structure, const RasterResult& raster, const ContourGrid& grid, bool is_on_ct,
             std::vector<std::string>& warnings) {
  const std::string& name = structure.segment.name;
  if (structure.degenerate > 0)
    warnings.push_back(fmt::format("\"{}\": {} contours of one or two points left out", name, structure.degenerate));
  warn_of_overlaps(structure, raster, warnings);
  warn_of_distances(name, raster.distances, grid.geometry.spacing_mm[grid.axis], is_on_ct, warnings);
  if (raster.outside_ml > kMostOutside_ml)
    warnings.push_back(fmt::format("\"{}\": {:.0f} ml lie beyond the CT and are left out", name, raster.outside_ml));
}

/// The place of a structure in another frame of reference than the CT's, or than that of the other structures, is
/// unknown.
Status check_frames(const std::vector<ContourStructure>& structures, const CtReference& ct, const std::string& where) {
  std::string expected = ct.frame_of_reference;
  std::string owner = "the CT";
  for (const ContourStructure& structure : structures) {
    const std::string& frame = structure.frame_of_reference;
    if (frame.empty() || structure.contours.empty()) continue;
    if (expected.empty()) {
      expected = frame;
      owner = fmt::format("\"{}\"", structure.segment.name);
    } else if (frame != expected) {
      return fail(fmt::format("\"{}\" (number {}) is in another frame of reference ({}) than {} ({})",
                              structure.segment.name, structure.segment.number, frame, owner, expected),
                  where,
                  "draw it on this CT and export it again, or ignore it with ignore = [\"NAME\"] in a label map "
                  "(--label-map)");
    }
  }
  return {};
}

}  // namespace

Result<Segmentation> read_structure_set(const DicomFile& file, const std::string& where, const CtReference& ct,
                                        const std::function<bool(const Segment&)>& is_wanted) {
  TROCAR_TRY(const std::vector<ContourStructure> structures, read_contours(file, where, is_wanted));
  TROCAR_TRY_STATUS(check_frames(structures, ct, where));
  TROCAR_TRY_STATUS(check_memory_for_image(ct.grid.voxel_count(), available_memory_bytes(), where));
  Segmentation result;
  LabelLayers on_ct(ct.grid.size, where);
  for (const ContourStructure& structure : structures) {
    const std::size_t index = result.segments.size();
    result.segments.push_back(structure.segment);
    if (structure.contours.empty()) continue;
    TROCAR_TRY(const ContourGrid grid, choose_grid(structure, ct.grid, where));
    const RasterResult raster = rasterise(structure, grid);
    const bool is_on_ct = grid.geometry.matches(ct.grid);
    warn_of(structure, raster, grid, is_on_ct, result.warnings);
    if (is_on_ct) {
      TROCAR_TRY_STATUS(on_ct.add(index, 0, raster.mask));
      continue;
    }
    LabelLayers own(grid.geometry.size, where);
    TROCAR_TRY_STATUS(own.add(index, 0, raster.mask));
    for (LabelLayers::Layer& layer : own.take()) {
      volume::LabelGrid labels;
      labels.geometry = grid.geometry;
      labels.voxels = std::move(layer.voxels);
      result.volumes.push_back({std::move(labels), std::move(layer.segments)});
    }
  }
  for (LabelLayers::Layer& layer : on_ct.take()) {
    volume::LabelGrid labels;
    labels.geometry = ct.grid;
    labels.voxels = std::move(layer.voxels);
    result.volumes.push_back({std::move(labels), std::move(layer.segments)});
  }
  return result;
}

}  // namespace trocar::dicom::detail
