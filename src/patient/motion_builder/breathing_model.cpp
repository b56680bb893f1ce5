#include "motion_builder/breathing_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/log.h"
#include "core/parallel.h"
#include "motion_builder/detail/body_map.h"
#include "motion_builder/detail/displacement_solver.h"
#include "volume/sampling.h"

namespace trocar::motion_builder {
namespace {

using detail::BodyMap, detail::DisplacementProblem, detail::Displacements, detail::kParts, detail::kRegions,
    detail::Part;
using motion::kDeepLiver_mm;

constexpr double kSpacing_mm = 8.0;  ///< Of the nodes.
enum Driver : std::size_t { kDiaphragm, kChest, kDrivers };

/// How a part of the body follows the diaphragm, in motions of the liver.
struct Follow {
  double down = 0.0, forward = 0.0;
  float pull = 0.0F;  ///< How firmly.
};
/// Kidneys: deep 16 to 17 mm of the liver's 24.4. Pancreas, spleen, stomach, heart, and the way forward: [assumed].
Follow follow_of(Part part) {
  constexpr float kFirm = 20.0F, kLoose = 2.0F, kScreen = 0.004F;
  switch (part) {
    case Part::kLiver:
      return {1.0, 0.25, kFirm};
    case Part::kKidney:
      return {0.68, 0.1, kFirm};
    case Part::kSpleen:
      return {0.8, 0.15, kFirm};
    case Part::kPancreas:
      return {0.75, 0.1, kLoose};
    case Part::kStomach:
      return {0.75, 0.2, kLoose};
    case Part::kHeart:
      return {0.6, 0.1, kLoose};
    case Part::kRib:
    case Part::kStill:
      return {0.0, 0.0, kFirm};
    default:
      return {0.0, 0.0, kScreen};  // far from everything nothing moves
  }
}

/// A rib turns about its neck, which points out and back (bucket and pump handle in one). Displacement of a point of
/// the chest in a deep breath. Angles and slope are assumed.
Vec3 rib_motion(const Vec3& p, const Eigen::Vector2d& spine) {
  constexpr double kTurn_rad = 0.06, kNeck_deg = 40.0, kSlope = 0.45, kJoint_mm = 22.0;
  const double side = p.x() < spine.x() ? -1.0 : 1.0;
  const double lateral = std::max(0.0, std::abs(p.x() - spine.x()) - kJoint_mm), front = spine.y() - p.y();
  const double drop = kSlope * std::hypot(lateral, front);
  const double c = std::cos(radians(kNeck_deg)), s = std::sin(radians(kNeck_deg));
  return kTurn_rad * Vec3(side * s * drop, -c * drop, c * front + s * lateral);
}

/// What one node stands for: shares of the parts around it.
struct NodeContent {
  std::array<float, kParts> share{};
  float depth_mm = 0.0F;
};

volume::GridGeometry node_lattice(const volume::GridGeometry& grid, double spacing_mm) {
  volume::GridGeometry lattice;
  lattice.spacing_mm = Vec3::Constant(spacing_mm);
  for (int axis = 0; axis < 3; ++axis) {
    const double length_mm = static_cast<double>(grid.size[static_cast<std::size_t>(axis)]) * grid.spacing_mm[axis];
    lattice.size[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::ceil(length_mm / spacing_mm)) + 3;
    lattice.origin_P[axis] = grid.origin_P[axis] - spacing_mm;
  }
  return lattice;
}

std::vector<NodeContent> contents_of(const BodyMap& map, const volume::GridGeometry& lattice) {
  std::vector<NodeContent> contents(lattice.voxel_count());
  const volume::GridGeometry& grid = map.parts.geometry;
  const auto share = static_cast<float>(grid.spacing_mm.prod() / lattice.spacing_mm.prod());
  for (std::size_t n = 0; n < map.parts.voxels.size(); ++n) {
    const Vec3 at = lattice.to_index(grid.centre_mm(grid.index_of(n))).array().round();
    contents[lattice.offset({std::llround(at.x()), std::llround(at.y()), std::llround(at.z())})]
        .share[map.parts.voxels[n]] += share;
  }
  for (std::size_t n = 0; n < contents.size(); ++n)
    contents[n].depth_mm =
        static_cast<float>(volume::sample_linear(map.depth_mm, lattice.centre_mm(lattice.index_of(n))));
  return contents;
}

/// Sets target and pull of a node from the parts that belong to its region.
void aim(DisplacementProblem::Node& node, const NodeContent& content, std::size_t region, Driver driver,
         const Vec3& rib_mm) {
  Vec3f weighted = Vec3f::Zero();
  float pull = 0.0F;
  for (std::size_t p = 0; p < kParts; ++p) {
    const auto part = static_cast<Part>(p);
    const bool is_wall = part == Part::kRib || part == Part::kStill || part == Part::kWall;
    if (content.share[p] == 0.0F || is_wall != (region == 0)) continue;
    const Follow follow = follow_of(part);
    Vec3 target = kDeepLiver_mm * Vec3(0.0, -follow.forward, -follow.down);
    float strength = follow.pull;
    if (driver == kChest) {
      target = part == Part::kRib ? rib_mm : Vec3::Zero();
      if (region == 1) strength *= 0.1F;  // organs give way to the chest
    }
    weighted += content.share[p] * strength * target.cast<float>();
    pull += content.share[p] * strength;
  }
  constexpr float kLeast = 1e-4F;
  node.pull = pull + kLeast;
  node.target_mm = weighted / node.pull;
}

DisplacementProblem make_problem(const BodyMap& map, const volume::GridGeometry& lattice, Driver driver) {
  constexpr float kTissue = 1.0F, kBeyond = 0.1F, kBulk = 20.0F, kLung = 0.3F, kBorder = 100.0F;
  DisplacementProblem problem{lattice, {}, std::vector<DisplacementProblem::Border>(lattice.voxel_count())};
  const std::vector<NodeContent> contents = contents_of(map, lattice);
  const volume::GridGeometry& grid = map.parts.geometry;
  const double reach_mm = lattice.spacing_mm.x();
  for (std::size_t region = 0; region < kRegions; ++region) problem.nodes[region].resize(contents.size());
  for (std::size_t n = 0; n < contents.size(); ++n) {
    const NodeContent& content = contents[n];
    const Vec3 p = lattice.centre_mm(lattice.index_of(n));
    const auto slice = std::clamp<std::int64_t>(std::llround(grid.to_index(p).z()), 0, grid.size[2] - 1);
    const Vec3 rib_mm = rib_motion(p, map.spine_P[static_cast<std::size_t>(slice)]);
    const float lung = content.share[static_cast<std::size_t>(Part::kLung)];
    const float air = content.share[static_cast<std::size_t>(Part::kOutside)];
    for (std::size_t region = 0; region < kRegions; ++region) {
      DisplacementProblem::Node& node = problem.nodes[region][n];
      const double within_mm = region == 0 ? -content.depth_mm : content.depth_mm;
      const bool is_own = within_mm > -0.5 * reach_mm && air < 0.5F;
      node.stiffness = !is_own ? kBeyond : lung > 0.5F ? kLung : kTissue;
      node.bulk = is_own && lung < 0.1F && air < 0.1F ? kBulk : 0.0F;
      aim(node, content, region, driver, rib_mm);
    }
    if (std::abs(content.depth_mm) < reach_mm && air < 0.5F) {
      const Vec3 slope = volume::gradient_per_mm(map.depth_mm, p);
      problem.border[n] = {kBorder, slope.stableNormalized().cast<float>()};
    }
  }
  return problem;
}

/// From a lattice to one with nodes half as far apart.
Displacements refined(const Displacements& coarse, const volume::GridGeometry& from, const volume::GridGeometry& to) {
  Displacements fine;
  for (std::size_t region = 0; region < kRegions; ++region) {
    fine[region].resize(to.voxel_count());
    std::array<volume::FloatGrid, 3> axes{volume::FloatGrid(from), volume::FloatGrid(from), volume::FloatGrid(from)};
    for (std::size_t n = 0; n < coarse[region].size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        axes[axis].voxels[n] = coarse[region][n][static_cast<Eigen::Index>(axis)];
    for (std::size_t n = 0; n < fine[region].size(); ++n) {
      const Vec3 p = to.centre_mm(to.index_of(n));
      for (std::size_t axis = 0; axis < 3; ++axis)
        fine[region][n][static_cast<Eigen::Index>(axis)] = static_cast<float>(volume::sample_linear(axes[axis], p));
    }
  }
  return fine;
}

Displacements solve_mode(const BodyMap& map, const volume::GridGeometry& lattice, Driver driver) {
  constexpr int kCoarseSteps = 200, kFineSteps = 80;
  const volume::GridGeometry coarse = node_lattice(map.parts.geometry, 2.0 * kSpacing_mm);
  const Displacements start = detail::solve(make_problem(map, coarse, driver), {}, kCoarseSteps);
  return detail::solve(make_problem(map, lattice, driver), refined(start, coarse, lattice), kFineSteps);
}

/// Mean displacement of the voxels of one part, in the region they are in.
Vec3 mean_motion(const motion::MotionModel& model, const BodyMap& map, Part part, std::size_t driver) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  motion::MotionModel::Scalars one{};
  one[driver] = 1.0;
  for (std::size_t n = 0; n < map.parts.voxels.size(); n += 3) {
    if (map.parts.voxels[n] != static_cast<std::uint8_t>(part)) continue;
    const Vec3 p_A = map.parts.geometry.centre_mm(map.parts.geometry.index_of(n));
    sum += model.displacement_mm(model.region_of(p_A), p_A, one);
    count += 1.0;
  }
  return count > 0.0 ? Vec3(sum / count) : Vec3::Zero();
}

/// Where tissue would be shortened too much, the displacements are made smoother, in all modes of the region.
Status limit_shortening(motion::MotionParts& parts, const std::string& where) {
  constexpr int kMostRounds = 60;
  constexpr double kLimit = 0.8;
  const volume::Index3& size = parts.lattice.size;
  const std::array<std::int64_t, 3> steps{1, size[0], size[0] * size[1]};
  for (int round = 0; round < kMostRounds; ++round) {
    TROCAR_TRY(const auto model, motion::MotionModel::unchecked(parts, where));
    bool is_changed = false;
    for (std::size_t region = 0; region < kRegions; ++region) {
      std::vector<std::uint8_t> is_rough(parts.lattice.voxel_count());
      for (std::size_t n = 0; n < is_rough.size(); ++n) {
        if (model->shortening(static_cast<int>(region), n) <= kLimit) continue;
        const volume::Index3 index = parts.lattice.index_of(n);
        for (std::int64_t c = 0; c < 27; ++c) {
          const volume::Index3 beside{index[0] + c % 3 - 1, index[1] + c / 3 % 3 - 1, index[2] + c / 9 - 1};
          bool is_inner = true;
          for (std::size_t a = 0; a < 3; ++a) is_inner = is_inner && beside[a] > 0 && beside[a] + 1 < size[a];
          if (is_inner) is_rough[parts.lattice.offset(beside)] = 1;
        }
        is_changed = true;
      }
      for (std::size_t driver = 0; driver < kDrivers; ++driver) {
        std::vector<Vec3f>& mode = parts.modes[region * kDrivers + driver];
        const std::vector<Vec3f> before = mode;
        for (std::size_t n = 0; n < mode.size(); ++n) {
          if (is_rough[n] == 0) continue;
          Vec3f sum = Vec3f::Zero();
          for (const std::int64_t step : steps)
            sum += before[n + static_cast<std::size_t>(step)] + before[n - static_cast<std::size_t>(step)];
          mode[n] = 0.5F * before[n] + sum / 12.0F;
        }
      }
    }
    if (!is_changed) break;
  }
  return {};
}

/// Scales the diaphragm's mode so that the liver, or what stands for it, moves as it is said to.
Status scale_to_liver(motion::MotionParts& parts, const BodyMap& map, const std::string& where) {
  TROCAR_TRY(const auto model, motion::MotionModel::unchecked(parts, where));
  for (const Part part : {Part::kLiver, Part::kSpleen, Part::kKidney}) {
    const double down_mm = -mean_motion(*model, map, part, kDiaphragm).z();
    if (!(down_mm > 1.0)) continue;
    const auto factor = static_cast<float>(kDeepLiver_mm * follow_of(part).down / down_mm);
    for (std::size_t region = 0; region < kRegions; ++region)
      for (Vec3f& moved : parts.modes[region * kDrivers + kDiaphragm]) moved *= factor;
    break;
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<const motion::MotionModel>> make_breathing_model(const anatomy::VirtualPatient& patient,
                                                                        const BreathingOptions& options,
                                                                        const Progress& progress) {
  report(progress, "motion: body", 0.0);
  TROCAR_TRY(BodyMap map, detail::map_body(patient));
  motion::MotionParts parts;
  parts.drivers = {"diaphragm", "chest"};
  parts.regions = {"wall", "inside"};
  parts.lattice = node_lattice(map.parts.geometry, kSpacing_mm);
  report(progress, "motion: displacements", 0.3);
  std::array<Displacements, kDrivers> solved;
  parallel_invoke([&] { solved[kDiaphragm] = solve_mode(map, parts.lattice, kDiaphragm); },
                  [&] { solved[kChest] = solve_mode(map, parts.lattice, kChest); });
  for (std::size_t region = 0; region < kRegions; ++region)
    for (std::size_t driver = 0; driver < kDrivers; ++driver) parts.modes.push_back(std::move(solved[driver][region]));
  parts.border_mm = map.depth_mm;
  parts.at_ct[kDiaphragm] = parts.at_ct[kChest] = options.ct_inhaled_mm / kDeepLiver_mm;
  parts.liver_mm = kDeepLiver_mm;
  parts.source = "made from the labels";
  TROCAR_TRY_STATUS(scale_to_liver(parts, map, patient.name));
  TROCAR_TRY_STATUS(limit_shortening(parts, patient.name));
  TROCAR_TRY_STATUS(scale_to_liver(parts, map, patient.name));  // by the little that the limit took
  report(progress, "motion: checked", 0.9);
  return motion::MotionModel::make(std::move(parts), patient.name);
}

void add_breathing_model(anatomy::VirtualPatient& patient, const Progress& progress) {
  if (patient.motion != nullptr) return;
  if (auto model = make_breathing_model(patient, {}, progress))
    patient.motion = *std::move(model);
  else
    log_info("the patient cannot breathe: {}", model.error().text());
}

std::vector<StructureMotion> structure_motions(const anatomy::VirtualPatient& patient,
                                               const motion::MotionModel& model) {
  constexpr std::array<std::string_view, 9> kTissues{"lung",  "liver",       "spleen",       "kidney", "organ",
                                                     "bowel", "gallbladder", "liver_lesion", "bone"};
  std::array<std::size_t, 256> row_of{};
  std::vector<StructureMotion> rows;
  for (const anatomy::Label& label : patient.label_table.labels) {
    if (std::ranges::find(kTissues, label.tissue) == kTissues.end()) continue;
    rows.push_back({label.name, {}});
    row_of[label.id] = rows.size();
  }
  const std::size_t drivers = model.parts().drivers.size();
  std::vector<double> counts(rows.size(), 0.0);
  for (StructureMotion& row : rows) row.by_driver_mm.assign(drivers, Vec3::Zero());
  constexpr std::size_t kStride = 17;  // voxels: a sample of each structure
  for (std::size_t n = 0; n < patient.labels.voxels.size(); n += kStride) {
    const std::size_t row = row_of[patient.labels.voxels[n]];
    if (row == 0) continue;
    const Vec3 p_A = patient.labels.geometry.centre_mm(patient.labels.geometry.index_of(n));
    const int region = model.region_of(p_A);
    counts[row - 1] += 1.0;
    for (std::size_t d = 0; d < drivers; ++d) {
      motion::MotionModel::Scalars one{};
      one[d] = 1.0;
      rows[row - 1].by_driver_mm[d] += model.displacement_mm(region, p_A, one);
    }
  }
  std::vector<StructureMotion> found;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (counts[row] == 0.0) continue;
    for (Vec3& moved_mm : rows[row].by_driver_mm) moved_mm /= counts[row];
    found.push_back(std::move(rows[row]));
  }
  return found;
}

}  // namespace trocar::motion_builder
