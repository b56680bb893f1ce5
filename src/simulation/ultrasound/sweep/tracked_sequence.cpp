#include "ultrasound/sweep/tracked_sequence.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <deque>
#include <map>

#include "core/text.h"

namespace trocar::ultrasound {
namespace {

using Matrix4 = TransformGraph::Matrix4;

constexpr double kLeastDeterminant = 1e-12;  ///< Of the linear part: permits pixels of 0.1 µm.

struct Edge {
  std::string from, to;
  Matrix4 matrix;
};

/// Frame names start with a capital, so that "ToolToTracker" can be split in one way; if a name can be split in several
/// ways, all are used.
void add_edges(const std::string& name, const Matrix4& matrix, std::vector<Edge>& edges) {
  for (std::size_t at = name.find("To", 1); at != std::string::npos; at = name.find("To", at + 1)) {
    const std::size_t next = at + 2;
    if (next >= name.size() || !ascii::is_upper(name[next])) continue;
    edges.push_back({name.substr(0, at), name.substr(next), matrix});
    if (std::abs(matrix.topLeftCorner<3, 3>().determinant()) > kLeastDeterminant)
      edges.push_back({name.substr(next), name.substr(0, at), matrix.inverse()});
  }
}

std::vector<Edge> edges_of(const TrackedSequence::Transforms& transforms) {
  std::vector<Edge> edges;
  for (const auto& [name, matrix] : transforms) add_edges(name, matrix, edges);
  return edges;
}

/// All frames connected to one, each with the transform to it, breadth first.
std::map<std::string, Matrix4, std::less<>> reach(const std::vector<Edge>& edges, std::string_view from) {
  std::map<std::string, Matrix4, std::less<>> reached{{std::string(from), Matrix4::Identity()}};
  std::deque<std::string> queue{std::string(from)};
  while (!queue.empty()) {
    const std::string at = queue.front();
    queue.pop_front();
    for (const Edge& edge : edges) {
      if (edge.from != at || reached.contains(edge.to)) continue;
      reached.emplace(edge.to, edge.matrix * reached.at(at));
      queue.push_back(edge.to);
    }
  }
  return reached;
}

template <class Range>
std::string joined_names(const Range& pairs) {
  std::string text;
  for (const auto& [name, matrix] : pairs) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace

void TransformGraph::add(const TrackedSequence::Transforms& transforms) {
  for (const auto& [name, matrix] : transforms) transforms_.insert_or_assign(name, matrix);
}

std::optional<Matrix4> TransformGraph::find(std::string_view from, std::string_view to) const {
  const auto reached = reach(edges_of(transforms_), from);
  const auto found = reached.find(to);
  return found == reached.end() ? std::nullopt : std::optional(found->second);
}

std::string TransformGraph::explain(std::string_view from, std::string_view to) const {
  const auto edges = edges_of(transforms_);
  auto from_side = reach(edges, from);
  auto to_side = reach(edges, to);
  from_side.erase(std::string(from));
  to_side.erase(std::string(to));
  return fmt::format("no transform from {} to {}: known transforms are {}; {} is connected to {}, {} to {}", from, to,
                     joined_names(transforms_), from, joined_names(from_side), to, joined_names(to_side));
}

}  // namespace trocar::ultrasound
