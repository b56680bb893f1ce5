#include "storage/detail/transducer_table.h"

#include "storage/detail/guarded_database.h"

namespace trocar::storage::detail {

const TimedTable& transducer_table() {
  static const TimedTable kTable{
      "transducer", {"time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz", "contact_n"}, kMaxTransducerRows};
  return kTable;
}

void add(TimedBuffer& buffer, const TransducerSample& sample) {
  const Vec3& p = sample.X_PT.p();
  const Eigen::Quaterniond q(sample.X_PT.R());
  buffer.add(std::array{sample.time_s, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), sample.contact_n});
}

std::vector<TransducerSample> read_transducer(soci::session& database) {
  std::vector<TransducerSample> samples;
  const auto rows = read_rows(database, transducer_table());
  samples.reserve(rows.size());
  for (const std::vector<double>& row : rows) {
    const Eigen::Quaterniond q(row[4], row[5], row[6], row[7]);
    constexpr double kLeastNorm = 0.5;  // stored as a unit quaternion
    if (!all_finite(row) || q.norm() < kLeastNorm) throw soci::soci_error("a pose of the transducer is invalid");
    samples.push_back({row[0], Pose(q.normalized().toRotationMatrix(), Vec3(row[1], row[2], row[3])), row[8]});
  }
  return samples;
}

}  // namespace trocar::storage::detail
