#include "io/markups_file.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "config/json.h"
#include "core/files/input_file.h"
#include "core/files/output_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

// Schema: Slicer/Slicer, Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json.
constexpr const char* kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#";
constexpr double kMaxCoordinate_mm = 1e5;
constexpr double kMinPath_mm = 1e-3;

struct ControlPoint {
  std::string label;
  Vec3 p_P = Vec3::Zero();
};

struct Markup {
  std::string type;  ///< "Fiducial", "Line" …
  std::string name;
  std::vector<ControlPoint> points;  ///< Placed points only.
};

std::string text_of(const config::Json& object, const char* key, std::string fallback = {}) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : fallback;
}

/// What decides how points are read: missing is the schema's default, but another kind of value is no text.
Result<std::string> checked_text_of(const config::Json& object, const char* key, const std::string& missing,
                                    const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) return missing;
  if (found->is_string()) return found->get<std::string>();
  return fail(fmt::format("\"{}\" is not a text: {}", key, config::json_text(*found)), where,
              "save the markups again in 3D Slicer");
}

Result<Vec3> position_of(const config::Json& point, const std::string& where) {
  const auto found = point.find("position");
  Vec3 p = Vec3::Constant(std::nan(""));
  if (found != point.end() && found->is_array() && found->size() == 3)
    for (std::size_t n = 0; n < 3; ++n)
      if ((*found)[n].is_number()) p[static_cast<int>(n)] = (*found)[n].get<double>();
  if (p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxCoordinate_mm) return p;
  return fail(fmt::format("control point \"{}\" has no usable position", text_of(point, "label")), where,
              "give three numbers in mm");
}

Result<Markup> markup_of(const config::Json& json, const std::string& where) {
  if (!json.is_object()) return fail("a markup is not an object", where, "save the markups again in 3D Slicer");
  Markup markup{{}, text_of(json, "name"), {}};
  TROCAR_TRY(markup.type, checked_text_of(json, "type", "", where));
  TROCAR_TRY(const std::string system, checked_text_of(json, "coordinateSystem", "LPS", where));
  if (system != "LPS" && system != "RAS")
    return fail(fmt::format("unknown coordinate system \"{}\"", system), where, "use LPS or RAS");
  const auto units = json.find("coordinateUnits");
  const bool is_mm =
      units == json.end() || *units == "mm" || (units->is_array() && !units->empty() && (*units)[0] == "mm");
  if (!is_mm) return fail("the coordinates are not in mm", where, "save the markups in mm");
  const auto points = json.find("controlPoints");
  if (points == json.end()) return markup;
  if (!points->is_array())
    return fail("the control points are not a list", where, "save the markups again in 3D Slicer");
  for (const config::Json& point : *points) {
    if (!point.is_object())
      return fail("a control point is not an object", where, "save the markups again in 3D Slicer");
    // 3D Slicer also stores points that were never placed.
    TROCAR_TRY(const std::string status, checked_text_of(point, "positionStatus", "defined", where));
    if (status != "defined") continue;
    TROCAR_TRY(Vec3 p, position_of(point, where));
    if (system == "RAS") p = Vec3(-p.x(), -p.y(), p.z());
    markup.points.push_back({text_of(point, "label"), p});
  }
  return markup;
}

Result<std::vector<Markup>> read_markups(const fs::path& path, const fs::path& inside) {
  const std::string where = path.string();
  TROCAR_TRY(const std::string text, read_input(path, FileKind::kMarkups, inside));
  TROCAR_TRY(const config::Json json, config::parse_json(text, where, config::kMostJsonFileValues));
  const auto list = json.is_object() ? json.find("markups") : json.end();
  if (!json.is_object() || list == json.end() || !list->is_array())
    return fail("not a markups file", where, "save fiducials or lines in 3D Slicer as .mrk.json");
  std::vector<Markup> markups;
  for (const config::Json& item : *list) {
    TROCAR_TRY(Markup markup, markup_of(item, where));
    markups.push_back(std::move(markup));
  }
  return markups;
}

config::Json point_json(int number, const ControlPoint& point) {
  return {{"id", std::to_string(number)},
          {"label", point.label},
          {"position", {point.p_P.x(), point.p_P.y(), point.p_P.z()}},
          {"selected", true},
          {"locked", false},
          {"visibility", true},
          {"positionStatus", "defined"}};
}

