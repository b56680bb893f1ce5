#include "storage/score_json.h"

#include "config/json.h"

namespace trocar::storage {
namespace {

config::Json vector_json(const Vec3& v) {
  return config::Json::array({v.x(), v.y(), v.z()});
}

}  // namespace

config::Json parts_json(const std::vector<scoring::ScorePart>& parts) {
  config::Json all = config::Json::array();
  for (const scoring::ScorePart& part : parts) {
    all.push_back({{"name", part.name},
                   {"title", part.title},
                   {"value", part.value},
                   {"unit", part.unit},
                   {"points", part.points},
                   {"max_points", part.max_points}});
    if (!part.is_judged) all.back()["judged"] = false;
  }
  return all;
}

config::Json harms_json(const std::vector<metrics::HarmEvent>& harms) {
  config::Json all = config::Json::array();
  for (const metrics::HarmEvent& event : harms)
    all.push_back({{"label", event.label},
                   {"grade", to_string(event.grade)},
                   {"graze", event.is_graze},
                   {"by_stylet", event.is_by_stylet},
                   {"by_notch", event.is_by_notch},
                   {"stayed", event.has_stayed},
                   {"inside_mm", event.inside_mm},
                   {"depth_mm", event.depth_mm},
                   {"begin_s", event.begin_s},
                   {"worst_s", event.worst_s},
                   {"stayed_s", event.stayed_s},
                   {"reason", event.reason}});
  return all;
}

config::Json core_json(const scoring::BiopsyCore& core) {
  config::Json pieces = config::Json::array();
  for (const scoring::CorePiece& piece : core.pieces)
    pieces.push_back(
        {{"label", piece.label}, {"tissue", piece.tissue}, {"from_mm", piece.from_mm}, {"to_mm", piece.to_mm}});
  return {{"tip_P", vector_json(core.tip_P)},
          {"axis_P", vector_json(core.axis_P)},
          {"pieces", std::move(pieces)},
          {"target_mm", core.target_mm},
          {"organ_mm", core.organ_mm},
          {"vessel_mm", core.vessel_mm},
          {"other_mm", core.other_mm},
          {"risks_in_throw", core.risks_in_throw},
          {"time_s", core.time_s}};
}

config::Json cores_json(const std::vector<scoring::BiopsyCore>& cores) {
  config::Json list = config::Json::array();
  for (const scoring::BiopsyCore& core : cores) list.push_back(core_json(core));
  return list;
}

config::Json bleeding_json(const scoring::Bleeding& bleeding) {
  return {{"risk", to_string(bleeding.risk)}, {"reasons", bleeding.reasons}, {"passes", bleeding.passes}};
}

}  // namespace trocar::storage
