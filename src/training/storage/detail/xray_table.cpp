#include "storage/detail/xray_table.h"

#include "storage/detail/guarded_database.h"

namespace trocar::storage::detail {

const TimedTable& xray_table() {
  static const TimedTable kTable{"xray",
                                 {"time_s", "lao_deg", "cranial_deg", "x_mm", "y_mm", "z_mm", "field_mm", "beam_on",
                                  "contrast_ml", "beam_s", "air_kerma_mgy", "dose_area_gycm2"},
                                 kMaxTransducerRows};
  return kTable;
}

void add(TimedBuffer& buffer, const tasks::XrayUse& use) {
  const Vec3& p = use.isocentre_P;
  buffer.add(std::array{use.time_s, use.lao_deg, use.cranial_deg, p.x(), p.y(), p.z(), use.field_mm,
                        use.is_beam_on ? 1.0 : 0.0, use.contrast_ml, use.beam_s, use.air_kerma_mgy,
                        use.dose_area_gycm2});
}

std::vector<tasks::XrayUse> read_xray(soci::session& database) {
  std::vector<tasks::XrayUse> uses;
  const auto rows = read_rows(database, xray_table());
  for (const std::vector<double>& row : rows) {
    const bool is_dose = row[8] >= 0.0 && row[9] >= 0.0 && row[10] >= 0.0 && row[11] >= 0.0;
    if (!all_finite(row) || !is_dose) throw soci::soci_error("a dose of the X-ray is invalid");
    uses.push_back(
        {row[0], row[1], row[2], Vec3(row[3], row[4], row[5]), row[6], row[7] > 0.5, row[8], row[9], row[10], row[11]});
  }
  return uses;
}

}  // namespace trocar::storage::detail