config::Json markup_json(const Markup& markup) {
  config::Json points = config::Json::array();
  for (const ControlPoint& point : markup.points)
    points.push_back(point_json(static_cast<int>(points.size()) + 1, point));
  return {{"type", markup.type},
          {"name", markup.name},
          {"coordinateSystem", "LPS"},
          {"coordinateUnits", "mm"},
          {"locked", false},
          {"labelFormat", "%N-%d"},
          {"lastUsedControlPointNumber", static_cast<int>(points.size())},
          {"controlPoints", points}};
}

Status write_markups(const std::vector<Markup>& markups, const fs::path& path) {
  for (const Markup& markup : markups)
    for (const ControlPoint& point : markup.points)
      if (!point.p_P.allFinite())
        return fail(fmt::format("point \"{}\" has a position that is not a number", point.label), path.string(),
                    "correct the point in the file");
  config::Json list = config::Json::array();
  for (const Markup& markup : markups) list.push_back(markup_json(markup));
  return write_file_atomically(path, config::json_text({{"@schema", kSchema}, {"markups", list}}) + "\n");
}

}  // namespace

Result<std::vector<anatomy::Landmark>> read_landmarks(const fs::path& path, const fs::path& inside) {
  TROCAR_TRY(const std::vector<Markup> markups, read_markups(path, inside));
  std::vector<anatomy::Landmark> landmarks;
  for (const Markup& markup : markups)
    if (markup.type == "Fiducial")
      for (const ControlPoint& point : markup.points) landmarks.push_back({point.label, point.p_P});
  return landmarks;
}

Status write_landmarks(const std::vector<anatomy::Landmark>& landmarks, const fs::path& path) {
  Markup markup{"Fiducial", "landmarks", {}};
  for (const anatomy::Landmark& landmark : landmarks) markup.points.push_back({landmark.name, landmark.p_P});
  return write_markups({markup}, path);
}

Result<std::vector<anatomy::NeedlePath>> read_paths(const fs::path& path, const fs::path& inside) {
  TROCAR_TRY(const std::vector<Markup> markups, read_markups(path, inside));
  std::vector<anatomy::NeedlePath> paths;
  for (const Markup& markup : markups) {
    if (markup.type != "Line") continue;
    if (markup.points.size() != 2)
      return fail(fmt::format("line \"{}\" has {} placed points", markup.name, markup.points.size()), path.string(),
                  "place two: the entry, then the target");
    const Segment line_P{markup.points[0].p_P, markup.points[1].p_P};
    if (line_P.length_mm() < kMinPath_mm)
      return fail(fmt::format("line \"{}\" has no length", markup.name), path.string(),
                  "place two points: the entry, then the target");
    paths.push_back({markup.name, line_P});
  }
  return paths;
}

Result<std::vector<MarkupPoints>> read_markup_points(const fs::path& path) {
  TROCAR_TRY(const std::vector<Markup> markups, read_markups(path, {}));
  std::vector<MarkupPoints> all;
  for (const Markup& markup : markups) {
    const bool is_list = markup.type == "Fiducial";
    if (!is_list && markup.type != "Curve" && markup.type != "Line") continue;
    if (!is_list && markup.points.size() < 2)
      return fail(fmt::format("curve \"{}\" has {} placed points", markup.name, markup.points.size()), path.string(),
                  "place two or more");
    MarkupPoints drawn{markup.name, is_list, {}};
    for (const ControlPoint& point : markup.points) drawn.points_P.push_back(point.p_P);
    all.push_back(std::move(drawn));
  }
  if (all.empty()) return fail("the markups have no curve, line or point list", path.string(), "draw one in 3D Slicer");
  return all;
}

Status write_paths(const std::vector<anatomy::NeedlePath>& paths, const fs::path& path) {
  std::vector<Markup> markups;
  for (const anatomy::NeedlePath& needle_path : paths)
    markups.push_back({"Line", needle_path.name, {{"entry", needle_path.line_P.a}, {"target", needle_path.line_P.b}}});
  return write_markups(markups, path);
}

}  // namespace trocar::io
