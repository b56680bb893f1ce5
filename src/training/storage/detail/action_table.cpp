#include "storage/detail/action_table.h"

#include "storage/detail/guarded_database.h"

namespace trocar::storage::detail {
namespace {

/// A number of a file as an enumerator from 0 to `last`.
template <class Enum>
Enum read_enum(double number, Enum last) {
  if (!(number >= 0.0 && number <= static_cast<double>(last)) || number != std::floor(number))
    throw soci::soci_error("an action of the trainee is invalid");
  return static_cast<Enum>(number);
}

}  // namespace

const TimedTable& action_table() {
  static const TimedTable kTable{"actions",
                                 {"time_s", "kind", "amount", "substance", "share", "x_mm", "y_mm", "z_mm", "depth_mm"},
                                 kMaxTransducerRows};
  return kTable;
}

void add(TimedBuffer& buffer, const tasks::Action& action) {
  const Vec3& p = action.tip_A;
  buffer.add(std::array{action.time_s, static_cast<double>(action.kind), action.amount,
                        static_cast<double>(action.result.substance), action.result.share, p.x(), p.y(), p.z(),
                        action.depth_mm});
}

std::vector<tasks::Action> read_actions(soci::session& database) {
  std::vector<tasks::Action> actions;
  const auto rows = read_rows(database, action_table());
  for (const std::vector<double>& row : rows) {
    if (!all_finite(row)) throw soci::soci_error("an action of the trainee is invalid");
    actions.push_back({row[0],
                       read_enum(row[1], tasks::kLastAction),
                       row[2],
                       {read_enum(row[3], tasks::kLastSubstance), row[4]},
                       Vec3(row[5], row[6], row[7]),
                       row[8]});
  }
  return actions;
}

}  // namespace trocar::storage::detail
