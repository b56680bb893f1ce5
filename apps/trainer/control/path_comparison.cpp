#include "control/path_comparison.h"

#include <QCoreApplication>
#include <algorithm>

#include "metrics/curve_distances.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {
namespace {

/// As the patient calls the path, without the task's name: "L3/4 median".
QString path_name(const cases::Case& the_case, std::size_t number) {
  const Segment& line_P = the_case.expert_paths()[number].line_P;
  const std::string task = the_case.task.name + ": ";
  for (const anatomy::NeedlePath& path : the_case.patient->paths) {
    if ((path.line_P.a - line_P.a).norm() > 0.1 || (path.line_P.b - line_P.b).norm() > 0.1) continue;
    const QString name = to_qt(path.name.starts_with(task) ? path.name.substr(task.size()) : path.name);
    return name.left(1).toUpper() + name.mid(1);
  }
  return number == 0 ? QCoreApplication::translate("PathComparison", "Planned path")
                     : QCoreApplication::translate("PathComparison", "Path %1").arg(number + 1);
}

std::size_t nearest_of(const attempt::AttemptReplay& replay, const cases::Case& the_case) {
  return std::min(replay.outcome().expert, the_case.expert_paths().size() - 1);
}

}  // namespace

std::vector<ExpertPathList::Row> compare_with_experts(const attempt::AttemptReplay& replay,
                                                      const cases::Case& the_case) {
  const storage::Session& session = replay.session();
  const auto fired = session.shots.empty() ? std::nullopt : std::optional(session.shots.front());
  const std::vector<Vec3> way_P = metrics::insertion_way(session.samples, fired);
  if (way_P.empty()) return {};
  std::vector<ExpertPathList::Row> rows;
  for (std::size_t n = 0; n < the_case.expert_paths().size(); ++n) {
    const metrics::CurveDistances distances = metrics::curve_distances(way_P, the_case.expert_paths()[n].line_P);
    rows.push_back(
        {path_name(the_case, n), distances.frechet_mm, distances.hausdorff_mm, n == nearest_of(replay, the_case)});
  }
  return rows;
}

ExpertPaths expert_paths_of(const attempt::AttemptReplay& replay, const cases::Case& the_case, bool has_others) {
  const std::size_t nearest = nearest_of(replay, the_case);
  ExpertPaths paths{the_case.expert_paths()[nearest].line_P, {}};
  for (std::size_t n = 0; has_others && n < the_case.expert_paths().size(); ++n)
    if (n != nearest) paths.others_P.push_back(the_case.expert_paths()[n].line_P);
  return paths;
}

}  // namespace trocar::trainer
