#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::ultrasound {

/// Speed over one heartbeat, relative to its peak (data/flow.toml; physics.md U15).
struct FlowWaveform {
  std::string name;
  std::vector<double> values;  ///< In equal time steps from the R wave. Range -1..1; at least 4.
  double breathing = 0.0;      ///< Fraction by which a breath changes the speed. Range 0..0.8.

  /// Value at a time since the start of a heartbeat at 0 and at a phase of the breath (PatientMotion::phase). Periodic
  /// and continuous. Real-time safe.
  double at(double time_s, double heart_per_min, double breath_phase) const noexcept;
};

/// Blood flow in a kind of vessel.
struct FlowRule {
  enum class End { kSources, kSinks };
  enum class At { kNowhere, kHead, kFeet };

  std::string name;
  std::vector<std::string> labels;  ///< '*' matches any ending.
  End ends = End::kSources;  ///< Kind of the ends near `near`, else of the end at `at`; the other ends are of the
                             ///< opposite kind.
  std::vector<std::string> near;
  At at = At::kNowhere;
  std::size_t waveform = 0;         ///< Index into FlowTable::waveforms.
  double peak_cm_per_s = 30.0;      ///< Speed in the middle of the widest part, at waveform value 1. Range 1..300.
  double profile_exponent = 2.0;    ///< Range 1..20.
  double narrowing_exponent = 0.0;  ///< Range -1..2.
};

struct FlowTable {
  double heart_per_min = 70.0;          ///< Range 30..200.
  std::vector<FlowWaveform> waveforms;  ///< At most 32.
  std::vector<FlowRule> rules;

  /// Rule of a label among the patient's labels: the first rule for that label whose neighbours are present, or that
  /// needs none.
  const FlowRule* find(std::string_view label, const anatomy::LabelTable& labels) const;
};

/// Errors name file, row and key: unknown key, out of range, no source, an unknown waveform.
Result<FlowTable> load_flow_table(const std::filesystem::path& path);

/// True if a label matches one of the patterns ('*' matches any ending; case and separators are ignored).
bool is_named(std::string_view label, const std::vector<std::string>& patterns);

/// A point on a vessel's centreline.
struct VesselPoint {
  Vec3 p_P = Vec3::Zero();
  Vec3 flow_P = Vec3::UnitZ();  ///< Unit vector; flow direction for positive waveform values.
  double radius_mm = 0.0;
  double peak_mm_per_s = 0.0;  ///< Speed in the middle, at waveform value 1.
  bool is_in_own_tube = true;  ///< False within the vessel that this one leaves.
};

/// A section of a vessel between two ends or forks, in the order in which it was found (not of flow).
struct VesselBranch {
  std::uint8_t label = 0;
  std::string rule;          ///< Row of the flow table.
  std::size_t waveform = 0;  ///< Index into the table's waveforms.
  double profile_exponent = 2.0;
  std::vector<VesselPoint> points;
};

/// Resolution of the flow.
struct VesselFlowOptions {
  double spacing_mm = 0.8;          ///< Spacing of the velocity grid. Range 0.3..3.
  double least_vessel_mm3 = 100.0;  ///< Smaller pieces of a label have no flow. Range 10..10000.
};

/// Blood flow in the labelled vessels of a patient at rest: along the centrelines, with a profile across the lumen and
/// a waveform over the heartbeat (docs/physics.md U15). Immutable; frame A. Not included: vortices, helices, jets, the
/// pulse's travel time, moving walls.
class VesselFlow {
 public:
  /// Blood at a point: velocity (mm/s, A) and the share of lumen there, 0..1.
  struct Blood {
    Vec3f velocity_A = Vec3f::Zero();
    float share = 0.0F;
  };
  /// Value of each waveform at one time; the same for all points.
  using Moment = std::array<float, 32>;

  Moment moment(double time_s, double breath_phase) const noexcept;
  /// Real-time safe. No blood outside the vessels, or at a point with NaN.
  Blood at(const Vec3f& p_A, const Moment& moment) const noexcept;
  /// mm/s; 0 outside vessels. Real-time safe.
  Vec3 velocity_A(const Vec3& p_A, double time_s, double breath_phase) const noexcept;

  std::span<const VesselBranch> branches() const noexcept { return branches_; }
  const FlowTable& table() const noexcept { return table_; }
  /// Labels that have a vessel's tissue but no row in the table, or no piece that is large enough.
  std::span<const std::string> without_flow() const noexcept { return without_flow_; }
  std::size_t bytes() const noexcept { return cells_.size() * sizeof(Cell) + bricks_.size() * sizeof(std::int32_t); }

 private:
  friend class VesselFlowMaker;
  /// Speeds are in steps of kSpeedStep_mm_per_s.
  struct Cell {
    std::array<std::int16_t, 3> velocity_A{};
    std::uint8_t share = 0;  ///< Share of lumen, in 1/255.
    std::uint8_t waveform = 0;
  };

  volume::GridGeometry geometry_;
  std::array<std::array<float, 3>, 3> index_of_P_{};  ///< Rows: index along an axis per mm of P.
  std::array<float, 3> index_of_origin_{};
  std::array<std::int32_t, 3> brick_count_{};
  std::vector<std::int32_t> bricks_;  ///< First cell of each brick; -1: no blood.
  std::vector<Cell> cells_;  ///< 9³ per brick; the last cell of each row equals the first cell of the next brick.
  std::vector<VesselBranch> branches_;
  FlowTable table_;
  std::vector<std::string> without_flow_;
};

/// True if blood may flow in the label.
bool is_vessel(const anatomy::Label& label);

/// `stop` is checked between two vessels. Errors: no vessel of the patient has flow (lists the labels of vessels),
/// stopped.
Result<std::shared_ptr<const VesselFlow>> make_vessel_flow(const anatomy::VirtualPatient& patient, FlowTable table,
                                                           const VesselFlowOptions& options = {},
                                                           const Progress& progress = {},
                                                           const std::stop_token& stop = {});

}  // namespace trocar::ultrasound
