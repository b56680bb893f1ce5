#include "script/benchmark.h"

#include "workspace/layouts.h"

namespace trocar::trainer {

Result<std::vector<ScriptStep>> benchmark_steps() {
  QString text = QStringLiteral(
      "resize 1280 800\n"
      "click difficulty-guided\n"  // the previous run may have selected another
      "click start\n"
      "wait-for is_open is true within 120\n"
      "click begin\n"
      "wait-for phase is ready within 120\n"
      "key H\n"
      "wait 2\n");
  for (std::size_t number = 1; number <= built_in_layouts().size(); ++number) {
    // In and out again, so that each layout displays a tool that moves through skin and liver.
    text += QStringLiteral(
                "key Ctrl+%1\n"
                "wait 2\n"
                "reset-watch\n"
                "wheel-until view-3d %2 depth_mm %3 within 60\n"
                "print layout frame_p50_ms frame_p99_ms render_p50_ms render_p99_ms slowest\n"
                "wait 3\n"  // at rest: full quality
                "print still_p50_ms unwatched_ms\n")
                .arg(number)
                .arg(number % 2 == 1 ? QStringLiteral("12") : QStringLiteral("-12"),
                     number % 2 == 1 ? QStringLiteral("> 45") : QStringLiteral("< 1"));
  }
  return parse_script(text, QStringLiteral("benchmark"));
}

}  // namespace trocar::trainer
