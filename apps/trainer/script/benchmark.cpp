#include "script/benchmark.h"

#include <algorithm>

#include "ui_kit/parts.h"
#include "workspace/layouts.h"

namespace trocar::trainer {
namespace {

QStringList names_of(const std::vector<Layout>& layouts) {
  QStringList names;
  for (const Layout& layout : layouts) names << layout.name;
  return names;
}

/// The layouts' places in the list, from 1: the key that selects them.
Result<std::vector<std::size_t>> find_layouts(const std::vector<std::string>& names) {
  const std::vector<Layout>& all = built_in_layouts();
  std::vector<std::size_t> numbers;
  for (std::size_t n = 0; n < all.size(); ++n)
    if (names.empty() || std::ranges::find(names, to_std(all[n].name)) != names.end()) numbers.push_back(n + 1);
  for (const std::string& name : names)
    if (!names_of(all).contains(to_qt(name)))
      return fail_usage("no such layout", name, "use " + to_std(names_of(all).join(QStringLiteral(", "))));
  return numbers;
}

}  // namespace

Result<std::vector<ScriptStep>> benchmark_steps(const std::vector<std::string>& layouts) {
  TROCAR_TRY(const std::vector<std::size_t> numbers, find_layouts(layouts));
  QString text = QStringLiteral(
      "resize 1280 800\n"
      "click difficulty-guided\n"  // the previous run may have selected another
      "click start\n"
      "wait-for is_open is true within 120\n"
      "wait-for is_complete is true within 120\n"
      "click begin\n"
      "wait-for phase is ready within 120\n"
      "key H\n"  // the transducer, then the needle
      "wait-for probe_from_plan_mm < 6 within 60\n"
      "key A\n"
      "key H\n"
      "wait-for entry_from_plan_mm < 1 within 60\n"
      "wait 2\n");
  bool is_inside = false;
  for (const std::size_t number : numbers) {
    // In and out again, so that each layout displays a tool that moves through skin and liver.
    text += QStringLiteral(
                "key Ctrl+%1\n"
                "wait 2\n"
                "reset-watch\n"
                "wheel-until view-3d %2 depth_mm %3 within 60\n"
                "print layout frame_p50_ms frame_p99_ms render_p50_ms render_p99_ms slowest\n"
                "print ultrasound_per_s ultrasound_p50_ms ultrasound_p99_ms ultrasound_lines\n"
                "wait 3\n"  // at rest: full quality
                "print still_p50_ms unwatched_ms\n")
                .arg(number)
                .arg(is_inside ? QStringLiteral("-12") : QStringLiteral("12"),
                     is_inside ? QStringLiteral("< 1") : QStringLiteral("> 45"));
    is_inside = !is_inside;
  }
  return parse_script(text, QStringLiteral("benchmark"));
}

}  // namespace trocar::trainer
