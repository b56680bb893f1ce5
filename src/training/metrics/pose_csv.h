#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "metrics/metric.h"

namespace trocar::metrics {

/// A table of poses of any system, as CSV (docs/metrics.md). Frame P (LPS). The first line names the columns, in any
/// order; others are ignored:
/// - time_s; tip_x_mm, tip_y_mm, tip_z_mm (or _m: metres); axis_x, axis_y, axis_z (hub to tip): required.
/// - depth_mm or depth_m, force_n, phase, event ("puncture:skin"), layer_displacement_mm: as in `trocar session
///   export`, whose files can be read, too; there the resistance follows from the columns of the forces. Events of a
///   table without any puncture are not known.
/// - probe_x_mm, probe_y_mm, probe_z_mm (or _m), probe_qw, probe_qx, probe_qy, probe_qz: X_PT; probe_contact_n.
/// An empty field, and "nan", is no value; every row has a time. Time may not run backwards; interruptions are events
/// "interruption:SECONDS".
class PoseTable {
 public:
  /// Reads and checks the whole file. Errors name line and column: a required column is missing, or part of a group; a
  /// name that occurs twice, or in mm and m; a field that is no finite number, no phase or no event; another number of
  /// fields than in the header; broken quotes; no time, or one that runs backwards; no row; a file of more than 256
  /// MiB.
  static Result<PoseTable> read(const std::filesystem::path& path);
  PoseTable(PoseTable&&) noexcept;
  PoseTable& operator=(PoseTable&&) noexcept;
  ~PoseTable();

  /// Names of the layers in events, by id.
  const std::vector<std::string>& layer_names() const noexcept;
  std::size_t rows() const noexcept;
  /// Calls visit for every row, in order.
  void walk(const std::function<void(const Moment&)>& visit) const;

 private:
  struct Impl;
  explicit PoseTable(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::metrics
