#include "motion_builder/detail/body_map.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/parallel.h"
#include "volume/distance.h"
#include "volume/morphology.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::motion_builder::detail {
namespace {

bool contains_word(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

/// By name where it says more than the tissue.
Part part_of(const anatomy::Label& label) {
  const std::string_view name = label.name, tissue = label.tissue;
  if (tissue == "liver" || tissue == "liver_lesion" || tissue == "gallbladder" || tissue == "bile_duct" ||
      contains_word(name, {"portal", "hepatic"}))
    return Part::kLiver;
  if (tissue == "lung") return Part::kLung;
  if (tissue == "kidney" || contains_word(name, {"adrenal"})) return Part::kKidney;
  if (tissue == "spleen") return Part::kSpleen;
  if (contains_word(name, {"pancrea"})) return Part::kPancreas;
  if (contains_word(name, {"stomach"})) return Part::kStomach;
  if (contains_word(name, {"heart", "atri", "ventric", "pulmonary"})) return Part::kHeart;
  if (tissue == "bowel" || tissue == "organ" || tissue == "ascites" || tissue == "fluid") return Part::kBowel;
  if (name.starts_with("rib") || contains_word(name, {"sternum", "costal"})) return Part::kRib;
  if (contains_word(name, {"aorta", "iliac"}) || tissue == "bone" || tissue == "cartilage" || tissue == "ligament" ||
      tissue == "ligamentum_flavum" || tissue == "csf" || tissue == "nerve")
    return Part::kStill;
  if (tissue == "muscle" && !label.is_derived && name != "muscle")
    return contains_word(name, {"autochthon", "iliopsoas", "gluteus"}) ? Part::kStill : Part::kWall;
  if (tissue == "skin") return Part::kWall;
  return Part::kOther;
}

/// An isotropic grid along P over the volume. Its origin is a multiple of 1/8 mm: exact in files.
volume::GridGeometry coarse_grid(const volume::GridGeometry& fine) {
  Eigen::AlignedBox3d box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (unsigned axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> axis & 1U) != 0 ? static_cast<double>(fine.size[axis]) - 0.5 : -0.5;
    box.extend(fine.to_mm(index));
  }
  volume::GridGeometry grid;
  grid.spacing_mm = Vec3::Constant(kVoxel_mm);
  for (int axis = 0; axis < 3; ++axis) {
    grid.origin_P[axis] = std::round(8.0 * (box.min()[axis] + 0.5 * kVoxel_mm)) / 8.0;
    grid.size[static_cast<std::size_t>(axis)] = std::max<std::int64_t>(3, std::llround(box.sizes()[axis] / kVoxel_mm));
  }
  return grid;
}

volume::MaskGrid mask_of(const volume::Grid<std::uint8_t>& parts, std::initializer_list<Part> wanted) {
  std::array<std::uint8_t, kParts> is_wanted{};
  for (const Part part : wanted) is_wanted[static_cast<std::size_t>(part)] = 1;
  volume::MaskGrid mask(parts.geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = is_wanted[parts.voxels[n]];
  return mask;
}

bool is_empty(const volume::MaskGrid& mask) {
  return std::ranges::none_of(mask.voxels, [](std::uint8_t voxel) { return voxel != 0; });
}

/// Bones of a segmentation that has one label for all: those far from the spine that are not of the pelvis are ribs.
void find_ribs(BodyMap& map, std::int64_t lowest_rib) {
  constexpr double kSpineWidth_mm = 42.0, kSpineDepth_mm = 60.0;
  volume::Grid<std::uint8_t>& parts = map.parts;
  for (std::size_t n = 0; n < parts.voxels.size(); ++n) {
    if (parts.voxels[n] != static_cast<std::uint8_t>(Part::kStill)) continue;
    const volume::Index3 index = parts.geometry.index_of(n);
    if (index[2] < lowest_rib) continue;
    const Vec3 p = parts.geometry.centre_mm(index);
    const Eigen::Vector2d& spine = map.spine_P[static_cast<std::size_t>(index[2])];
    if (std::abs(p.x() - spine.x()) < kSpineWidth_mm && spine.y() - p.y() < kSpineDepth_mm) continue;
    parts.voxels[n] = static_cast<std::uint8_t>(Part::kRib);
  }
}

/// The spine is the bone in the middle of the back. Slices without it take that of their neighbours.
std::vector<Eigen::Vector2d> find_spine(const volume::Grid<std::uint8_t>& parts) {
  constexpr double kHalfWidth_mm = 35.0;
  const volume::GridGeometry& grid = parts.geometry;
  double middle = 0.0, count = 0.0;
  const auto for_still = [&](const auto& take) {
    for (std::size_t n = 0; n < parts.voxels.size(); ++n)
      if (parts.voxels[n] == static_cast<std::uint8_t>(Part::kStill)) take(grid.index_of(n));
  };
  for_still([&](const volume::Index3& index) {
    middle += grid.centre_mm(index).x();
    count += 1.0;
  });
  middle /= std::max(count, 1.0);
  const auto slices = static_cast<std::size_t>(grid.size[2]);
  std::vector<Eigen::Vector2d> sums(slices, Eigen::Vector2d::Zero());
  std::vector<double> counts(slices, 0.0);
  for_still([&](const volume::Index3& index) {
    const Vec3 p = grid.centre_mm(index);
    if (std::abs(p.x() - middle) > kHalfWidth_mm) return;
    sums[static_cast<std::size_t>(index[2])] += p.head<2>();
    counts[static_cast<std::size_t>(index[2])] += 1.0;
  });
  Eigen::Vector2d last(middle, grid.origin_P.y() + 0.7 * static_cast<double>(grid.size[1]) * kVoxel_mm);
  for (std::size_t k = slices; k-- > 0;) {
    if (counts[k] > 0.0) last = sums[k] / counts[k];
    sums[k] = last;
  }
  return sums;
}

/// Subcutaneous fat: fat that is connected with the skin and not deep; the muscles below it are the wall, too.
void add_wall(BodyMap& map, const volume::FloatGrid& skin_mm, const volume::MaskGrid& fat,
              const volume::MaskGrid& muscle) {
  constexpr double kSkin_mm = 4.0, kDeepestFat_mm = 60.0, kMuscle_mm = 18.0, kLeak_mm = 3.0;
  // Thin layers of fat between muscles do not conduct.
  const volume::MaskGrid open = volume::dilate(volume::erode(fat, kLeak_mm), kLeak_mm);
  volume::MaskGrid outer(fat.geometry);
  for (std::size_t n = 0; n < outer.voxels.size(); ++n) {
    const float depth_mm = -skin_mm.voxels[n];
    outer.voxels[n] = depth_mm > 0.0F && (depth_mm < kSkin_mm || (open.voxels[n] != 0 && depth_mm < kDeepestFat_mm));
  }
  outer = volume::largest_component(outer);
  const volume::FloatGrid to_outer_mm = volume::distance_to_mask_mm(outer);
  for (std::size_t n = 0; n < outer.voxels.size(); ++n) {
    auto& part = map.parts.voxels[n];
    if (part != static_cast<std::uint8_t>(Part::kOther)) continue;
    if (outer.voxels[n] != 0 || (muscle.voxels[n] != 0 && to_outer_mm.voxels[n] < kMuscle_mm))
      part = static_cast<std::uint8_t>(Part::kWall);
  }
}

/// Half way between wall and organs; where no organ is labelled, a little below the wall.
volume::FloatGrid depth_below_wall(const volume::Grid<std::uint8_t>& parts) {
  constexpr double kBelow_mm = 4.0, kClose_mm = 9.0, kStep_mm = 1.0 / 16.0;
  const volume::MaskGrid wall = mask_of(parts, {Part::kRib, Part::kStill, Part::kWall, Part::kOutside});
  const volume::MaskGrid organs = mask_of(parts, {Part::kLung, Part::kLiver, Part::kKidney, Part::kSpleen,
                                                  Part::kPancreas, Part::kStomach, Part::kHeart, Part::kBowel});
  // Between the ribs the wall goes on.
  const volume::MaskGrid closed = volume::erode(volume::dilate(wall, kClose_mm), kClose_mm);
  volume::MaskGrid solid = wall;
  for (std::size_t n = 0; n < solid.voxels.size(); ++n)
    solid.voxels[n] |= static_cast<std::uint8_t>(closed.voxels[n] != 0 && organs.voxels[n] == 0);
  volume::FloatGrid to_wall_mm, to_organ_mm;
  parallel_invoke([&] { to_wall_mm = volume::signed_distance_mm(solid); },
                  [&] { to_organ_mm = volume::signed_distance_mm(organs); });
  volume::FloatGrid depth_mm(parts.geometry);
  for (std::size_t n = 0; n < depth_mm.voxels.size(); ++n) {
    const double out = to_wall_mm.voxels[n], in = to_organ_mm.voxels[n];
    depth_mm.voxels[n] =
        static_cast<float>(std::clamp(std::max(0.5 * (out - in), out - kBelow_mm), -kDeepest_mm, kDeepest_mm));
  }
  // Beyond the grid there is nothing, not a depth of 0.
  volume::FloatGrid known(parts.geometry, 1.0F);
  for (volume::FloatGrid* grid : {&depth_mm, &known}) volume::gaussian_blur(*grid, Vec3::Constant(1.0));
  for (std::size_t n = 0; n < depth_mm.voxels.size(); ++n) {
    const double depth = depth_mm.voxels[n] / known.voxels[n];
    depth_mm.voxels[n] =
        static_cast<float>(std::clamp(std::round(depth / kStep_mm) * kStep_mm, -kDeepest_mm, kDeepest_mm));
  }
  return depth_mm;
}

}  // namespace

Result<BodyMap> map_body(const anatomy::VirtualPatient& patient) {
  std::array<Part, 256> part_of_label{};
  part_of_label.fill(Part::kOther);
  std::array<bool, 256> is_fat{}, is_muscle{};
  bool has_ribs = false;
  for (const anatomy::Label& label : patient.label_table.labels) {
    part_of_label[label.id] = part_of(label);
    is_fat[label.id] = label.tissue == "adipose";
    is_muscle[label.id] = label.tissue == "muscle";
    has_ribs = has_ribs || part_of_label[label.id] == Part::kRib;
  }
  BodyMap map;
  const volume::GridGeometry grid = coarse_grid(patient.labels.geometry);
  map.parts = volume::Grid<std::uint8_t>(grid, static_cast<std::uint8_t>(Part::kOutside));
  volume::MaskGrid fat(grid), muscle(grid);
  volume::FloatGrid skin_mm(grid);
  const volume::LabelGrid labels = volume::resample_nearest(patient.labels, grid, 0);
  parallel_for(static_cast<std::size_t>(grid.size[2]), 1, [&](std::size_t first, std::size_t last) {
    const auto slice = static_cast<std::size_t>(grid.size[0] * grid.size[1]);
    for (std::size_t n = first * slice; n < last * slice; ++n) {
      const Vec3 p = grid.centre_mm(grid.index_of(n));
      skin_mm.voxels[n] = static_cast<float>(volume::sample_linear(patient.skin_distance_mm, p));
      if (skin_mm.voxels[n] >= 0.0F) continue;
      const std::uint8_t label = labels.voxels[n];
      map.parts.voxels[n] = static_cast<std::uint8_t>(label == 0 ? Part::kOther : part_of_label[label]);
      fat.voxels[n] = is_fat[label];
      muscle.voxels[n] = is_muscle[label];
    }
  });
  const auto has = [&](std::initializer_list<Part> wanted) { return !is_empty(mask_of(map.parts, wanted)); };
  constexpr const char* kAdvice = "label them and build the patient again, or let the patient rest: --breathing none";
  if (!has({Part::kLiver, Part::kLung, Part::kKidney, Part::kSpleen}))
    return fail("neither liver, lungs, kidneys nor spleen are labelled: breathing moves nothing that is known",
                patient.name, kAdvice);
  if (!has({Part::kStill})) return fail("no bone is labelled: the wall would have no hold", patient.name, kAdvice);
  map.spine_P = find_spine(map.parts);
  if (!has_ribs) {
    constexpr std::int64_t kBelowLiver = 16;  // voxels: the lowest ribs reach below the liver, the pelvis does not
    std::int64_t lowest = grid.size[2];
    for (std::size_t n = 0; n < map.parts.voxels.size(); ++n)
      if (map.parts.voxels[n] == static_cast<std::uint8_t>(Part::kLiver) ||
          map.parts.voxels[n] == static_cast<std::uint8_t>(Part::kLung))
        lowest = std::min(lowest, grid.index_of(n)[2]);
    find_ribs(map, lowest - kBelowLiver);
  }
  add_wall(map, skin_mm, fat, muscle);
  map.depth_mm = depth_below_wall(map.parts);
  return map;
}

}  // namespace trocar::motion_builder::detail
